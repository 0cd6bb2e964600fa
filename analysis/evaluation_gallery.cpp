#include "analysis/evaluation_gallery.h"

#include <algorithm>
#include <cmath>

#include "analysis/picture_canvas.h"
#include "core/image_file.h"

namespace retrolux {

namespace {

using namespace canvas_colour;

constexpr double kScale = 4.0;
constexpr int kMargin_px = 14;  // around a marker
constexpr double kTextSize = 0.5;
constexpr double kFalseReach_px = 24.0;  // around a false positive without corners

// A place in a picture that is shown.
struct Spot {
  size_t picture = 0;
  std::optional<size_t> marker;  // of the evaluation
  const Detection* detection = nullptr;
  double rank = 0.0;  // largest first

  static bool First(const Spot& a, const Spot& b) { return a.rank > b.rank; }
};

Polygon Around(const Vec2d& centre, double reach) {
  return {centre - Vec2d(reach, reach), centre + Vec2d(reach, reach)};
}

CanvasView ViewOf(const Polygon& shown, const DigitalImage& image) {
  Vec2d low = shown.front(), high = low;
  for (const Vec2d& p : shown) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const auto within = [](double value, int size) {
    return std::clamp(static_cast<int>(std::lround(value)), 0, size - 1);
  };
  CanvasView view;
  view.x0 = within(low.x() - kMargin_px, image.dn.width);
  view.y0 = within(low.y() - kMargin_px, image.dn.height);
  view.width = within(high.x() + kMargin_px, image.dn.width) - view.x0 + 1;
  view.height = within(high.y() + kMargin_px, image.dn.height) - view.y0 + 1;
  view.scale = kScale;
  int brightest = 1;
  for (int y = view.y0; y < view.y0 + view.height; ++y) {
    for (int x = view.x0; x < view.x0 + view.width; ++x)
      brightest = std::max<int>(brightest, image.dn(x, y));
  }
  view.white_dn = brightest;
  return view;
}

void DrawDetection(const Detection& detection, PictureCanvas& canvas) {
  canvas.Closed(detection.corners_px, kRed);
  canvas.Cross(detection.centroid_px, kRed);
  canvas.Text(detection.centroid_px + Vec2d(2.0, -1.0),
              detection.marker ? MarkerName(*detection.marker) : "?", kTextSize, kRed);
}

std::string LabelOf(const Evaluation& evaluation, const Spot& spot) {
  const EvaluatedPicture& picture = evaluation.pictures[spot.picture];
  std::string text = picture.scene->name + " " + picture.picture->camera;
  if (spot.marker) {
    const MarkerLabel& label = *evaluation.markers[*spot.marker].label;
    text += fmt::format(": {}{}, {:.0f} deg, {:.0f} px, {:.0f} % visible", MarkerName(label.number),
                        label.dark ? " dark" : "", label.incidence_deg, label.size_px,
                        100.0 * label.visible_fraction);
    if (label.snr) text += fmt::format(", SNR {:.1f}", *label.snr);
  }
  if (spot.detection && spot.detection->marker) {
    text += fmt::format("; named {} ({:.3f})", MarkerName(*spot.detection->marker),
                        spot.detection->confidence);
  }
  return text;
}

LabelledPicture Draw(const Evaluation& evaluation, const std::filesystem::path& dataset,
                     const Spot& spot) {
  const DatasetPicture& picture = *evaluation.pictures[spot.picture].picture;
  const DigitalImage image = ReadGrey(dataset / picture.file);
  const EvaluatedMarker* marker = spot.marker ? &evaluation.markers[*spot.marker] : nullptr;
  const Polygon shown =
      marker ? marker->shape.hull_px : Around(spot.detection->centroid_px, kFalseReach_px);
  const CanvasView view = ViewOf(shown, image);
  PictureCanvas canvas(image, view);
  if (marker) {
    canvas.Border(DecodeRuns(marker->label->visible), kGreen);
    canvas.Text(Vec2d(view.x0 + 1, view.y0 + 4), MarkerName(marker->label->number), kTextSize,
                kGreen);
  }
  if (spot.detection) DrawDetection(*spot.detection, canvas);
  return {LabelOf(evaluation, spot), canvas.Png()};
}

std::vector<LabelledPicture> DrawFirst(const Evaluation& evaluation,
                                       const std::filesystem::path& dataset,
                                       std::vector<Spot> spots, size_t most) {
  std::stable_sort(spots.begin(), spots.end(), Spot::First);
  spots.resize(std::min(spots.size(), most));
  std::vector<LabelledPicture> pictures;
  for (const Spot& spot : spots) pictures.push_back(Draw(evaluation, dataset, spot));
  return pictures;
}

std::vector<Spot> WrongNames(const Evaluation& evaluation, const MethodResult& method,
                             bool on_marker) {
  std::vector<Spot> spots;
  for (size_t p = 0; p < evaluation.pictures.size(); ++p) {
    for (size_t i = 0; i < method.verdicts[p].size(); ++i) {
      const JudgedDetection& judged = method.verdicts[p][i];
      const bool misnamed = judged.verdict == Verdict::kMisnamed;
      const bool nothing =
          judged.verdict == Verdict::kNothing || judged.verdict == Verdict::kDuplicate;
      if (!(on_marker ? misnamed : nothing)) continue;
      const Detection& detection = method.detections[p][i];
      Spot spot{p, std::nullopt, &detection, detection.confidence};
      if (judged.marker) spot.marker = evaluation.pictures[p].first_marker + *judged.marker;
      spots.push_back(spot);
    }
  }
  return spots;
}

std::vector<Spot> Missed(const Evaluation& evaluation, const MethodResult& method) {
  const EvaluationLimits& limits = evaluation.limits;
  std::vector<Spot> spots;
  for (size_t i = 0; i < evaluation.markers.size(); ++i) {
    const EvaluatedMarker& marker = evaluation.markers[i];
    const MarkerOutcome& match = method.markers[i].match;
    const MarkerLabel& label = *marker.label;
    const bool expected = marker.whole && label.size_px >= limits.target_size_px &&
                          label.incidence_deg < limits.target_steep_incidence_deg;
    if (!expected || match.outcome == LabelOutcome::kFound) continue;
    Spot spot{marker.picture, i, nullptr, label.snr.value_or(0.0)};
    if (match.detection) spot.detection = &evaluation.DetectionsAt(method, i)[*match.detection];
    spots.push_back(spot);
  }
  return spots;
}

}  // namespace

EvaluationGallery MakeEvaluationGallery(const Evaluation& evaluation, const MethodResult& method,
                                        const std::filesystem::path& dataset, size_t most) {
  return {DrawFirst(evaluation, dataset, WrongNames(evaluation, method, true), most),
          DrawFirst(evaluation, dataset, WrongNames(evaluation, method, false), most),
          DrawFirst(evaluation, dataset, Missed(evaluation, method), most)};
}

}  // namespace retrolux
