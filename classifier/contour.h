// Closed lines of equal height in a picture, between the pixels.
#pragma once

#include <vector>

#include "core/plane.h"
#include "core/polygon.h"

namespace retrolux {

// Pixels x0 .. x1 - 1, y0 .. y1 - 1.
struct PixelBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

// A height in DN that may rise or fall over the picture.
struct LevelPlane {
  Vec2d origin_px = Vec2d::Zero();
  double value = 0.0;           // DN at the origin
  Vec2d slope = Vec2d::Zero();  // DN/px

  double At(const Vec2d& px) const { return value + slope.dot(px - origin_px); }
};

// The closed contours where `plane` crosses `level`, inside the box. Brighter is to the left of the
// way: contours around bright patterns run counter-clockwise for who looks at the picture (positive
// ScreenArea), those around dark holes clockwise. Contours that leave the box are not closed and
// not given.
std::vector<Polygon> TraceContours(const FloatPlane& plane, const PixelBox& box,
                                   const LevelPlane& level);
// The same in the whole of `relief` at the level 0, looked for where `steep` is not 0.
std::vector<Polygon> TraceSteepContours(const FloatPlane& relief, const Plane<int>& steep);

// Area in px2, positive if the points (y down) run counter-clockwise for who looks at the picture.
inline double ScreenArea(const Polygon& contour) {
  return -SignedArea(contour);
}

// `count` points at equal steps along the closed contour, the first at its first point.
Polygon Resample(const Polygon& contour, int count);

double Perimeter(const Polygon& contour);

}  // namespace retrolux
