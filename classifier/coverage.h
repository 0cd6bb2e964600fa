// How much of each pixel a marker covers, blurred, and how that changes with the marker's place.
#pragma once

#include <vector>

#include "classifier/contour.h"
#include "classifier/outline_map.h"

namespace retrolux {

// The share of each pixel's box inside an outline, exact for its straight pieces, after a blur of
// given variance (px^2; the discrete Gaussian exp(-v) I_n(v) along rows and columns: Lindeberg,
// IEEE PAMI 12(3), 1990), with its derivatives by the coefficients of the map.
class Coverage {
 public:
  static constexpr int kDerivatives = 2 * OutlineMap::kTerms;
  // Channel 0: coverage; 1 .. 12: derivatives by the coefficients of x, then of y; the rest unused.
  static constexpr int kChannels = 16;
  static constexpr double kMaxVariance_px2 = 6.0;

  // Of `outline` (as seen) mapped by `map`. False, and nothing made, if it does not lie wholly in
  // the box. Reuses its memory.
  bool Render(const Polygon& outline, const OutlineMap& map, int width, int height,
              double variance_px2);

  const float* At(int x, int y) const { return &data_[Index(x, y)]; }
  // d coverage / d variance: half the second differences, by the heat equation that the discrete
  // Gaussian solves.
  float ByVariance(int x, int y) const;

 private:
  using Terms = OutlineMap::Terms;

  size_t Index(int x, int y) const {
    return (static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)) *
           kChannels;
  }
  float* Cell(int x, int y) { return &data_[Index(x, y)]; }
  void AddPiece(const Vec2d& a, const Vec2d& b, const Terms& terms_a, const Terms& terms_b,
                double sense);
  void SumRows();
  void Blur(const PixelBox& covered, double variance_px2);

  int width_ = 0;
  int height_ = 0;
  std::vector<float> data_, other_;
};

}  // namespace retrolux
