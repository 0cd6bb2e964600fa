#include "classifier/pattern.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace retrolux {

namespace {

// Where the pattern and its surroundings are measured, px inside and outside the outline: an edge
// in focus (one pixel's box, then smoothing) ends 2 px from its middle.
constexpr double kBeside_px = 2.5;
// Height over slope of an edge in focus: the kernel of the slope answers a unit step with 3/8 per
// px.
constexpr double kSharpWidth_px = 8.0 / 3.0;
// Steps along the outline: short enough for 3 px edges, few enough for the polygon fit.
constexpr double kStep_px = 0.5;
constexpr int kMinPoints = 32;
constexpr int kMaxPoints = 144;
// Noise of a pixel that still counts as agreement: 3 standard deviations of the mean of two
// smoothed ones.
constexpr double kAgreeNoise = 0.8;
// The outline of a pattern runs on steep pixels, its blunt corners aside.
constexpr double kMinSteepShare = 0.75;

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double NoiseAt(const GradientField& field, const Vec2d& px) {
  return static_cast<double>(
      field.noise.At(static_cast<int>(std::lround(px.x())), static_cast<int>(std::lround(px.y()))));
}

// The picture beside each point of an outline.
struct Profile {
  std::vector<double> inside, outside, contrast;  // DN
  double median_contrast = 0.0;
  double noise = 0.0;  // of a pixel, median over the points
};

Profile MeasureProfile(const GradientField& field, const Polygon& outline) {
  const FloatPlane& smooth = field.smooth;
  Profile profile;
  std::vector<double> noises;
  const size_t n = outline.size();
  for (size_t i = 0; i < n; ++i) {
    const Vec2d along = outline[(i + 1) % n] - outline[(i + n - 1) % n];
    const double length = along.norm();
    const Vec2d outward =
        length > 0.0 ? Vec2d(-along.y() / length, along.x() / length) : Vec2d::Zero().eval();
    noises.push_back(NoiseAt(field, outline[i]));
    const Vec2d in = outline[i] - kBeside_px * outward;
    const Vec2d out = outline[i] + kBeside_px * outward;
    profile.inside.push_back(SampleBilinear(smooth, in.x(), in.y()));
    profile.outside.push_back(SampleBilinear(smooth, out.x(), out.y()));
    profile.contrast.push_back(profile.inside.back() - profile.outside.back());
  }
  profile.median_contrast = Median(profile.contrast);
  profile.noise = Median(std::move(noises));
  return profile;
}

// Half way between the pattern and its surroundings, as a plane. Points beside which there is
// something else (thin parts, tips, notches) do not agree with the others and are left out, in two
// rounds: the light may fall by half over the pattern, so the first is generous.
LevelPlane HalfWay(const Polygon& outline, const Profile& profile) {
  std::vector<double> half(outline.size());
  for (size_t i = 0; i < outline.size(); ++i) {
    half[i] = 0.5 * (profile.inside[i] + profile.outside[i]);
  }
  LevelPlane level;
  level.value = Median(half);
  for (const double agreement : {0.25, 0.08}) {
    LevelFit fit(outline.front());
    for (size_t i = 0; i < outline.size(); ++i) {
      const double away = std::abs(half[i] - level.At(outline[i]));
      if (away <= agreement * profile.median_contrast + kAgreeNoise * profile.noise) {
        fit.Add(outline[i], half[i], 1.0);
      }
    }
    level = fit.Solve();
  }
  return level;
}

// Share of a contour's points on pixels of one band, or of any (kAny).
constexpr int kAny = -1;
double SteepShare(const Polygon& contour, const Plane<int>& labels, int label) {
  int steep = 0;
  for (const Vec2d& p : contour) {
    const int at =
        labels(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
    steep += label == kAny ? at != 0 : at == label;
  }
  return steep / static_cast<double>(contour.size());
}

// The contour of the level that follows this band, and the holes in it.
struct Traced {
  Polygon contour;
  double hole_area_px = 0.0;
};

std::optional<Traced> TraceBand(const GradientField& field, const EdgeBands& bands,
                                const EdgeBand& band, const LevelPlane& level,
                                const EdgesOptions& options) {
  constexpr int kMargin = 2;
  const PixelBox box{std::max(band.box.x0 - kMargin, 0), std::max(band.box.y0 - kMargin, 0),
                     std::min(band.box.x1 + kMargin, field.smooth.width),
                     std::min(band.box.y1 + kMargin, field.smooth.height)};
  const std::vector<Polygon> contours = TraceContours(field.smooth, box, level);
  const Polygon* best = nullptr;
  double best_area = options.min_area_px;
  for (const Polygon& contour : contours) {
    const double area = ScreenArea(contour);
    if (area < best_area) continue;
    if (SteepShare(contour, bands.labels, band.label) < kMinSteepShare) continue;
    best = &contour;
    best_area = area;
  }
  if (best == nullptr) return std::nullopt;
  Traced traced{*best, 0.0};
  for (const Polygon& contour : contours) {
    const double area = ScreenArea(contour);
    if (area < 0.0 && Contains(*best, contour.front())) traced.hole_area_px -= area;
  }
  return traced;
}

Pattern Measure(const GradientField& field, const Traced& traced, const Profile& profile,
                Polygon outline) {
  Pattern pattern;
  std::vector<double> slopes;
  for (const Vec2d& p : outline) slopes.push_back(SampleBilinear(field.slope, p.x(), p.y()));
  pattern.step_px = Perimeter(outline) / static_cast<double>(outline.size());
  pattern.outline = std::move(outline);
  pattern.area_px = ScreenArea(traced.contour);
  pattern.contrast = profile.median_contrast;
  pattern.noise = profile.noise;
  const double width_px = pattern.contrast / std::max(Median(slopes), 1e-9);
  pattern.blur_px = std::max(width_px - kSharpWidth_px, 0.0);
  pattern.hole_area_px = traced.hole_area_px;
  return pattern;
}

Polygon Outline(const Polygon& contour) {
  const double points = Perimeter(contour) / kStep_px;
  return Resample(contour, static_cast<int>(std::clamp<double>(points, kMinPoints, kMaxPoints)));
}

// A traced contour as a pattern, if it is high and sharp enough.
std::optional<Pattern> PatternOf(const GradientField& field, const Traced& traced,
                                 const LevelPlane& level, const EdgesOptions& options) {
  Polygon outline = Outline(traced.contour);
  const Profile profile = MeasureProfile(field, outline);
  Pattern pattern = Measure(field, traced, profile, std::move(outline));
  pattern.level = level;
  const bool high = pattern.contrast >= options.min_contrast_sigma * pattern.noise;
  const bool sharp = pattern.blur_px <= options.max_blur_px;
  if (!high || !sharp) return std::nullopt;
  return pattern;
}

// The outlines exactly half way of a first outline, in the box around it.
std::optional<Pattern> Sharpened(const GradientField& field, const EdgeBands& bands,
                                 const EdgeBand& band, const Polygon& contour,
                                 const EdgesOptions& options) {
  const Polygon first = Outline(contour);
  const Profile first_profile = MeasureProfile(field, first);
  if (!(first_profile.median_contrast > 0.0)) return std::nullopt;
  const LevelPlane half_way = HalfWay(first, first_profile);
  const auto traced = TraceBand(field, bands, band, half_way, options);
  if (!traced) return std::nullopt;
  return PatternOf(field, *traced, half_way, options);
}

bool LargeEnough(const EdgeBand& band, const EdgesOptions& options) {
  const double box_area =
      static_cast<double>(band.box.x1 - band.box.x0) * (band.box.y1 - band.box.y0);
  return box_area >= options.min_area_px;
}

std::optional<Pattern> PatternOfBand(const GradientField& field, const EdgeBands& bands,
                                     const EdgeBand& band, const EdgesOptions& options) {
  if (!LargeEnough(band, options)) return std::nullopt;
  // First at the height where the band is steepest, then exactly half way.
  const auto traced = TraceBand(field, bands, band, band.level, options);
  if (!traced) return std::nullopt;
  return Sharpened(field, bands, band, traced->contour, options);
}

// Half a pixel of what goes on outside shows in the outermost two rows.
bool OffTheBorder(const PixelBox& box, const FloatPlane& picture) {
  return box.x0 > 0 && box.y0 > 0 && box.x1 < picture.width && box.y1 < picture.height;
}

PixelBox BoxAround(const Polygon& contour) {
  Vec2d low = contour.front();
  Vec2d high = low;
  for (const Vec2d& p : contour) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return {static_cast<int>(low.x()) - 1, static_cast<int>(low.y()) - 1,
          static_cast<int>(high.x()) + 3, static_cast<int>(high.y()) + 3};
}

}  // namespace

std::vector<Pattern> FindPatterns(const GradientField& field, const EdgeBands& bands,
                                  const EdgesOptions& options) {
  std::vector<Pattern> patterns;
  for (const EdgeBand& band : bands.bands) {
    // A pattern at the border may go on outside.
    if (!OffTheBorder(band.box, field.smooth)) continue;
    if (auto pattern = PatternOfBand(field, bands, band, options)) {
      patterns.push_back(std::move(*pattern));
    }
  }
  return patterns;
}

std::vector<Pattern> FindTornPatterns(const GradientField& field, const EdgeBands& bands,
                                      const FloatPlane& relief, const EdgesOptions& options) {
  std::vector<Pattern> patterns;
  for (const Polygon& contour : TraceSteepContours(relief, bands.labels)) {
    if (ScreenArea(contour) < options.min_area_px) continue;
    if (SteepShare(contour, bands.labels, kAny) < kMinSteepShare) continue;
    if (!OffTheBorder(BoxAround(contour), relief)) continue;
    const Polygon outline = Outline(contour);
    const Profile profile = MeasureProfile(field, outline);
    if (!(profile.median_contrast > 0.0)) continue;
    const LevelPlane level = HalfWay(outline, profile);
    if (auto pattern = PatternOf(field, {contour, 0.0}, level, options)) {
      pattern->torn = true;
      patterns.push_back(std::move(*pattern));
    }
  }
  return patterns;
}

std::vector<Pattern> FindEveryPattern(const GradientField& field, const EdgeBands& bands,
                                      const EdgesOptions& options) {
  std::vector<Pattern> patterns;
  for (const EdgeBand& band : bands.bands) {
    if (!LargeEnough(band, options)) continue;
    for (const Polygon& contour : TraceContours(field.smooth, band.box, band.level)) {
      if (ScreenArea(contour) < options.min_area_px) continue;
      if (SteepShare(contour, bands.labels, band.label) < kMinSteepShare) continue;
      EdgeBand own = band;
      own.box = BoxAround(contour);
      if (!OffTheBorder(own.box, field.smooth)) continue;
      if (auto pattern = Sharpened(field, bands, own, contour, options)) {
        patterns.push_back(std::move(*pattern));
      }
    }
  }
  return patterns;
}

}  // namespace retrolux
