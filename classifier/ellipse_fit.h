// Round patterns: the ellipse that a disc shows.
#pragma once

#include "core/polygon.h"

namespace retrolux {

struct EllipseFit {
  double long_px = 0.0;  // semi-axes
  double short_px = 0.0;
  double rms_px = 0.0;  // distance of the outline's points from the ellipse
};

// The ellipse with the area moments (up to the second) of the region inside the outline.
EllipseFit FitEllipse(const Polygon& outline);

}  // namespace retrolux
