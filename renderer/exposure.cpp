#include "renderer/exposure.h"

#include <cmath>

namespace retrolux {

double FrontalMarkerRadiance(const CameraSpec& camera, const Bsdf& material, double distance_mm) {
  const DiodeRing& ring = *camera.ring;
  const Vec3f wo = Vec3f::UnitZ();
  const Spectral nm = Spectral::Constant(static_cast<float>(ring.Led().peak_nm));
  const double slant2_m2 = (distance_mm * distance_mm + ring.radius_mm * ring.radius_mm) * 1e-6;
  const double cosine = distance_mm * 1e-3 / std::sqrt(slant2_m2);
  double radiance = 0.0;
  for (int i = 0; i < ring.count; ++i) {
    const double angle = 2.0 * kPi * i / ring.count;
    const Vec3f wi =
        Vec3d(ring.radius_mm * std::cos(angle), ring.radius_mm * std::sin(angle), distance_mm)
            .normalized()
            .cast<float>();
    const double intensity = ring.Intensity_w_sr() * std::pow(cosine, ring.LambertExponent());
    radiance += static_cast<double>(material.Evaluate(wo, wi, nm).f_cos[0]) * intensity / slant2_m2;
  }
  return radiance;
}

double ExposureSeconds(const Scene& scene, const CameraSpec& camera) {
  const Exposure& exposure = scene.exposure;
  if (exposure.time_s > 0.0) return exposure.time_s;
  if (!camera.ring) {
    throw InputError(
        fmt::format("camera '{}': no exposure time and no ring to derive it from; expected "
                    "exposure.time_s in seconds",
                    camera.model.name));
  }
  const double radiance = FrontalMarkerRadiance(
      camera, *scene.materials.at(exposure.marker_material).bsdf, exposure.distance_mm);
  const CameraResponse one_second(camera, {LedSpectrum(camera.ring->Led())}, 1.0);
  if (!(radiance > 0.0)) {
    throw InputError(
        fmt::format("camera '{}': a frontal marker of '{}' sends no light in its ring's light; "
                    "expected a ring and a material that "
                    "do, or exposure.time_s in seconds",
                    camera.model.name, exposure.marker_material));
  }
  const double electrons_per_s = radiance * one_second.ExpectedElectrons(0, 1.0, 1.0) +
                                 camera.sensor.dark_current_e_s * camera.sensor.DarkCurrentFactor();
  const double max_dn = (1 << camera.sensor.adc_bits) - 1;
  const double wanted_e =
      (exposure.fraction * max_dn - camera.sensor.offset_dn) / GainDnPerElectron(camera.sensor);
  if (!(wanted_e > 0.0)) {
    throw InputError(
        fmt::format("camera '{}': exposure.fraction {} lies below the sensor's offset; expected "
                    "more, or exposure.time_s in seconds",
                    camera.model.name, exposure.fraction));
  }
  return wanted_e / (camera.sensor.LinesPerRow() * electrons_per_s);
}

}  // namespace retrolux
