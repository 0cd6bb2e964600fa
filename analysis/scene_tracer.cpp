#include "analysis/scene_tracer.h"

namespace retrolux {

SceneTracer::SceneTracer(const Scene& scene, const TraceOptions& options)
    : rays_(scene),
      lights_(scene, rays_, RingChoice::kAll, scene.cameras.front().model.name),
      response_(scene.cameras.front(), lights_.Spectra(), 1e-3),
      tracer_(scene, rays_, lights_, response_, no_markers_, options) {}

double SceneTracer::Radiance(const Vec3f& origin, const Vec3f& target,
                             PixelSampler& sampler) const {
  const Spectral nm = response_.SampleWavelengths(sampler.Next1D(), 1.0f);
  return static_cast<double>(
      tracer_.TracePath(origin, (target - origin).normalized(), nm, sampler).radiance.sum());
}

}  // namespace retrolux
