#include "analysis/dataset_touching.h"

#include <algorithm>
#include <cmath>

#include "scenes/marker_placement.h"

namespace retrolux {

namespace {

constexpr double kStep_mm = 0.1;

Polygon BrightOutline(const MarkerSpec& marker, double turn_rad) {
  const MarkerSet& set = DefaultMarkerSet();
  const double s = 0.5 * set.dark_square_mm;
  Polygon outline = marker.dark ? Polygon{{-s, -s}, {s, -s}, {s, s}, {-s, s}}
                                : set.ByNumber(marker.number).outline_mm;
  const Eigen::Rotation2Dd turn(turn_rad);
  for (Vec2d& corner : outline) corner = turn * corner;
  return outline;
}

double Cross(const Vec2d& a, const Vec2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

bool SegmentsCross(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d) {
  const double s = Cross(b - a, c - a), t = Cross(b - a, d - a);
  const double u = Cross(d - c, a - c), v = Cross(d - c, b - c);
  return s * t <= 0.0 && u * v <= 0.0;
}

bool Overlap(const Polygon& a, const Polygon& b, const Vec2d& shift) {
  for (size_t i = 0; i < a.size(); ++i) {
    for (size_t j = 0; j < b.size(); ++j) {
      if (SegmentsCross(a[i], a[(i + 1) % a.size()], b[j] + shift, b[(j + 1) % b.size()] + shift))
        return true;
    }
  }
  return Contains(a, b.front() + shift) || Contains(b, a.front() - shift);
}

}  // namespace

SurfacePoint TouchingPlace(const TriangleMesh& mesh, const MarkerSpec& there,
                           const MarkerSpec& marker, double angle_rad) {
  const Polygon first = BrightOutline(there, 0.0);
  const Polygon second = BrightOutline(marker, RadFromDeg(marker.roll_deg - there.roll_deg));
  const Vec2d direction(std::cos(angle_rad), std::sin(angle_rad));
  double distance = 2.0 * DefaultMarkerSet().dark_square_mm;
  while (distance > 0.0 && !Overlap(first, second, distance * direction)) distance -= kStep_mm;
  const Vec2d shift = (distance + kStep_mm) * direction;
  const RigidTransform marker_from_mask =
      MarkerFromObject(NearestSurfacePoint(mesh, there.at), there.roll_deg);
  return NearestSurfacePoint(mesh, marker_from_mask.Inverse() * Vec3d(shift.x(), shift.y(), 0.0));
}

}  // namespace retrolux
