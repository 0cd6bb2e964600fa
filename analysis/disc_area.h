// The area of a flat disc that a pinhole camera sees, also past the straight edge of an opaque
// sheet.
#pragma once

#include "core/conventions.h"

namespace retrolux {

// One-sided: seen from where `normal` points to.
struct Disc {
  Vec3d centre;   // mm
  Vec3d normal;   // unit
  double radius;  // mm
};

// An opaque half-plane: the points edge_point + s edge_direction + t inward, t >= 0.
struct HalfPlane {
  Vec3d edge_point;      // mm
  Vec3d edge_direction;  // not parallel to inward
  Vec3d inward;
};

// mm^2 of the disc that the camera sees: all of it from its front, however oblique, else nothing.
double DiscVisibleArea(const Disc& disc, const Vec3d& camera);

// The same with a half-plane between: the plane that it lies in must have the camera on one side
// and the whole disc on the other.
double DiscVisibleArea(const Disc& disc, const HalfPlane& sheet, const Vec3d& camera);

}  // namespace retrolux
