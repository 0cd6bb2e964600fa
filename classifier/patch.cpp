#include "classifier/patch.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace retrolux {

namespace {

// Outermost pixels of a blurred pattern are above its level though outside its outline.
constexpr int kOwn_px = 1;
// A neighbour's edge reaches this far.
constexpr int kNeighbour_px = 3;

Plane<uint8_t> CentresInside(const Polygon& outline, int width, int height) {
  Plane<uint8_t> inside(width, height, 0);
  std::vector<double> crossings;
  for (int y = 0; y < height; ++y) {
    crossings.clear();
    for (size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
      const Vec2d& a = outline[i];
      const Vec2d& b = outline[j];
      if ((a.y() > y) == (b.y() > y)) continue;
      crossings.push_back(a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()));
    }
    std::sort(crossings.begin(), crossings.end());
    for (size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const int first = std::max(static_cast<int>(std::ceil(crossings[i])), 0);
      const int last = std::min(static_cast<int>(std::floor(crossings[i + 1])), width - 1);
      for (int x = first; x <= last; ++x) inside(x, y) = 1;
    }
  }
  return inside;
}

// 1 wherever there is a 1 within a square of `reach` pixels around.
Plane<uint8_t> Grown(const Plane<uint8_t>& mask, int reach) {
  const auto pass = [&](const Plane<uint8_t>& from, bool rows) {
    Plane<uint8_t> to(from.width, from.height, 0);
    const int length = rows ? from.width : from.height;
    const int lines = rows ? from.height : from.width;
    for (int line = 0; line < lines; ++line) {
      int until = -1;  // the last place that a 1 passed so far reaches
      for (int at = -reach; at < length; ++at) {
        const int ahead = at + reach;
        if (ahead < length && (rows ? from(ahead, line) : from(line, ahead)) != 0) {
          until = ahead + reach;
        }
        if (at >= 0 && at <= until) (rows ? to(at, line) : to(line, at)) = 1;
      }
    }
    return to;
  };
  return pass(pass(mask, true), false);
}

float MeanOfBlock(const Plane<uint16_t>& dn, int x0, int y0, int side) {
  int64_t sum = 0;
  for (int y = y0; y < y0 + side; ++y) {
    for (int x = x0; x < x0 + side; ++x) sum += dn(x, y);
  }
  return static_cast<float>(sum) / static_cast<float>(side * side);
}

// Of the pixels whose neighbours are all inside, as TileNoise does it in gradient.cpp (Immerkaer
// 1996); nothing if there are too few.
std::optional<double> NoiseInside(const Patch& patch) {
  constexpr size_t kLeast = 16;
  std::vector<float> responses;
  const auto at = [&](int x, int y) { return patch.dn(x, y); };
  for (int y = 1; y + 1 < patch.dn.height; ++y) {
    for (int x = 1; x + 1 < patch.dn.width; ++x) {
      int around = 0;
      for (int k = 0; k < 9; ++k) around += patch.inside(x - 1 + k % 3, y - 1 + k / 3);
      if (around < 9) continue;
      const float cross = at(x - 1, y) + at(x + 1, y) + at(x, y - 1) + at(x, y + 1);
      const float corners =
          at(x - 1, y - 1) + at(x + 1, y - 1) + at(x - 1, y + 1) + at(x + 1, y + 1);
      responses.push_back(std::abs(corners - 2.0f * cross + 4.0f * at(x, y)));
    }
  }
  if (responses.size() < kLeast) return std::nullopt;
  const auto middle = responses.begin() + static_cast<ptrdiff_t>(responses.size() / 2);
  std::nth_element(responses.begin(), middle, responses.end());
  return static_cast<double>(*middle) / (6.0 * 0.6745);
}

