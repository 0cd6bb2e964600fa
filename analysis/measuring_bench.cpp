#include "analysis/measuring_bench.h"

#include <cmath>

#include "scenes/mesh_shapes.h"

namespace retrolux {

namespace {

CameraSpec CameraAt(const std::string& name, const Vec3d& eye, const Vec3d& target) {
  CameraSpec camera;
  camera.model =
      CameraModel::FromFieldOfView(name, 64, 64, 5.0, 5.0, LookAt(eye, target, Vec3d::UnitZ()));
  return camera;
}

}  // namespace

MeasuringBench::Radiance MeasuringBench::Measure(int samples, uint64_t seed) const {
  Scene scene;
  scene.name = "measuring-bench";
  scene.materials["patch"] = ReadMaterial("patch", JsonReader::FromText(material_json, "patch"));
  scene.objects.push_back(
      {"patch", RectangleMesh({0, -100, -100}, {0, 200, 0}, {0, 0, 200}), {}, "patch"});
  scene.cameras.push_back(CameraAt("camera", camera_position, Vec3d::Zero()));
  CameraSpec lamp = CameraAt("lamp", lamp_position, lamp_target);
  lamp.ring = DiodeRing{};
  lamp.ring->count = 1;
  lamp.ring->radius_mm = 0.0;
  lamp.ring->led_radius_mm = 0.2;
  lamp.ring->half_angle_deg = lamp_half_angle_deg;
  lamp.ring->radiant_intensity_w_sr = lamp_intensity_w_sr;
  scene.cameras.push_back(lamp);

  const RayScene rays(scene);
  const Lights lights(scene, rays, RingChoice::kAll, "camera");
  const CameraResponse response(scene.cameras[0], lights.Spectra(), 1e-3);
  const std::vector<PlacedMarker> no_markers;
  const PathTracer tracer(scene, rays, lights, response, no_markers, {});
  const Vec3f origin = camera_position.cast<float>();
  const Vec3f direction = (-camera_position).normalized().cast<float>();
  double sum = 0.0, sum2 = 0.0;
  for (int s = 0; s < samples; ++s) {
    PixelSampler sampler(Mix64(seed), static_cast<uint32_t>(s));
    const Spectral nm = response.SampleWavelengths(sampler.Next1D(), 1.0f);
    const auto value =
        static_cast<double>(tracer.TracePath(origin, direction, nm, sampler).radiance.sum());
    sum += value;
    sum2 += value * value;
  }
  const double mean = sum / samples;
  return {mean, std::sqrt(std::max(0.0, sum2 / samples - mean * mean) / samples)};
}

}  // namespace retrolux
