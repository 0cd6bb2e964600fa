// What an identification method says about a picture.
#pragma once

#include <optional>
#include <vector>

#include "core/conventions.h"

namespace retrolux {

// One pattern, bright or (`robust`) dark, in the picture's pixels: (0, 0) is the centre of the
// top-left pixel, y down.
struct Detection {
  std::optional<int> marker;  // number in the set; nothing: a pattern that matches no marker
  // Corners in order along the contour, counter-clockwise for who looks at the picture. Of a named
  // marker corner i is corner i of its outline (a triangle looks the same from any of its corners).
  // Empty for round patterns and for those whose edges could not be counted.
  std::vector<Vec2d> corners_px;
  // Of the area inside the contour (`edges`), or of the marker's light (`robust`).
  Vec2d centroid_px = Vec2d::Zero();
  // Where the middle of the shape's area falls, a fixed point of the marker: unlike centroids it
  // does not move with falling light, perspective or a curved surface. What cameras triangulate.
  // Nothing where the method does not know (`edges`, and patterns that fit no marker).
  std::optional<Vec2d> centre_px;
  double confidence = 0.0;  // 0..1; 0 without a name. The method says what it means.
  int straight_edges = 0;   // 0: round, or not to be counted
  double area_px = 0.0;     // inside the contour, px2
};

}  // namespace retrolux
