#include "classifier/robust.h"

#include <algorithm>
#include <cmath>

#include "classifier/consensus.h"
#include "classifier/debug_pictures.h"
#include "classifier/judge.h"
#include "classifier/option_range.h"

namespace retrolux {

namespace {

// The same picture seen as its negative: dark patterns become bright.
void MakeNegative(GradientField& field, FloatPlane& relief, EdgeBands& bands) {
  for (float& v : field.smooth.data) v = -v;
  for (float& v : relief.data) v = -v;
  for (EdgeBand& band : bands.bands) {
    band.level.value = -band.level.value;
    band.level.slope = -band.level.slope;
  }
}

EdgesOptions PatternLimits(const RobustOptions& options) {
  EdgesOptions limits;
  limits.min_area_px = options.min_area_px;
  limits.min_slope_sigma = options.min_slope_sigma;
  limits.min_contrast_sigma = options.min_contrast_sigma;
  limits.max_blur_px = options.max_edge_blur_px;
  return limits;
}

// Whether a marker has been named where a pattern is, or the pattern is one judged before.
bool IsSettled(const Pattern& pattern, bool dark, const std::vector<JudgedPattern>& judged) {
  constexpr double kSame_px = 1.0, kSameArea = 1.12;
  const Vec2d middle = Centroid(pattern.outline);
  return std::any_of(judged.begin(), judged.end(), [&](const JudgedPattern& j) {
    const double away = (Centroid(j.outline_px) - middle).norm();
    // The middle of an angle lies outside of it.
    if (j.detection.marker) {
      return Contains(j.fitted_px, middle) || away < 0.25 * std::sqrt(pattern.area_px);
    }
    const double ratio = j.detection.area_px / pattern.area_px;
    return j.dark == dark && away < kSame_px && ratio < kSameArea && ratio > 1.0 / kSameArea;
  });
}

// A named pattern takes the place of what has been found of it before without a name.
void Add(JudgedPattern found, std::vector<JudgedPattern>& judged) {
  if (found.detection.marker) {
    std::erase_if(judged, [&](const JudgedPattern& j) {
      return !j.detection.marker && j.dark == found.dark &&
             Contains(found.fitted_px, Centroid(j.outline_px));
    });
  }
  judged.push_back(std::move(found));
}

double Darkest(const FloatPlane& smooth) {
  return static_cast<double>(*std::min_element(smooth.data.begin(), smooth.data.end()));
}

}  // namespace

void RobustOptions::Check() const {
  const auto check = [](const char* name, double value, double min, double max) {
    CheckOption("robust", name, value, min, max);
  };
  constexpr double kMany = 1e9;
  check("min_area_px", min_area_px, 10.0, kMany);
  check("min_slope_sigma", min_slope_sigma, 1.0, kMany);
  check("min_contrast_sigma", min_contrast_sigma, 1.0, kMany);
  check("max_edge_blur_px", max_edge_blur_px, 0.1, kMany);
  check("turns", turns, 1.0, 8.0);
  check("likely_outline", likely_outline, 0.0, 1.0);
  check("fits", fits, 1.0, 64.0);
  check("patch.margin_px", patch.margin_px, 1.0, 20.0);
  check("patch.most_pixels", patch.most_pixels, 100.0, kMany);
  check("fit.max_steps", fit.max_steps, 1.0, 100.0);
  check("fit.converged_px", fit.converged_px, 1e-6, 1.0);
  check("fit.max_blur_px", fit.max_blur_px, 0.1, std::sqrt(Coverage::kMaxVariance_px2));
  check("fit.curvature", fit.curvature, 1e-4, 1.0);
  check("fit.focal_px", fit.focal_px, 10.0, kMany);
  check("min_probability", min_probability, 0.0, 1.0);
  if (black_dn) check("black_dn", *black_dn, 0.0, 65535.0);
}

std::vector<JudgedPattern> JudgePatterns(const DigitalImage& image, const MarkerSet& markers,
                                         const RobustOptions& options,
                                         const std::filesystem::path* debug) {
  options.Check();
  if (image.dn.width < 3 || image.dn.height < 3) return {};  // no place for a whole pattern
  thread_local GradientField field;
  thread_local FloatPlane relief;
  thread_local EdgeBands bands;
  const EdgesOptions limits = PatternLimits(options);
  MeasureGradient(image, field);
  MeasureRelief(field, relief);
  FindEdgeBands(field, options.min_slope_sigma, bands);
  const std::vector<ShapeModel> models = ModelsOf(markers);
  Judge judge(image, models, markers.dark_square_mm / markers.size_mm, options,
              options.black_dn.value_or(Darkest(field.smooth)));
  std::vector<JudgedPattern> judged;
  const auto decide = [&](const std::vector<Pattern>& patterns, bool dark) {
    for (const Pattern& pattern : patterns) {
      if (IsSettled(pattern, dark, judged)) continue;
      Add(judge.Decide(pattern, field.smooth, dark), judged);
    }
  };
  decide(FindEveryPattern(field, bands, limits), false);
  decide(FindTornPatterns(field, bands, relief, limits), false);
  if (options.dark) {
    MakeNegative(field, relief, bands);
    // Over a dark marker's bright square the light often falls; over a bright marker seldom.
    decide(FindTornPatterns(field, bands, relief, limits), true);
    MakeNegative(field, relief, bands);
  }
  NameByConsensus(models, options.min_probability, judged);
  if (debug != nullptr) WriteDebugPictures(*debug, field, bands, judged);
  return judged;
}

std::vector<Detection> IdentifyRobustly(const DigitalImage& image, const MarkerSet& markers,
                                        const RobustOptions& options,
                                        const std::filesystem::path* debug) {
  std::vector<Detection> detections;
  for (JudgedPattern& judged : JudgePatterns(image, markers, options, debug)) {
    detections.push_back(std::move(judged.detection));
  }
  return detections;
}

}  // namespace retrolux
