// Spectral unidirectional path tracing with next-event estimation and multiple importance sampling,
// for the pixels of one camera.
#pragma once

#include "core/sampler.h"
#include "renderer/camera_response.h"
#include "renderer/lens.h"
#include "renderer/pixel_spread.h"
#include "scenes/marker_placement.h"

namespace retrolux {

// TraceOptions::own_ray_share of what renders many pictures.
inline constexpr float kStrongGroups = 0.1f;

struct TraceOptions {
  int samples_per_pixel = 64;
  uint64_t seed = 1;
  // Light groups that bring at least this share of the unshadowed electrons to the first surface of
  // a path get a shadow ray each; of the rest, and at further surfaces of all, one is drawn in
  // proportion to its electrons. 0: every group its own, so that each is as clean as it can be.
  // Larger: fewer rays, and as clean a sum where nothing is shadowed, but noisier groups. Unbiased.
  float own_ray_share = 0.0f;
  int max_surfaces = 6;  // that scatter, of a path
  // Chance of a path to go on, for each unit of the throughput that it carries (at most 0.95).
  // Lower is faster, and noisier in the indirect light only.
  float roulette = 1.0f;
};

// The share of a pixel that shows a marker, for the three that show most; 0 = none.
struct MarkerCoverage {
  std::array<uint32_t, 3> instance{};
  std::array<float, 3> weight{};
  // Mean electrons of the samples that show the ranked marker, times its weight: what the marker
  // contributes.
  std::array<float, 3> electrons{};
};

struct PixelEstimate {
  GroupValues electrons = GroupValues::Zero();  // noiseless mean signal by light group
  float variance = 0.0f;  // of the mean of the sum, from the scatter of the samples (an upper
                          // bound: the points are better spread than independent ones)
  float radiance = 0.0f;  // in band, W/(m2 sr)
  MarkerCoverage coverage;
};

class PathTracer {
 public:
  // All references must outlive the tracer. `markers` may change between estimates, not during one.
  PathTracer(const Scene& scene, const RayScene& rays, const Lights& lights,
             const CameraResponse& response, const std::vector<PlacedMarker>& markers,
             const TraceOptions& options);

  // The pixel's box of one by one px, as the lens draws it (all but LensScatter). Depends on
  // nothing but the scene, the seed and (x, y).
  PixelEstimate EstimatePixel(int x, int y) const {
    return EstimatePixel(x, y, options_.samples_per_pixel);
  }
  PixelEstimate EstimatePixel(int x, int y, int samples) const;

  // Band radiance by light group along a ray, one sample, with the marker that it meets first (0:
  // none).
  struct PathSample {
    GroupValues radiance = GroupValues::Zero();
    uint32_t marker = 0;
  };
  PathSample TracePath(Vec3f origin, Vec3f direction, const Spectral& nm,
                       PixelSampler& sampler) const;

 private:
  struct Vertex;
  // A ray from a place that the pixel counts, through a place of the aperture.
  std::optional<LensRays::LensRay> SampleLens(int x, int y, PixelSampler& sampler) const;
  Vertex MakeVertex(const Vec3f& direction, const SurfaceHit& hit) const;
  void AddDirect(const Vertex& vertex, const Spectral& throughput, const Spectral& nm,
                 float own_ray_share, PixelSampler& sampler, GroupValues& radiance) const;

  const Scene& scene_;
  const RayScene& rays_;
  const Lights& lights_;
  const CameraResponse& response_;
  LensRays lens_;
  PixelSpread spread_;
  const std::vector<PlacedMarker>& markers_;
  TraceOptions options_;
  uint64_t image_key_;
  std::vector<const Material*> material_of_object_;
  GroupValues group_value_ = GroupValues::Zero();  // electrons per W/(m2 sr), on the axis
};

}  // namespace retrolux
