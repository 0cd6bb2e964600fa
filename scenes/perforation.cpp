#include "scenes/perforation.h"

#include <cmath>

namespace retrolux {

double Perforation::OpenShare() const {
  const double ratio = diameter_mm / pitch_mm;
  return kPi / (2.0 * std::sqrt(3.0)) * ratio * ratio;
}

HolePattern::HolePattern(const Perforation& perforation)
    : perforation_(perforation),
      axis_(perforation.axis.normalized()),
      across_u_(axis_.unitOrthogonal()),
      across_v_(axis_.cross(across_u_)) {}

bool HolePattern::LetsPass(const Vec3d& x, const Vec3d& direction, const Vec3d& normal) const {
  const double radius = 0.5 * perforation_.diameter_mm;
  const Vec2d outer = OnFlatSheet(x);
  const Vec2d hole = NearestHole(outer);
  if ((outer - hole).norm() > radius) return false;
  if (perforation_.thickness_mm <= 0.0) return true;
  // The inner side lies along -normal, whichever way the line is followed.
  const double along = direction.dot(normal);
  if (along == 0.0) return false;
  const Vec2d inner = OnFlatSheet(x - perforation_.thickness_mm / along * direction);
  return (inner - hole).norm() <= radius;
}

// The azimuthal equidistant map about the axis.
Vec2d HolePattern::OnFlatSheet(const Vec3d& x) const {
  const Vec3d from_centre = x - perforation_.centre;
  const Vec2d across(across_u_.dot(from_centre), across_v_.dot(from_centre));
  const double sine = across.norm();  // times the distance from the centre
  if (sine <= 0.0) return Vec2d::Zero();
  const double theta = std::atan2(sine, axis_.dot(from_centre));
  return across * (from_centre.norm() * theta / sine);
}

// A hexagonal lattice is two rectangular ones of p by sqrt(3) p, the second half a cell further.
Vec2d HolePattern::NearestHole(const Vec2d& on_sheet) const {
  const Vec2d cell = perforation_.pitch_mm * Vec2d(1.0, std::sqrt(3.0));
  const auto nearest_of = [&](const Vec2d& first) -> Vec2d {
    const Vec2d cells = (on_sheet - first).cwiseQuotient(cell);
    return first + Vec2d(std::round(cells.x()), std::round(cells.y())).cwiseProduct(cell);
  };
  const Vec2d a = nearest_of(Vec2d::Zero()), b = nearest_of(0.5 * cell);
  return (on_sheet - a).squaredNorm() < (on_sheet - b).squaredNorm() ? a : b;
}

}  // namespace retrolux
