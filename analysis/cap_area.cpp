#include "analysis/cap_area.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/error.h"

namespace retrolux {

namespace {

constexpr double kSliver = 1e-9;  // rad

double AngleBetween(const Vec3d& a, const Vec3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// The angle of a spherical triangle opposite the side `a`. The sides must make a triangle.
double TriangleAngle(double a, double b, double c) {
  const double s = 0.5 * (a + b + c);
  return 2.0 * std::atan2(std::sqrt(std::max(0.0, std::sin(s - b) * std::sin(s - c))),
                          std::sqrt(std::max(0.0, std::sin(s) * std::sin(s - a))));
}

// The two points that the edges of two caps share.
std::optional<std::pair<Vec3d, Vec3d>> Crossings(const Cap& a, const Cap& b) {
  const Vec3d normal = a.axis.cross(b.axis);
  const double sin2 = normal.squaredNorm();
  if (sin2 == 0.0) return std::nullopt;
  const double cos_psi = a.axis.dot(b.axis);
  const double cos_a = std::cos(a.half_angle), cos_b = std::cos(b.half_angle);
  // q = u a + v b +- w normal with q.a = cos_a, q.b = cos_b, |q| = 1
  const double u = (cos_a - cos_psi * cos_b) / sin2, v = (cos_b - cos_psi * cos_a) / sin2;
  const Vec3d foot = u * a.axis + v * b.axis;
  const double w2 = (1.0 - foot.squaredNorm()) / sin2;
  if (w2 < 0.0) return std::nullopt;
  const Vec3d rise = std::sqrt(w2) * normal;
  return std::pair{Vec3d((foot + rise).normalized()), Vec3d((foot - rise).normalized())};
}

std::vector<Vec3d> AllCrossings(std::span<const Cap> caps) {
  std::vector<Vec3d> points;
  for (size_t i = 0; i < caps.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      if (const auto pair = Crossings(caps[i], caps[j])) {
        points.push_back(pair->first);
        points.push_back(pair->second);
      }
    }
  }
  return points;
}

// Whether the point lies in all caps, at least `depth` (rad) from every edge.
bool InAll(std::span<const Cap> caps, const Vec3d& point, double depth) {
  return std::all_of(caps.begin(), caps.end(), [&](const Cap& cap) {
    return AngleBetween(cap.axis, point) + depth <= cap.half_angle;
  });
}

// The middle of the corners of what the caps share, if it has any: it lies in it or on its edge,
// because that is convex. Without corners they share the smallest cap, or nothing: its middle. Of
// the crossings, one that is no corner by a rounding may count, but none that is one may be missed.
Vec3d MiddleOfCorners(std::span<const Cap> caps, const std::vector<Vec3d>& crossings) {
  Vec3d sum = Vec3d::Zero();
  for (const Vec3d& point : crossings) {
    if (InAll(caps, point, -kSliver)) sum += point;
  }
  const Cap& smallest = *std::min_element(caps.begin(), caps.end(), [](const Cap& a, const Cap& b) {
    return a.half_angle < b.half_angle;
  });
  return sum.isZero(0.0) ? smallest.axis : Vec3d(sum.normalized());
}

void SetPole(CapFan& fan, const Vec3d& pole) {
  fan.pole = pole;
  fan.x = pole.unitOrthogonal();
  fan.y = pole.cross(fan.x);
}

// Which cap's edge one meets first from the pole.
size_t Nearest(const CapFan& fan, std::span<const Cap> caps, double azimuth) {
  size_t nearest = 0;
  for (size_t c = 1; c < caps.size(); ++c) {
    if (fan.Reach(caps[c], azimuth) < fan.Reach(caps[nearest], azimuth)) nearest = c;
  }
  return nearest;
}

// Moves the pole to the middle of edge points all around it. Corners that lie close together at one
// side leave it at the edge, where azimuths mean nothing.
void Recentre(CapFan& fan, std::span<const Cap> caps) {
  constexpr int kPoints = 12;
  Vec3d sum = Vec3d::Zero();
  for (int i = 0; i < kPoints; ++i) {
    const double azimuth = 2.0 * kPi * i / kPoints;
    sum += fan.Edge(caps[Nearest(fan, caps, azimuth)], azimuth);
  }
  SetPole(fan, sum.normalized());
}

double PositiveAzimuth(double y, double x) {
  const double azimuth = std::atan2(y, x);
  return azimuth < 0.0 ? azimuth + 2.0 * kPi : azimuth;
}

// The angle from one direction to another around `axis`, counter-clockwise, in (-pi, pi].
double AngleAround(const Vec3d& axis, const Vec3d& from, const Vec3d& to) {
  const Vec3d a = from - axis.dot(from) * axis, b = to - axis.dot(to) * axis;
  return std::atan2(axis.dot(a.cross(b)), a.dot(b));
}

// Gauss-Bonnet for a sector between two great circles through the pole and an arc of a cap's edge:
// on the unit sphere, area = 2 pi - (integral of the edge's curvature) - (outer angles). The edge
// of half-angle a has the curvature cot(a) and the length turn sin(a); the outer angles are pi -
// (end - begin) at the pole and pi / 2 -+ the angle between axis and pole at the arc's ends.
double SectorArea(const CapFan& fan, const Cap& cap, const CapFan::Sector& sector) {
  const Vec3d first = fan.Edge(cap, sector.begin), last = fan.Edge(cap, sector.end);
  double turn = AngleAround(cap.axis, first, last);
  if (turn < -1e-6) turn += 2.0 * kPi;  // a little less than nothing is rounding, not a whole turn
  return sector.end - sector.begin + AngleAround(first, cap.axis, fan.pole) -
         AngleAround(last, cap.axis, fan.pole) - turn * std::cos(cap.half_angle);
}

}  // namespace

Cap VisibleCap(const Vec3d& centre, double radius, const Vec3d& camera) {
  const Vec3d to_camera = camera - centre;
  const double distance = to_camera.norm();
  RETROLUX_CHECK(radius < distance, "radius {} mm, distance {} mm", radius, distance);
  return {to_camera / distance, std::acos(radius / distance)};
}

double CapArea(double radius, double half_angle) {
  const double s = std::sin(0.5 * half_angle);  // 1 - cos(a) = 2 sin^2(a / 2)
  return 4.0 * kPi * radius * radius * s * s;
}

double TwoCapArea(double radius, double half_angle_1, double half_angle_2, double psi) {
  const double a1 = half_angle_1, a2 = half_angle_2;
  if (psi >= a1 + a2) return 0.0;
  if (psi <= std::abs(a1 - a2)) return CapArea(radius, std::min(a1, a2));
  if (psi >= 2.0 * kPi - a1 - a2) {  // what the two leave out does not overlap
    return CapArea(radius, a1) + CapArea(radius, a2) - CapArea(radius, kPi);
  }
  // Gauss-Bonnet: two arcs, each of twice the angle of the triangle (axis, axis, corner) at its
  // axis, and two corners whose outer angle is the triangle's angle there.
  return 2.0 * radius * radius *
         (kPi - TriangleAngle(psi, a1, a2) - TriangleAngle(a2, a1, psi) * std::cos(a1) -
          TriangleAngle(a1, a2, psi) * std::cos(a2));
}

double CapIntersectionArea(double radius, std::span<const Cap> caps) {
  if (caps.empty()) return CapArea(radius, kPi);
  const CapFan fan(caps);
  double area = 0.0;
  for (const CapFan::Sector& sector : fan.sectors) {
    area += SectorArea(fan, caps[sector.cap], sector);
  }
  return radius * radius * std::max(0.0, area);
}

double FarPairArea(double radius, double psi) {
  return (2.0 * kPi - 2.0 * psi) * radius * radius;
}

CapFan::CapFan(std::span<const Cap> caps) {
  RETROLUX_CHECK(!caps.empty(), "no caps");
  for (const Cap& cap : caps) {
    RETROLUX_CHECK(cap.half_angle < 0.5 * kPi, "half-angle {} rad", cap.half_angle);
  }
  const std::vector<Vec3d> crossings = AllCrossings(caps);
  SetPole(*this, MiddleOfCorners(caps, crossings));
  if (!InAll(caps, pole, -kSliver)) return;
  for (int i = 0; i < 2; ++i) Recentre(*this, caps);
  if (!InAll(caps, pole, kSliver)) return;

  // Between the crossings of any two edges one and the same cap is the nearest. Where two are
  // equally near it does not matter which is taken, so rounding cannot harm.
  std::vector<double> breaks = {0.0, kPi, 2.0 * kPi};
  for (const Vec3d& point : crossings) {
    breaks.push_back(PositiveAzimuth(point.dot(y), point.dot(x)));
  }
  std::sort(breaks.begin(), breaks.end());
  for (size_t i = 0; i + 1 < breaks.size(); ++i) {
    if (breaks[i] == breaks[i + 1]) continue;
    const size_t nearest = Nearest(*this, caps, 0.5 * (breaks[i] + breaks[i + 1]));
    sectors.push_back({breaks[i], breaks[i + 1], nearest});
  }
}

double CapFan::Reach(const Cap& cap, double azimuth) const {
  // cos(a) = axis . (cos(reach) pole + sin(reach) direction) = size cos(reach - top)
  const double along_pole = cap.axis.dot(pole), along_direction = cap.axis.dot(Direction(azimuth));
  const double size = std::hypot(along_pole, along_direction);
  return std::atan2(along_direction, along_pole) +
         std::acos(std::min(1.0, std::cos(cap.half_angle) / size));
}

Vec3d CapFan::Edge(const Cap& cap, double azimuth) const {
  const double reach = Reach(cap, azimuth);
  return std::cos(reach) * pole + std::sin(reach) * Direction(azimuth);
}

}  // namespace retrolux
