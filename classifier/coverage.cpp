#include "classifier/coverage.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace retrolux {

namespace {

// The discrete Gaussian: weights[n] = exp(-v) I_n(v) for n = 0, 1, ..., cut where less than 1e-4 is
// left, and scaled to the sum 1.
std::vector<float> BlurWeights(double variance) {
  constexpr double kLeft = 1e-4;
  std::vector<float> weights;
  double sum = 0.0;
  double first = 1.0;  // (v / 2)^n / n!
  for (int n = 0; n < 16 && sum < 1.0 - kLeft; ++n) {
    if (n > 0) first *= 0.5 * variance / n;
    double term = first;
    double bessel = term;
    for (int k = 1; k < 24; ++k) {
      term *= 0.25 * variance * variance / (k * (n + k));
      bessel += term;
    }
    const double weight = std::exp(-variance) * bessel;
    weights.push_back(static_cast<float>(weight));
    sum += n == 0 ? weight : 2.0 * weight;
  }
  for (float& w : weights) w /= static_cast<float>(sum);
  return weights;
}

void AddWeighted(const float* from, float weight, size_t count, float* to) {
  for (size_t i = 0; i < count; ++i) to[i] += weight * from[i];
}

}  // namespace

bool Coverage::Render(const Polygon& outline, const OutlineMap& map, int width, int height,
                      double variance_px2) {
  const Polygon points = map.Of(outline);
  PixelBox covered{width, height, 0, 0};
  for (const Vec2d& p : points) {
    const bool inside = p.x() > -0.5 && p.y() > -0.5 && p.x() < width - 1.5 && p.y() < height - 0.5;
    if (!inside) return false;  // also if it is no number
    const int x = static_cast<int>(std::floor(p.x() + 0.5));
    const int y = static_cast<int>(std::floor(p.y() + 0.5));
    covered = {std::min(covered.x0, x), std::min(covered.y0, y), std::max(covered.x1, x + 2),
               std::max(covered.y1, y + 1)};
  }
  width_ = width;
  height_ = height;
  data_.assign(static_cast<size_t>(width) * static_cast<size_t>(height) * kChannels, 0.0f);
  const double sense = SignedArea(points) > 0.0 ? 1.0 : -1.0;
  const Vec2d half(0.5, 0.5);
  for (size_t i = 0; i < points.size(); ++i) {
    const size_t j = (i + 1) % points.size();
    AddPiece(points[i] + half, points[j] + half, outline[i], outline[j], sense);
  }
  SumRows();
  if (variance_px2 > 0.0) Blur(covered, std::min(variance_px2, kMaxVariance_px2));
  return true;
}

// Cut where it crosses from one pixel into the next. A part that goes down by dy covers dy of all
// pixels to its right, and of its own what lies to its right (the signs as for an outline with
// positive SignedArea are turned by `sense`). Displaced by d it gives its pixel d x (dx, dy).
void Coverage::AddPiece(const Vec2d& a, const Vec2d& b, const Vec2d& seen_a, const Vec2d& seen_b,
                        double sense) {
  const Vec2d step = b - a;
  const double length = step.norm();
  int x = static_cast<int>(std::floor(a.x()));
  int y = static_cast<int>(std::floor(a.y()));
  const int last_x = static_cast<int>(std::floor(b.x()));
  const int last_y = static_cast<int>(std::floor(b.y()));
  const int way_x = step.x() > 0.0 ? 1 : -1;
  const int way_y = step.y() > 0.0 ? 1 : -1;
  int left_x = std::abs(last_x - x);
  int left_y = std::abs(last_y - y);
  double t = 0.0;
  while (true) {
    // The nearer of the next two grid lines.
    const double tx = left_x > 0 ? (x + (way_x > 0 ? 1 : 0) - a.x()) / step.x() : 2.0;
    const double ty = left_y > 0 ? (y + (way_y > 0 ? 1 : 0) - a.y()) / step.y() : 2.0;
    const double next = std::clamp(std::min(tx, ty), t, 1.0);
    const double share = next - t;
    const double middle = 0.5 * (next + t);
    float* cell = Cell(x, y);
    const double dx = sense * share * step.x();
    const double dy = sense * share * step.y();
    const double right = x + 1.0 - (a.x() + middle * step.x());
    cell[0] -= static_cast<float>(dy * right);
    cell[kChannels] -= static_cast<float>(dy * (1.0 - right));
    cell[1] += static_cast<float>(dy);
    cell[2] -= static_cast<float>(dx);
    const Vec2d seen = share * length * (seen_a + middle * (seen_b - seen_a));
    cell[3] += static_cast<float>(share * length);
    cell[4] += static_cast<float>(seen.x());
    cell[5] += static_cast<float>(seen.y());
    t = next;
    if (left_x == 0 && left_y == 0) break;
    if (tx <= ty) {
      x += way_x;
      --left_x;
    } else {
      y += way_y;
      --left_y;
    }
  }
}

void Coverage::SumRows() {
  for (int y = 0; y < height_; ++y) {
    float sum = 0.0f;
    for (int x = 0; x < width_; ++x) {
      float* cell = Cell(x, y);
      sum += cell[0];
      cell[0] = sum;
    }
  }
}

// Along rows, then along columns; only where the covered pixels reach. What a tap of the kernel
// brings to a row is the row itself, shifted: long loops over neighbouring numbers.
void Coverage::Blur(const PixelBox& covered, double variance_px2) {
  const std::vector<float> weights = BlurWeights(variance_px2);
  const int reach = static_cast<int>(weights.size()) - 1;
  const PixelBox wide{std::max(covered.x0 - reach, 0), covered.y0,
                      std::min(covered.x1 + reach, width_), covered.y1};
  const PixelBox all{wide.x0, std::max(covered.y0 - reach, 0), wide.x1,
                     std::min(covered.y1 + reach, height_)};
  const auto weight = [&](int tap) { return weights[static_cast<size_t>(std::abs(tap))]; };
  other_.assign(data_.size(), 0.0f);
  for (int y = wide.y0; y < wide.y1; ++y) {
    for (int tap = -reach; tap <= reach; ++tap) {
      const int x0 = std::max(wide.x0, -tap), x1 = std::min(wide.x1, width_ - tap);
      if (x0 >= x1) continue;
      AddWeighted(&data_[Index(x0 + tap, y)], weight(tap), static_cast<size_t>(x1 - x0) * kChannels,
                  &other_[Index(x0, y)]);
    }
  }
  const auto row = static_cast<size_t>(all.x1 - all.x0) * kChannels;
  for (int y = all.y0; y < all.y1; ++y) {
    std::fill_n(&data_[Index(all.x0, y)], row, 0.0f);
    for (int from = std::max(y - reach, wide.y0); from <= std::min(y + reach, wide.y1 - 1); ++from)
      AddWeighted(&other_[Index(all.x0, from)], weight(from - y), row, &data_[Index(all.x0, y)]);
  }
}

float Coverage::ByVariance(int x, int y) const {
  const float here = 2.0f * At(x, y)[0];
  float sum = 0.0f;
  if (x > 0 && x + 1 < width_) sum += At(x - 1, y)[0] + At(x + 1, y)[0] - here;
  if (y > 0 && y + 1 < height_) sum += At(x, y - 1)[0] + At(x, y + 1)[0] - here;
  return 0.5f * sum;
}

}  // namespace retrolux
