#include "classifier/edges.h"

#include <algorithm>
#include <cmath>

#include "classifier/debug_pictures.h"
#include "classifier/ellipse_fit.h"
#include "classifier/gradient.h"
#include "classifier/option_range.h"
#include "classifier/pattern.h"
#include "classifier/polygon_fit.h"
#include "classifier/shape_match.h"

namespace retrolux {

namespace {

// What noise leaves of the straightness of an edge, px for a noise of the pattern's height:
// measured over tilts, sizes and rolls, it is 0.5 to 0.8.
constexpr double kNoise_px = 0.8;

// Collects the margins of the limits that a pattern has to keep: 0 at the limit, 1 far away.
class Margins {
 public:
  void AtMost(double value, double limit) { Add(1.0 - value / limit); }
  void AtLeast(double value, double limit) { Add(1.0 - limit / value); }
  bool Kept() const { return smallest_ > 0.0; }
  double Smallest() const { return std::clamp(smallest_, 0.0, 1.0); }

 private:
  void Add(double margin) { smallest_ = std::min(smallest_, margin); }
  double smallest_ = 1.0;
};

Margins PatternMargins(const Pattern& pattern, const EdgesOptions& options) {
  Margins margins;
  margins.AtLeast(pattern.area_px, options.min_area_px);
  margins.AtLeast(pattern.contrast, options.min_contrast_sigma * pattern.noise);
  margins.AtMost(pattern.blur_px, options.max_blur_px);
  // A marker is solid; a hole as large as the smallest pattern is none of its own.
  margins.AtMost(pattern.hole_area_px, options.min_area_px);
  return margins;
}

double StraightLimit(const Pattern& pattern, const EdgesOptions& options) {
  return options.straightness_px + kNoise_px * pattern.noise / pattern.contrast;
}

// Names a pattern with counted edges.
void NamePolygon(const PolygonFit& fit, const MarkerSet& markers, const EdgesOptions& options,
                 Margins margins, Detection& detection) {
  detection.corners_px = fit.corners;
  detection.straight_edges = static_cast<int>(fit.corners.size());
  const std::optional<int> number = markers.NumberWithEdges(detection.straight_edges);
  if (!number) return;
  margins.AtMost(fit.misfit, 1.0);
  margins.AtLeast(fit.gain, options.min_gain);
  const ShapeMatch match = MatchShape(fit.corners, markers.ByNumber(*number), markers.size_mm);
  margins.AtMost(match.rms_px,
                 std::hypot(options.max_shape_error_px, options.max_shape_error * match.size_px));
  margins.AtLeast(match.foreshortening, std::cos(RadFromDeg(options.max_tilt_deg)));
  if (!margins.Kept()) return;
  detection.marker = number;
  detection.confidence = margins.Smallest();
  std::rotate(detection.corners_px.begin(),
              detection.corners_px.begin() + static_cast<ptrdiff_t>(match.first),
              detection.corners_px.end());
}

// Names a pattern without straight edges, if it is the image of a disc and the set has one.
void NameRound(const Pattern& pattern, const MarkerSet& markers, const EdgesOptions& options,
               Margins margins, Detection& detection) {
  const auto disc = std::find_if(markers.shapes.begin(), markers.shapes.end(),
                                 [](const MarkerShape& s) { return s.straight_edges == 0; });
  if (disc == markers.shapes.end()) return;
  const EllipseFit fit = FitEllipse(pattern.outline);
  margins.AtMost(fit.rms_px, StraightLimit(pattern, options) + options.bend * fit.long_px);
  margins.AtLeast(fit.short_px, fit.long_px * std::cos(RadFromDeg(options.max_tilt_deg)));
  if (!margins.Kept()) return;
  detection.marker = disc->number;
  detection.confidence = margins.Smallest();
}

int MostEdges(const MarkerSet& markers) {
  int most = 3;
  for (const MarkerShape& shape : markers.shapes) most = std::max(most, shape.straight_edges);
  return most;
}

Detection Identify(const Pattern& pattern, const MarkerSet& markers, const EdgesOptions& options) {
  Detection detection;
  detection.centroid_px = Centroid(pattern.outline);
  detection.area_px = pattern.area_px;
  const Margins margins = PatternMargins(pattern, options);
  const PolygonFitLimits limits{MostEdges(markers), StraightLimit(pattern, options), options.bend,
                                options.min_edge_px, RadFromDeg(options.min_turn_deg)};
  const auto fit = FitPolygon(pattern.outline, pattern.step_px, limits);
  if (fit && fit->gain >= options.min_gain) {
    NamePolygon(*fit, markers, options, margins, detection);
  } else {
    NameRound(pattern, markers, options, margins, detection);
  }
  return detection;
}

}  // namespace

void EdgesOptions::Check() const {
  const auto check = [](const char* name, double value, double min, double max) {
    CheckOption("edges", name, value, min, max);
  };
  constexpr double kMany = 1e9;
  check("min_area_px", min_area_px, 10.0, kMany);
  check("min_slope_sigma", min_slope_sigma, 1.0, kMany);
  check("min_contrast_sigma", min_contrast_sigma, 1.0, kMany);
  check("max_blur_px", max_blur_px, 0.1, kMany);
  check("straightness_px", straightness_px, 0.01, kMany);
  check("bend", bend, 0.0, 1.0);
  check("min_gain", min_gain, 1.0, kMany);
  check("min_edge_px", min_edge_px, 1.0, kMany);
  check("min_turn_deg", min_turn_deg, 0.0, 90.0);
  check("max_shape_error_px", max_shape_error_px, 0.01, std::numeric_limits<double>::infinity());
  check("max_shape_error", max_shape_error, 0.0, kMany);
  check("max_tilt_deg", max_tilt_deg, 1.0, 90.0);
}

std::vector<Detection> IdentifyByEdges(const DigitalImage& image, const MarkerSet& markers,
                                       const EdgesOptions& options,
                                       const std::filesystem::path* debug) {
  options.Check();
  if (image.dn.width < 3 || image.dn.height < 3) return {};  // no place for a whole pattern
  thread_local GradientField field;
  thread_local EdgeBands bands;
  MeasureGradient(image, field);
  FindEdgeBands(field, options.min_slope_sigma, bands);
  const std::vector<Pattern> patterns = FindPatterns(field, bands, options);
  std::vector<Detection> detections;
  detections.reserve(patterns.size());
  for (const Pattern& pattern : patterns) {
    detections.push_back(Identify(pattern, markers, options));
  }
  if (debug != nullptr) WriteDebugPictures(*debug, {field, bands, patterns, detections});
  return detections;
}

}  // namespace retrolux
