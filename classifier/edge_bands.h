// Bands of pixels where the picture is steep: each bright pattern has one along its outline.
#pragma once

#include <vector>

#include "classifier/contour.h"
#include "classifier/gradient.h"

namespace retrolux {

struct EdgeBand {
  int label = 0;  // of its pixels in EdgeBands::labels
  PixelBox box;
  // Height around which the picture is steepest, so about half way up the edges.
  LevelPlane level;
};

struct EdgeBands {
  std::vector<EdgeBand> bands;  // by their first pixel, row by row
  Plane<int> labels;            // of each pixel; 0: not steep
};

// Connected pixels (8 neighbours) whose slope is at least `min_slope_sigma` standard deviations of
// its noise. Reuses the memory of `found`, as MeasureGradient does.
void FindEdgeBands(const GradientField& field, double min_slope_sigma, EdgeBands& found);

// The plane z = value + slope (px - origin) that fits the samples best in the weighted least
// squares sense; constant if they do not fix a slope.
class LevelFit {
 public:
  explicit LevelFit(const Vec2d& origin_px) : origin_px_(origin_px) {}
  void Add(const Vec2d& px, double value, double weight);
  LevelPlane Solve() const;

 private:
  Vec2d origin_px_;
  Mat3d normal_ = Mat3d::Zero();
  Vec3d right_ = Vec3d::Zero();
};

}  // namespace retrolux