// What the ground is off a plane, rms, where blur brings no light of the pattern.
double Roughness(const Patch& patch) {
  constexpr int kClear_px = 2;
  constexpr int kLeast = 16;
  const Plane<uint8_t> near = Grown(patch.inside, kClear_px - 1);
  std::vector<std::pair<Vec2d, double>> pixels;
  LevelFit fit(Vec2d(0.5 * patch.dn.width, 0.5 * patch.dn.height));
  for (int y = 0; y < patch.dn.height; ++y) {
    for (int x = 0; x < patch.dn.width; ++x) {
      if (patch.used(x, y) == 0 || near(x, y) != 0) continue;
      pixels.emplace_back(Vec2d(x, y), static_cast<double>(patch.dn(x, y)));
      fit.Add(pixels.back().first, pixels.back().second, 1.0);
    }
  }
  if (static_cast<int>(pixels.size()) < kLeast) return 0.0;
  const LevelPlane plane = fit.Solve();
  double squares = 0.0;
  for (const auto& [px, dn] : pixels) squares += std::pow(dn - plane.At(px), 2);
  return std::sqrt(squares / static_cast<double>(pixels.size()));
}

// A ground of holes and texture is noise, too, as long as it is far below the pattern.
double NoiseOf(const Patch& patch, const Pattern& pattern) {
  constexpr double kMostRoughness = 0.06;  // of the contrast
  const double rough = std::min(Roughness(patch), kMostRoughness * pattern.contrast);
  const double outside = std::max(pattern.noise / patch.scale, rough);
  const double inside = std::max(NoiseInside(patch).value_or(0.0), pattern.noise / patch.scale);
  int marked = 0;
  for (const uint8_t in : patch.inside.data) marked += in;
  const double share = marked / std::max<double>(patch.count, 1.0);
  return std::sqrt(share * inside * inside + (1.0 - share) * outside * outside);
}

}  // namespace

Patch CutPatch(const DigitalImage& image, const FloatPlane& height, const Pattern& pattern,
               const Polygon& reach, const PatchOptions& options) {
  Vec2d low = pattern.outline.front();
  Vec2d high = low;
  for (const Polygon* points : {&pattern.outline, &reach}) {
    for (const Vec2d& p : *points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  const Vec2d span = high - low;
  Patch patch;
  patch.scale = std::max(
      1, static_cast<int>(std::ceil(std::sqrt(span.x() * span.y() / options.most_pixels))));
  const int k = patch.scale;
  const int margin = (options.margin_px + 3) * k;  // and what blur and refinement need
  const int x0 = std::max(static_cast<int>(std::floor(low.x())) - margin, 0);
  const int y0 = std::max(static_cast<int>(std::floor(low.y())) - margin, 0);
  const int width = (std::min(static_cast<int>(high.x()) + margin + 1, image.dn.width) - x0) / k;
  const int rows = (std::min(static_cast<int>(high.y()) + margin + 1, image.dn.height) - y0) / k;
  patch.origin_px = Vec2d(x0, y0) + Vec2d::Constant(0.5 * (k - 1));
  patch.dn = FloatPlane(width, rows);
  patch.white_dn = static_cast<float>((1 << image.bits) - 1);
  Plane<uint8_t> foreign(width, rows, 0);
  Polygon outline;
  for (const Vec2d& p : pattern.outline) outline.push_back((p - patch.origin_px) / k);
  patch.inside = CentresInside(outline, width, rows);
  const Plane<uint8_t> own = Grown(patch.inside, kOwn_px);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < width; ++x) {
      patch.dn(x, y) = MeanOfBlock(image.dn, x0 + k * x, y0 + k * y, k);
      const Vec2d px = patch.origin_px + k * Vec2d(x, y);
      const float at = height(static_cast<int>(px.x()), static_cast<int>(px.y()));
      foreign(x, y) = own(x, y) == 0 && static_cast<double>(at) > pattern.level.At(px);
    }
  }
  foreign = Grown(foreign, kNeighbour_px);
  patch.used = Grown(patch.inside, options.margin_px);
  int around = 0;
  int left_out = 0;
  for (size_t i = 0; i < patch.used.data.size(); ++i) {
    around += patch.used.data[i] != 0 && patch.inside.data[i] == 0;
    if (foreign.data[i] != 0 && own.data[i] == 0) {
      left_out += patch.used.data[i];
      patch.used.data[i] = 0;
    }
    patch.count += patch.used.data[i];
  }
  patch.noise = NoiseOf(patch, pattern);
  patch.free_share = 1.0 - left_out / std::max<double>(around, 1.0);
  return patch;
}

}  // namespace retrolux
