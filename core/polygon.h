// Simple polygons in the plane: area, centroid, inside test.
#pragma once

#include <vector>

#include "core/conventions.h"

namespace retrolux {

using Polygon = std::vector<Vec2d>;

// Positive if the corners run counter-clockwise (x right, y up).
double SignedArea(const Polygon& polygon);

// Centre of mass of the enclosed area. The area must not be zero.
Vec2d Centroid(const Polygon& polygon);

// Even-odd rule.
bool Contains(const Polygon& polygon, const Vec2d& point);

// Corners of the convex hull, counter-clockwise (x right, y up).
Polygon ConvexHull(Polygon points);

}  // namespace retrolux
