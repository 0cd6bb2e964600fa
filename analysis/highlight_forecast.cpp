#include "analysis/highlight_forecast.h"

#include <cmath>

#include "analysis/cross_highlight.h"
#include "analysis/hotspot_light.h"
#include "core/sampling.h"
#include "renderer/exposure.h"

namespace retrolux {

namespace {

// Every second row and column is looked at: a highlight of roughness 0.02 on a curvature of 100 mm
// is 4 px wide.
constexpr int kStep_px = 2;

// The brightest point so far in the light of one ring.
struct Brightest {
  double radiance_w_m2_sr = 0.0;
  Vec3d at = Vec3d::Zero();
};

class Forecaster {
 public:
  Forecaster(const Scene& scene, const RayScene& rays, const CameraSpec& camera, size_t mask)
      : scene_(scene),
        rays_(rays),
        camera_(camera),
        coat_(WithGlintsOnly(scene).materials.at(scene.objects[mask].material).bsdf),
        brightest_(scene.cameras.size()) {}

  // A point of the mask that the camera sees.
  void Look(const Vec3d& at, const Vec3d& normal) {
    const Frame frame(normal.cast<float>());
    const auto local = [&](const Vec3d& direction) {
      return frame.LocalFromWorld(direction.cast<float>());
    };
    const Vec3f to_eye = local((camera_.model.Centre() - at).normalized());
    for (size_t r = 0; r < brightest_.size(); ++r) {
      const CameraSpec& lamp = scene_.cameras[r];
      const Vec3d towards = lamp.model.Centre() - at;
      const double cosine = towards.normalized().dot(normal);
      if (cosine <= 0.0) continue;
      const double f_cos = static_cast<double>(
          coat_->Evaluate(to_eye, local(towards.normalized()), Wavelength(lamp)).f_cos[0]);
      // No diode shines brighter than along its axis.
      const double most = lamp.ring->count * lamp.ring->Intensity_w_sr() * f_cos /
                          (1e-6 * std::pow(towards.norm() - lamp.ring->radius_mm, 2));
      if (most > brightest_[r].radiance_w_m2_sr) Try(r, at, normal, f_cos / cosine);
    }
  }

  std::vector<HighlightForecast> Forecasts() const {
    const Lights lights(scene_, rays_, RingChoice::kAll, camera_.model.name);
    const CameraResponse response(camera_, lights.Spectra(), ExposureSeconds(scene_, camera_));
    std::vector<HighlightForecast> forecasts;
    for (size_t r = 0; r < brightest_.size(); ++r) {
      const auto& [radiance, at] = brightest_[r];
      const double cosine = (at - camera_.model.Centre()).normalized().dot(camera_.model.Forward());
      // The groups of light begin with the rings, in the order of the cameras.
      const double e_per_radiance = response.ExpectedElectrons(
          lights.SpectrumOf(static_cast<int>(r)), cosine, std::pow(cosine, 4));
      forecasts.push_back({radiance * e_per_radiance, {at.x(), at.y(), at.z()}});
    }
    return forecasts;
  }

 private:
  static Spectral Wavelength(const CameraSpec& lamp) {
    return Spectral::Constant(static_cast<float>(lamp.ring->peak_nm));
  }

  void Try(size_t ring, const Vec3d& at, const Vec3d& normal, double brdf) {
    const CameraSpec& lamp = scene_.cameras[ring];
    const double radiance = brdf * RingIrradiance_w_m2(lamp, at, normal);
    if (radiance <= brightest_[ring].radiance_w_m2_sr) return;
    const Vec3f from = OffSurface(at.cast<float>(), normal.cast<float>());
    if (rays_.Occluded(from, lamp.model.Centre().cast<float>())) return;
    brightest_[ring] = {radiance, at};
  }

  const Scene& scene_;
  const RayScene& rays_;
  const CameraSpec& camera_;
  std::shared_ptr<const Bsdf> coat_;
  std::vector<Brightest> brightest_;
};

Vec3d At(const std::array<FloatPlane, 3>& planes, int x, int y) {
  return {static_cast<double>(planes[0](x, y)), static_cast<double>(planes[1](x, y)),
          static_cast<double>(planes[2](x, y))};
}

}  // namespace

std::vector<HighlightForecast> ForecastHighlights(const Scene& scene, const RayScene& rays,
                                                  const CameraSpec& camera, size_t mask) {
  const IdBuffers ids = RenderIds(rays, camera.model, {});
  Forecaster forecaster(scene, rays, camera, mask);
  for (int y = 0; y < ids.object.height; y += kStep_px) {
    for (int x = 0; x < ids.object.width; x += kStep_px) {
      if (ids.object(x, y) == mask + 1)
        forecaster.Look(At(ids.position, x, y), At(ids.normal, x, y));
    }
  }
  return forecaster.Forecasts();
}

}  // namespace retrolux
