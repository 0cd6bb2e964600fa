#include "analysis/marker_sight.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/surface_samples.h"
#include "renderer/marker_truth.h"

namespace retrolux {

namespace {

constexpr const char* kMask = "mask";
constexpr double kAround_mm = 10.0;
constexpr int kAroundPoints = 8;
constexpr double kReach_mm = 15.0;  // above and below a place's tangent plane

struct Point {
  Vec3d position, normal;
};
// The place and the points around it, in the mask's frame; empty if the mask ends among them.
using Patch = std::vector<Point>;

uint32_t MaskBody(const Scene& scene) {
  const auto mask = std::find_if(scene.objects.begin(), scene.objects.end(),
                                 [](const SceneObject& object) { return object.name == kMask; });
  RETROLUX_CHECK(mask != scene.objects.end(), "no object '{}'", kMask);
  return static_cast<uint32_t>(mask - scene.objects.begin());
}

Patch PatchAt(const RayScene& rays, uint32_t mask, const RigidTransform& world_from_mask,
              const MarkerPlace& place) {
  const Vec3d u = place.normal.unitOrthogonal(), v = place.normal.cross(u);
  const Vec3f down = (world_from_mask.rotation * -place.normal).cast<float>();
  Patch patch;
  for (int i = 0; i <= kAroundPoints; ++i) {
    const double angle = 2.0 * kPi * i / kAroundPoints;
    const double radius = i == kAroundPoints ? 0.0 : kAround_mm;
    const Vec3d above =
        place.at + radius * (std::cos(angle) * u + std::sin(angle) * v) + kReach_mm * place.normal;
    const auto hit = rays.Intersect((world_from_mask * above).cast<float>(), down,
                                    static_cast<float>(2.0 * kReach_mm));
    if (!hit || hit->body != mask) return {};
    patch.push_back({world_from_mask.Inverse() * hit->position.cast<double>(),
                     world_from_mask.rotation.transpose() * hit->shading_normal.cast<double>()});
  }
  return patch;
}

// What a point sends to the camera of its own ring's light, but for a factor that is the same for
// all points of a marker: the sum of f cos over the LEDs.
double RingLight(const CameraSpec& camera, const Bsdf& sheeting, const Point& point) {
  const Vec3d u = point.normal.unitOrthogonal(), v = point.normal.cross(u);
  const auto local = [&](const Vec3d& to) -> Vec3f {
    const Vec3d d = (to - point.position).normalized();
    return Vec3d(d.dot(u), d.dot(v), d.dot(point.normal)).cast<float>();
  };
  const Spectral nm = Spectral::Constant(static_cast<float>(camera.ring->Led().peak_nm));
  const Vec3f wo = local(camera.model.Centre());
  double light = 0.0;
  for (int led = 0; led < camera.ring->count; ++led)
    light += static_cast<double>(sheeting.Evaluate(wo, local(LedCentre(camera, led)), nm).f_cos[0]);
  return light;
}

bool CountsOn(const RayScene& rays, const CameraSpec& camera, const Patch& patch,
              const RigidTransform& world_from_mask, const Bsdf& sheeting,
              const SightLimits& limits) {
  if (patch.empty() || !camera.ring) return false;
  const Vec3d eye = camera.model.Centre();
  const double min_cosine = std::cos(RadFromDeg(limits.max_incidence_deg));
  double dimmest = std::numeric_limits<double>::infinity(), brightest = 0.0;
  for (const Point& p : patch) {
    const Point there{world_from_mask * p.position, world_from_mask.rotation * p.normal};
    if (there.normal.dot((eye - there.position).normalized()) < min_cosine) return false;
    if (!IsSeen(rays, camera.model, there.position, there.normal)) return false;
    const double light = RingLight(camera, sheeting, there);
    dimmest = std::min(dimmest, light);
    brightest = std::max(brightest, light);
  }
  return brightest <= limits.max_fall * dimmest;
}

std::vector<Patch> Patches(const Scene& scene, const std::vector<MarkerPlace>& places) {
  const RayScene rays(scene);
  const uint32_t mask = MaskBody(scene);
  const RigidTransform& world_from_mask = scene.objects[mask].world_from_object;
  std::vector<Patch> patches(places.size());
  ParallelFor(static_cast<int64_t>(places.size()), [&](int64_t i) {
    const auto place = static_cast<size_t>(i);
    patches[place] = PatchAt(rays, mask, world_from_mask, places[place]);
  });
  return patches;
}

}  // namespace

std::vector<MarkerPlace> CandidatePlaces(const Scene& scene, double place_mm2, uint64_t seed) {
  const SurfaceSamples samples = SampleSurface(scene.Object(kMask).mesh, place_mm2, seed);
  // Meshes of small triangles have a point in each: as many as asked for are drawn by area.
  const auto wanted = static_cast<size_t>(samples.area_mm2 / place_mm2);
  std::vector<MarkerPlace> places;
  double area = 0.0;
  for (size_t i = 0; i < samples.Size(); ++i) {
    area += static_cast<double>(samples.areas_mm2[i]);
    if (area < place_mm2 * (static_cast<double>(places.size()) + 0.5)) continue;
    if (places.size() == wanted) break;
    places.push_back({samples.positions[i].cast<double>(), samples.normals[i].cast<double>()});
  }
  return places;
}

SightTable SeePlaces(const Scene& scene, const std::vector<Pose>& poses,
                     const std::vector<MarkerPlace>& places, const Bsdf& sheeting,
                     const SightLimits& limits, Progress& progress) {
  SightTable table{poses, {}};
  const std::vector<Patch> patches = Patches(scene, places);
  progress.Begin("sight", static_cast<int64_t>(poses.size()), "poses");
  for (const Pose& pose : poses) {
    const Scene posed = scene.AtPose(pose);
    const RayScene rays(posed);
    const RigidTransform& world_from_mask = posed.Object(kMask).world_from_object;
    auto& cameras = table.seen.emplace_back();
    for (const CameraSpec& camera : posed.cameras) {
      auto& seen = cameras.emplace_back(places.size(), 0);
      ParallelFor(static_cast<int64_t>(places.size()), [&](int64_t i) {
        const auto place = static_cast<size_t>(i);
        seen[place] = CountsOn(rays, camera, patches[place], world_from_mask, sheeting, limits);
      });
    }
    progress.Advance(1);
  }
  progress.End();
  return table;
}

}  // namespace retrolux
