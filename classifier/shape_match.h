// Whether counted corners lie as those of a marker do, whatever its place, size, roll and tilt.
#pragma once

#include "core/marker_set.h"

namespace retrolux {

struct ShapeMatch {
  size_t first = 0;             // index of the given corner that is corner 0 of the outline
  double rms_px = 0.0;          // distance of the corners from the mapped outline
  double size_px = 0.0;         // side of the marker's square in the picture, not foreshortened
  double foreshortening = 0.0;  // cosine of the angle of view; 1 frontal
};

// The affine map from the marker onto the corners that fits best, over all assignments that keep
// the order. It stands for the perspective view of a small flat marker (size over distance below
// 1/25). `corners_px` as many as the outline has, counter-clockwise for who looks at the picture;
// mirrored shapes therefore never match better than by chance.
ShapeMatch MatchShape(const Polygon& corners_px, const MarkerShape& shape, double size_mm);

}  // namespace retrolux
