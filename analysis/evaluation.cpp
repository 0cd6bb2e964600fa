#include "analysis/evaluation.h"

#include "core/parallel.h"

namespace retrolux {

namespace {

// Corners of the convex hull of the pixels: a column's first and last of each run are enough.
Polygon HullOf(const RunLengths& runs) {
  Polygon ends;
  const auto height = static_cast<uint32_t>(runs.height);
  uint32_t at = 0;
  for (size_t i = 0; i < runs.counts.size(); ++i) {
    const uint32_t end = at + runs.counts[i];
    if (i % 2 == 1) {
      for (uint32_t first = at; first < end; first = (first / height + 1) * height) {
        const uint32_t last = std::min(end, (first / height + 1) * height) - 1;
        const double x = first / height;
        ends.emplace_back(x, first % height);
        ends.emplace_back(x, last % height);
      }
    }
    at = end;
  }
  return ConvexHull(ends);
}

// Visible pixels of an oblique marker on a curved surface may all lie outside its flat outline.
Polygon HullOf(const MarkerLabel& label) {
  return HullOf(label.amodal.Area() > 0 ? label.amodal : label.visible);
}

std::optional<Vec2d> TiltInPicture(const MarkerLabel& label, CameraModel camera,
                                   const EvaluationLimits& limits) {
  if (label.incidence_deg < limits.min_tilt_deg) return std::nullopt;
  constexpr double kStep_mm = 0.1;
  camera.camera_from_world = RigidTransform();
  const Vec3d at = label.camera_from_marker.translation;
  const Vec3d normal = label.camera_from_marker.rotation.col(2);
  const auto foot = camera.Project(at);
  const auto tip = camera.Project(at + kStep_mm * normal);
  if (!foot || !tip) return std::nullopt;
  return Vec2d((*tip - *foot).normalized());
}

EvaluatedMarker MarkerOf(const DatasetPicture& picture, size_t index, const MarkerLabel& label,
                         const EvaluationLimits& limits) {
  EvaluatedMarker marker;
  marker.picture = index;
  marker.label = &label;
  marker.shape.number = label.number;
  marker.shape.hull_px = HullOf(label);
  const Vec2d centre = label.centroid_outline_px.value_or(
      label.centroid_projected_px.value_or(marker.shape.hull_px.front()));
  marker.shape.centre_px = centre;
  marker.shape.counts = label.visible_fraction >= limits.min_visible_fraction;
  marker.whole = label.in_frame && label.visible_fraction >= limits.whole_fraction;
  const Vec2d half(0.5 * picture.model.width, 0.5 * picture.model.height);
  marker.frame_position = (centre - half + Vec2d(0.5, 0.5)).norm() / half.norm();
  marker.tilt = TiltInPicture(label, picture.model, limits);
  return marker;
}

std::optional<PlaceError> ErrorOf(const Vec2d& measured, const std::optional<Vec2d>& truth,
                                  const EvaluatedMarker& marker) {
  if (!truth) return std::nullopt;
  return PlaceError{measured - *truth, marker.tilt, std::nullopt};
}

MarkerResult ResultOf(const EvaluatedMarker& marker, const MarkerOutcome& match,
                      const std::vector<Detection>& detections) {
  MarkerResult result{match, std::nullopt, std::nullopt, {}};
  if (match.outcome != LabelOutcome::kFound) return result;
  const MarkerLabel& label = *marker.label;
  const Detection& detection = detections[*match.detection];
  const auto& truth = label.dark ? label.centroid_outline_px : label.centroid_radiometric_px;
  result.centroid = ErrorOf(detection.centroid_px, truth, marker);
  result.outline = ErrorOf(detection.centroid_px, label.centroid_outline_px, marker);
  std::vector<std::optional<Vec2d>> corners;
  for (const MarkerKeypoint& corner : label.corners) {
    corners.push_back(corner.visibility == KeypointVisibility::kVisible ? corner.px : std::nullopt);
  }
  result.corners = CornerErrors(detection.corners_px, corners, marker.shape.centre_px, marker.tilt);
  return result;
}

}  // namespace

std::string MarkerName(int number) {
  return number == 0 ? "standard" : std::to_string(number);
}

Evaluation PrepareEvaluation(const DatasetIndex& index, const std::string& split,
                             const EvaluationLimits& limits) {
  Evaluation evaluation{limits, split, {}, {}, {}};
  for (const DatasetScene& scene : index.scenes) {
    if (split != "all" && scene.split != split) continue;
    for (const DatasetPicture& picture : scene.pictures) {
      EvaluatedPicture evaluated{&scene, &picture, evaluation.markers.size(), 0};
      for (const MarkerLabel& label : picture.markers) {
        if (label.visible.Area() == 0) continue;
        evaluation.markers.push_back(MarkerOf(picture, evaluation.pictures.size(), label, limits));
        ++evaluated.marker_count;
      }
      evaluation.pictures.push_back(evaluated);
    }
  }
  if (evaluation.pictures.empty()) {
    throw InputError(fmt::format("--split {}: no pictures; the dataset's splits hold {}", split,
                                 index.header.at("splits").dump()));
  }
  return evaluation;
}

MethodResult ScoreMethod(const Evaluation& evaluation, const std::string& method,
                         std::vector<std::vector<Detection>> detections) {
  RETROLUX_CHECK(detections.size() == evaluation.pictures.size(), "{} of {} pictures",
                 detections.size(), evaluation.pictures.size());
  MethodResult result{method, std::move(detections), {}, {}};
  result.verdicts.resize(evaluation.pictures.size());
  result.markers.resize(evaluation.markers.size());
  ParallelFor(static_cast<int64_t>(evaluation.pictures.size()), [&](int64_t number) {
    const auto i = static_cast<size_t>(number);
    const EvaluatedPicture& picture = evaluation.pictures[i];
    std::vector<LabelledShape> shapes;
    for (size_t k = 0; k < picture.marker_count; ++k)
      shapes.push_back(evaluation.markers[picture.first_marker + k].shape);
    PictureMatch match = MatchDetections(shapes, result.detections[i], evaluation.limits.margin_px);
    result.verdicts[i] = std::move(match.detections);
    for (size_t k = 0; k < picture.marker_count; ++k) {
      const size_t at = picture.first_marker + k;
      result.markers[at] = ResultOf(evaluation.markers[at], match.markers[k], result.detections[i]);
    }
  });
  return result;
}

}  // namespace retrolux
