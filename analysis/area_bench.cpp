#include <cmath>

#include "analysis/area_shapes.h"
#include "analysis/area_tests.h"
#include "core/rng.h"
#include "scenes/mesh_shapes.h"
#include "scenes/rig_layout.h"

namespace retrolux {

namespace {

constexpr double kCoarser = 16.0;

std::unique_ptr<Mask> Sphere(const AreaStudyOptions& options, double part_area_mm2) {
  return std::make_unique<Mask>(
      "sphere", EllipsoidMesh(Vec3d::Constant(kAreaSphereRadius_mm), options.levels), options.rule,
      part_area_mm2, options.seed);
}

}  // namespace

AreaBench::AreaBench(const AreaStudyOptions& options)
    : options_(options),
      room_(LoadScenario("1a").With(
          {"--size",
           {{"cameras", {{"width_px", options.width_px}, {"height_px", options.height_px}}}}})),
      world_from_mask_(RandomRotation(CombineKeys(options.seed, 0))) {}

const Mask& AreaBench::Fine() {
  if (!fine_) fine_ = Sphere(options_, options_.part_area_mm2);
  return *fine_;
}

const Mask& AreaBench::Coarse() {
  if (!coarse_) coarse_ = Sphere(options_, kCoarser * options_.part_area_mm2);
  return *coarse_;
}

CameraModel AreaBench::Camera(const Vec3d& direction, bool far) const {
  const double distance = far ? kAreaFar * Distance_mm() : Distance_mm();
  CameraModel camera = VaultCamera(room_, "camera", distance * direction.normalized());
  if (far) {
    camera.fx *= kAreaFar;
    camera.fy *= kAreaFar;
  }
  return camera;
}

std::vector<SampleSet> AreaBench::Seen(const Mask& mask, const Mat3d& world_from_mask,
                                       const std::vector<CameraModel>& cameras) {
  std::vector<SampleSet> sets(cameras.size());
  ParallelFor(static_cast<int64_t>(cameras.size()), [&](int64_t i) {
    const auto index = static_cast<size_t>(i);
    CameraModel camera = cameras[index];
    camera.camera_from_world =
        camera.camera_from_world * RigidTransform{world_from_mask, Vec3d::Zero()};
    sets[index] = mask.SeenBy(camera);
  });
  return sets;
}

SampleSet InBoth(const SampleSet& a, const SampleSet& b) {
  SampleSet both(a.size());
  for (size_t word = 0; word < a.size(); ++word) both[word] = a[word] & b[word];
  return both;
}

}  // namespace retrolux
