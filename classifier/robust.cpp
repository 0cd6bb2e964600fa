#include "classifier/robust.h"

#include <algorithm>
#include <cmath>

#include "classifier/debug_pictures.h"
#include "classifier/judge.h"
#include "classifier/option_range.h"

namespace retrolux {

namespace {

// Other names that it takes to refute one by its size: of shapes of three or four edges, which
// parts of others imitate, and of the rest.
size_t Witnesses(const JudgedPattern& judged) {
  const int edges = judged.detection.straight_edges;
  return edges == 3 || edges == 4 ? 1 : 3;
}

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

// The sizes that a named pattern may have. A triangle looks the same from each of its corners, and
// each says another size.
std::vector<double> SizesOf(const JudgedPattern& judged, const std::vector<ShapeModel>& models) {
  const Polygon& found = judged.detection.corners_px;
  if (found.size() != 3) return {judged.evidence.half_size_px};
  const auto model = std::find_if(models.begin(), models.end(), [&](const ShapeModel& m) {
    return m.number == judged.detection.marker;
  });
  const Polygon& seen = model->corners;
  Eigen::Matrix2d sides;
  sides << seen[1] - seen[0], seen[2] - seen[0];
  std::vector<double> sizes;
  for (size_t first = 0; first < 3; ++first) {
    const Vec2d& corner = found[first];
    Eigen::Matrix2d mapped;
    mapped << found[(first + 1) % 3] - corner, found[(first + 2) % 3] - corner;
    sizes.push_back(ViewOf(mapped * sides.inverse()).half_size_px);
  }
  return sizes;
}

// Takes the names away whose markers would be much larger or smaller than all others say.
void DropOddSizes(double max_ratio, const std::vector<ShapeModel>& models,
                  std::vector<JudgedPattern>& judged) {
  std::vector<JudgedPattern*> odd;
  for (JudgedPattern& j : judged) {
    if (!j.detection.marker) continue;
    std::vector<double> others;
    for (const JudgedPattern& other : judged) {
      const bool tells =
          &other != &j && other.detection.marker && other.evidence.straight_edges != 3;
      if (tells) others.push_back(other.evidence.half_size_px);
    }
    if (others.size() < Witnesses(j)) continue;
    const auto middle = others.begin() + static_cast<ptrdiff_t>(others.size() / 2);
    std::nth_element(others.begin(), middle, others.end());
    const std::vector<double> sizes = SizesOf(j, models);
    const bool fits = std::any_of(sizes.begin(), sizes.end(), [&](double size) {
      return size < max_ratio * *middle && size > *middle / max_ratio;
    });
    if (!fits) odd.push_back(&j);
  }
  for (JudgedPattern* j : odd) {
    j->detection.marker.reset();
    j->detection.confidence = 0.0;
  }
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
  check("max_size_ratio", max_size_ratio, 1.0, kMany);
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
  DropOddSizes(options.max_size_ratio, models, judged);
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
