#include "classifier/position_names.h"

#include <cmath>

#include "classifier/projection.h"

namespace retrolux {

namespace {

struct Prediction {
  size_t marker;
  Vec2d px;
  Eigen::Matrix2d covariance;  // px2
};

bool Faces(const CameraModel& camera, const KnownMarker& marker, const RigidTransform& pose,
           double max_incidence_deg) {
  if (!marker.normal) return true;
  const Vec3d to_camera = (camera.Centre() - pose * marker.at).normalized();
  return to_camera.dot(pose.rotation * *marker.normal) > std::cos(RadFromDeg(max_incidence_deg));
}

// Whether a pattern may be a marker: by its name, else by the area that the marker should have. Of
// a marker whose normal is not known only the largest is.
bool MayBe(const Detection& detection, const KnownMarker& marker, const CameraModel& camera,
           const RigidTransform& pose) {
  constexpr double kLargest = 1.5, kSmallest = 0.5;
  if (detection.marker) return *detection.marker == marker.number;
  if (detection.area_px <= 0.0) return true;
  const Vec3d to_camera = camera.Centre() - pose * marker.at;
  const double px2_per_mm2 = camera.fx * camera.fy / to_camera.squaredNorm();
  const double cosine =
      marker.normal ? to_camera.normalized().dot(pose.rotation * *marker.normal) : 1.0;
  const double expected_px2 =
      SignedArea(DefaultMarkerSet().ByNumber(marker.number).outline_mm) * px2_per_mm2 * cosine;
  return detection.area_px < kLargest * expected_px2 &&
         (!marker.normal || detection.area_px > kSmallest * expected_px2);
}

}  // namespace

PositionNames NameByPosition(const CameraModel& camera, const std::vector<Detection>& detections,
                             const std::vector<bool>& free, const Constellation& constellation,
                             const std::vector<bool>& wanted, const RigidTransform& world_from_mask,
                             const std::function<double(const Vec3d& x_in_mask)>& sigma_mm,
                             const PositionOptions& options) {
  std::vector<Prediction> predictions;
  for (size_t m = 0; m < constellation.size(); ++m) {
    const KnownMarker& marker = constellation[m];
    if (!wanted[m] || !Faces(camera, marker, world_from_mask, options.max_incidence_deg)) continue;
    const auto projected = ProjectWithSlope(camera, world_from_mask * marker.at);
    if (!projected || !camera.InFrame(projected->px)) continue;
    const double variance_mm2 = std::pow(sigma_mm(marker.at), 2) / 3.0;  // of each axis
    const Eigen::Matrix2d covariance =
        variance_mm2 * projected->per_mm * projected->per_mm.transpose() +
        options.sigma_px * options.sigma_px * Eigen::Matrix2d::Identity();
    predictions.push_back({m, projected->px, covariance});
  }

  std::vector<PositionName> pairs;  // all within their gates
  std::vector<int> of_marker(constellation.size()), of_detection(detections.size());
  for (const Prediction& prediction : predictions) {
    for (size_t d = 0; d < detections.size(); ++d) {
      const KnownMarker& marker = constellation[prediction.marker];
      if (!free[d] || !MayBe(detections[d], marker, camera, world_from_mask)) continue;
      const Vec2d off = PointOf(detections[d], options.point) - prediction.px;
      const double sigmas = std::sqrt(off.dot(prediction.covariance.inverse() * off));
      if (sigmas > options.gate_sigma) continue;
      const double gate_px = sigmas > 0.0 ? off.norm() / sigmas * options.gate_sigma : 0.0;
      pairs.push_back({prediction.marker, d, off.norm(), gate_px});
      ++of_marker[prediction.marker];
      ++of_detection[d];
    }
  }
  PositionNames names;
  for (const PositionName& pair : pairs) {
    if (of_marker[pair.marker] == 1 && of_detection[pair.detection] == 1) {
      names.named.push_back(pair);
    } else if (names.ambiguous.empty() || names.ambiguous.back() != pair.marker) {
      names.ambiguous.push_back(pair.marker);
    }
  }
  return names;
}

}  // namespace retrolux
