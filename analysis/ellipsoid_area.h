// The area of an ellipsoid that cameras outside it see, for surfaces of nothing but the ellipsoid.
#pragma once

#include <span>

#include "core/conventions.h"

namespace retrolux {

// mm^2 of the ellipsoid around the origin, semi-axes (mm) along x, y, z, that lie on every camera's
// side of the camera's polar plane (x . M . c > 1 with M = diag(semi_axes)^-2, c the camera in mm).
// A camera in the ellipsoid sees nothing. Relative error below 1e-9 where the semi-axes differ by
// less than ten times and what is seen is not a sliver.
double EllipsoidVisibleArea(const Vec3d& semi_axes_mm, std::span<const Vec3d> cameras);

inline double EllipsoidVisibleArea(const Vec3d& semi_axes_mm, const Vec3d& camera) {
  return EllipsoidVisibleArea(semi_axes_mm, std::span(&camera, 1));
}

}  // namespace retrolux
