// One camera of a scene, ready to trace: for checks and measurements that look at single paths and
// pixels.
#pragma once

#include "renderer/path_tracer.h"

namespace retrolux {

class SceneTracer {
 public:
  // The scene's first camera, no markers, exposed for 1 ms. `scene` must outlive the object.
  explicit SceneTracer(const Scene& scene, const TraceOptions& options = {});
  SceneTracer(const SceneTracer&) = delete;
  SceneTracer& operator=(const SceneTracer&) = delete;

  PixelEstimate EstimatePixel(int x, int y) const { return tracer_.EstimatePixel(x, y); }
  // Band radiance of all light groups along the ray from `origin` to `target`, one sample,
  // W/(m2 sr).
  double Radiance(const Vec3f& origin, const Vec3f& target, PixelSampler& sampler) const;

 private:
  RayScene rays_;
  Lights lights_;
  CameraResponse response_;
  std::vector<PlacedMarker> no_markers_;
  PathTracer tracer_;
};

}  // namespace retrolux
