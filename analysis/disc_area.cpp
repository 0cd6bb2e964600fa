#include "analysis/disc_area.h"

#include <algorithm>
#include <cmath>

namespace retrolux {

double DiscVisibleArea(const Disc& disc, const Vec3d& camera) {
  const bool front = (camera - disc.centre).dot(disc.normal) > 0.0;
  return front ? kPi * disc.radius * disc.radius : 0.0;
}

double DiscVisibleArea(const Disc& disc, const HalfPlane& sheet, const Vec3d& camera) {
  // The plane through camera and edge cuts the disc along a chord; what lies on the sheet's side of
  // it is hidden.
  Vec3d to_sheet = (sheet.edge_point - camera).cross(sheet.edge_direction);
  if (to_sheet.dot(sheet.inward) < 0.0) to_sheet = -to_sheet;
  const double height = to_sheet.dot(disc.centre - camera);
  const double slope = to_sheet.cross(disc.normal).norm();  // of `to_sheet` along the disc
  // How far the disc's centre lies beyond the chord, in radii; nothing is cut where it is over 1. A
  // plane parallel to the disc has slope 0 and hides all or nothing.
  const double x = std::clamp(height / (slope * disc.radius), -1.0, 1.0);
  const double share = (std::acos(x) - x * std::sqrt(1.0 - x * x)) / kPi;  // circular segment
  return share * DiscVisibleArea(disc, camera);
}

}  // namespace retrolux
