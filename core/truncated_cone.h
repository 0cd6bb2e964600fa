// The solid between two parallel discs on one axis: a cylinder if they are equal, else a cone
// without its tip (thesis section 2.3.1, whose eq. 2.33 prints (z_E + z_D)^2 for (z_E + t z_D)^2).
#pragma once

#include <algorithm>
#include <optional>

#include "core/camera_model.h"
#include "core/conventions.h"

namespace retrolux {

// Closed and solid, both end caps included. length_mm > 0; radii >= 0, at most one of them zero (a
// whole cone).
struct TruncatedCone {
  Vec3d base;  // centre of the base cap
  Vec3d axis;  // unit, from the base cap to the top cap
  double length_mm;
  double base_radius_mm;
  double top_radius_mm;
};

// The distance (mm, >= 0) to where the ray first crosses the surface, from outside or inside: a ray
// that starts in the solid hits where it leaves. Nothing if it misses, or has the solid behind it.
std::optional<double> FirstHit(const TruncatedCone& cone, const Ray& ray);

namespace truncated_cone {

// How points of the line a + s d lie to the (infinite) cone's surface: the vector from the axis to
// the point and the cone's radius beside it, both linear in s.
struct LineToSurface {
  Vec3d from_axis, from_axis_step;
  double radius, radius_step;

  LineToSurface(const TruncatedCone& cone, const Vec3d& base_to_a, const Vec3d& d, double height,
                double height_step) {
    const double slope = (cone.top_radius_mm - cone.base_radius_mm) / cone.length_mm;
    from_axis = base_to_a - height * cone.axis;
    from_axis_step = d - height_step * cone.axis;
    radius = cone.base_radius_mm + slope * height;
    radius_step = slope * height_step;
  }

  // distance to the axis^2 - radius^2 = Quadratic() s^2 + 2 HalfLinear() s + At(0). Between the
  // caps the radius is not negative, so there a point is inside if and only if At(s) <= 0.
  double At(double s) const {
    const double r = radius + s * radius_step;
    return (from_axis + s * from_axis_step).squaredNorm() - r * r;
  }
  double Quadratic() const { return from_axis_step.squaredNorm() - radius_step * radius_step; }
  double HalfLinear() const { return from_axis.dot(from_axis_step) - radius * radius_step; }
};

}  // namespace truncated_cone

// Whether any point of the closed segment from a to b lies in the solid. No root is taken: between
// the caps the least At(s) lies at its vertex, or at an end where it is not convex.
inline bool SegmentHits(const TruncatedCone& cone, const Vec3d& a, const Vec3d& b) {
  const Vec3d base_to_a = a - cone.base;
  const Vec3d d = b - a;
  const double height_a = base_to_a.dot(cone.axis);
  const double height_step = d.dot(cone.axis);
  const double height_b = height_a + height_step;
  if (std::max(height_a, height_b) < 0.0 || std::min(height_a, height_b) > cone.length_mm) {
    return false;
  }
  // An end beyond a cap plane has the other end on this side of it: height_step is not 0.
  double begin = 0.0, end = 1.0;
  if (height_a < 0.0) begin = -height_a / height_step;
  if (height_a > cone.length_mm) begin = (cone.length_mm - height_a) / height_step;
  if (height_b < 0.0) end = -height_a / height_step;
  if (height_b > cone.length_mm) end = (cone.length_mm - height_a) / height_step;

  const truncated_cone::LineToSurface line(cone, base_to_a, d, height_a, height_step);
  const double quadratic = line.Quadratic();
  if (quadratic > 0.0) {
    return line.At(std::clamp(-line.HalfLinear() / quadratic, begin, end)) <= 0.0;
  }
  return line.At(begin) <= 0.0 || line.At(end) <= 0.0;
}

}  // namespace retrolux
