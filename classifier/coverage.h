// How much of each pixel a marker covers, blurred, and how that changes with the marker's place.
#pragma once

#include <vector>

#include "classifier/contour.h"
#include "classifier/outline_map.h"

namespace retrolux {

// The share of each pixel's box inside an outline, exact for its straight pieces, after a blur of
// given variance (px^2; the discrete Gaussian exp(-v) I_n(v) along rows and columns: Lindeberg,
// IEEE PAMI 12(3), 1990), with its derivatives by the place of the outline.
class Coverage {
 public:
  // Channel 0: coverage; 1, 2: its derivatives by a shift of the outline along x and y; 3: length
  // of the outline that is seen here; 4, 5: the same times the place on it, as seen; two fill up.
  static constexpr int kChannels = 8;
  static constexpr double kMaxVariance_px2 = 6.0;

  // Of `outline` (as seen) mapped by `map`. False, and nothing made, if it does not lie wholly in
  // the box. Reuses its memory.
  bool Render(const Polygon& outline, const OutlineMap& map, int width, int height,
              double variance_px2);

  const float* At(int x, int y) const { return &data_[Index(x, y)]; }
  // d coverage / d variance: half the second differences, by the heat equation that the discrete
  // Gaussian solves.
  float ByVariance(int x, int y) const;
  // The place on the outline, as seen, whose edge shows here. A change of the map moves it, and
  // the edge with it. Only where `At(x, y)[3]` is not 0.
  Vec2d PlaceAt(int x, int y) const {
    const float* c = At(x, y);
    return Vec2d(static_cast<double>(c[4]), static_cast<double>(c[5])) / static_cast<double>(c[3]);
  }

 private:
  size_t Index(int x, int y) const {
    return (static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)) *
           kChannels;
  }
  float* Cell(int x, int y) { return &data_[Index(x, y)]; }
  void AddPiece(const Vec2d& a, const Vec2d& b, const Vec2d& seen_a, const Vec2d& seen_b,
                double sense);
  void SumRows();
  void Blur(const PixelBox& covered, double variance_px2);

  int width_ = 0;
  int height_ = 0;
  std::vector<float> data_, other_;
};

}  // namespace retrolux
