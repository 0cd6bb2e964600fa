#include "core/truncated_cone.h"

#include <cmath>
#include <limits>

namespace retrolux {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A part of a line; empty if begin > end.
struct Interval {
  double begin = -kInfinity;
  double end = kInfinity;

  bool Empty() const { return begin > end; }
};

constexpr Interval kNowhere = {kInfinity, -kInfinity};

Interval Intersection(const Interval& a, const Interval& b) {
  return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

// Where 0 <= height + s step <= length.
Interval BetweenCaps(double height, double step, double length) {
  if (step == 0.0) return height >= 0.0 && height <= length ? Interval{} : kNowhere;
  const double base = -height / step;
  const double top = (length - height) / step;
  return {std::min(base, top), std::max(base, top)};
}

// Where the line is inside the nappe of the cone that the solid is a piece of.
Interval InsideNappe(const truncated_cone::LineToSurface& line) {
  const double a = line.Quadratic();
  const double b = line.HalfLinear();
  const double c = line.At(0.0);
  const double discriminant = b * b - a * c;
  if (a > 0.0 && discriminant < 0.0) return kNowhere;
  // Where a < 0 the exact discriminant is not negative. Of the two roots, neither subtracts nearly
  // equal numbers: a may be as near to zero as it likes.
  const double q = -(b + std::copysign(std::sqrt(std::max(0.0, discriminant)), b));
  if (q == 0.0) {  // b = 0 and a c = 0: a double root at 0, or a constant
    if (a > 0.0) return {0.0, 0.0};
    if (a == 0.0) return c <= 0.0 ? Interval{} : kNowhere;
    return line.radius_step > 0.0 ? Interval{0.0, kInfinity} : Interval{-kInfinity, 0.0};
  }
  const double near_root = c / q;
  if (a == 0.0) {  // 2 b s + c <= 0
    return b > 0.0 ? Interval{-kInfinity, near_root} : Interval{near_root, kInfinity};
  }
  const double far_root = q / a;
  const double first = std::min(near_root, far_root), last = std::max(near_root, far_root);
  if (a > 0.0) return {first, last};
  // Steeper than the surface: inside both nappes, one on either side; ours is where the radius
  // grows to.
  return line.radius_step > 0.0 ? Interval{last, kInfinity} : Interval{-kInfinity, first};
}

}  // namespace

std::optional<double> FirstHit(const TruncatedCone& cone, const Ray& ray) {
  // Distances along the ray count from beside the solid's middle, so that the numbers are of its
  // size however far away the ray starts.
  const Vec3d middle = cone.base + 0.5 * cone.length_mm * cone.axis;
  const double shift = (middle - ray.origin).dot(ray.direction);
  const Vec3d base_to_start = ray.origin + shift * ray.direction - cone.base;
  const double height = base_to_start.dot(cone.axis);
  const double step = ray.direction.dot(cone.axis);
  const truncated_cone::LineToSurface line(cone, base_to_start, ray.direction, height, step);
  const Interval inside =
      Intersection(BetweenCaps(height, step, cone.length_mm), InsideNappe(line));
  if (inside.Empty()) return std::nullopt;
  if (shift + inside.begin >= 0.0) return shift + inside.begin;
  if (shift + inside.end >= 0.0) return shift + inside.end;
  return std::nullopt;
}

}  // namespace retrolux
