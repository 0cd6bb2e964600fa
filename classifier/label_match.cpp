#include "classifier/label_match.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace retrolux {

namespace {

// 0 within. The hull of a pixel or of a row of pixels is a point or a line.
double DistanceTo(const Polygon& hull, const Vec2d& point) {
  if (hull.size() > 2 && Contains(hull, point)) return 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < hull.size(); ++i) {
    const Vec2d a = hull[i];
    const Vec2d along = hull[(i + 1) % hull.size()] - a;
    const double length2 = std::max(along.squaredNorm(), std::numeric_limits<double>::min());
    const double share = std::clamp((point - a).dot(along) / length2, 0.0, 1.0);
    least = std::min(least, (point - a - share * along).norm());
  }
  return least;
}

std::optional<size_t> MarkerUnder(const std::vector<LabelledShape>& markers, const Vec2d& point,
                                  double margin_px) {
  std::optional<size_t> under;
  auto least = std::make_tuple(margin_px, std::numeric_limits<double>::infinity());
  for (size_t i = 0; i < markers.size(); ++i) {
    const auto distance = std::make_tuple(DistanceTo(markers[i].hull_px, point),
                                          (point - markers[i].centre_px).norm());
    if (distance >= least) continue;
    least = distance;
    under = i;
  }
  return under;
}

LabelOutcome OutcomeOf(const Detection& detection, const LabelledShape& marker) {
  if (!detection.marker) return LabelOutcome::kUnnamed;
  return *detection.marker == marker.number ? LabelOutcome::kFound : LabelOutcome::kMisnamed;
}

// Whether detection a says more of the marker than b.
bool Decides(const Detection& a, const Detection& b, const LabelledShape& marker) {
  const auto rank = [&](const Detection& d) {
    return std::make_tuple(OutcomeOf(d, marker), -d.confidence,
                           (d.centroid_px - marker.centre_px).norm());
  };
  return rank(a) < rank(b);
}

}  // namespace

PictureMatch MatchDetections(const std::vector<LabelledShape>& markers,
                             const std::vector<Detection>& detections, double margin_px) {
  PictureMatch match;
  match.markers.resize(markers.size());
  for (size_t i = 0; i < detections.size(); ++i) {
    const Detection& detection = detections[i];
    const auto under = MarkerUnder(markers, detection.centroid_px, margin_px);
    match.detections.push_back({Verdict::kUnnamed, under});
    if (!under) continue;
    MarkerOutcome& marker = match.markers[*under];
    if (!marker.detection || Decides(detection, detections[*marker.detection], markers[*under]))
      marker.detection = i;
  }
  for (size_t i = 0; i < detections.size(); ++i) {
    JudgedDetection& judged = match.detections[i];
    if (!detections[i].marker) continue;
    judged.verdict = Verdict::kNothing;
    if (!judged.marker) continue;
    const LabelledShape& shape = markers[*judged.marker];
    MarkerOutcome& marker = match.markers[*judged.marker];
    if (OutcomeOf(detections[i], shape) == LabelOutcome::kMisnamed) {
      judged.verdict = Verdict::kMisnamed;
      ++marker.wrong_names;
    } else if (!shape.counts) {
      judged.verdict = Verdict::kIgnored;
    } else {
      judged.verdict = marker.detection == i ? Verdict::kFound : Verdict::kDuplicate;
    }
  }
  for (size_t k = 0; k < markers.size(); ++k) {
    MarkerOutcome& marker = match.markers[k];
    if (marker.detection) marker.outcome = OutcomeOf(detections[*marker.detection], markers[k]);
  }
  return match;
}

}  // namespace retrolux
