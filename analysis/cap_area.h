// Areas of spherical caps and of what caps have in common, in closed form. A camera at distance d
// from the centre of a sphere of radius r sees the cap around its direction of half-angle acos(r /
// d). Radii in mm, areas in mm^2, angles in radians.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "core/conventions.h"

namespace retrolux {

struct Cap {
  Vec3d axis;         // unit, from the sphere's centre to the cap's middle
  double half_angle;  // 0 to pi
};

// The part of a sphere (centre, radius) that faces a camera outside it.
Cap VisibleCap(const Vec3d& centre, double radius, const Vec3d& camera);

double CapArea(double radius, double half_angle);

// What two caps of any half-angles (0 to pi) share, their axes `psi` apart (0 to pi).
double TwoCapArea(double radius, double half_angle_1, double half_angle_2, double psi);

// What all of `caps` share. Half-angles less than pi / 2: the common part is then convex, in one
// piece, with one boundary. Any number of caps may be redundant, equal, or touch. A part thinner
// than 2e-9 rad counts as none. No cap: the whole sphere.
double CapIntersectionArea(double radius, std::span<const Cap> caps);

// Two hemispheres: what two cameras at infinity share (thesis eq. 4.17, offset 2 pi, gradient -2).
double FarPairArea(double radius, double psi);

// What caps have in common (half-angles as above), as sectors around a pole inside it: the sector
// from azimuth `begin` to `end` reaches from the pole to the edge of the cap `cap`. The direction
// of azimuth phi at the pole is cos(phi) x + sin(phi) y, (x, y, pole) right-handed. No sectors: the
// caps share nothing.
struct CapFan {
  struct Sector {
    double begin, end;
    size_t cap;
  };
  Vec3d pole = Vec3d::Zero(), x = Vec3d::Zero(), y = Vec3d::Zero();
  std::vector<Sector> sectors;

  explicit CapFan(std::span<const Cap> caps);  // at least one

  Vec3d Direction(double azimuth) const { return std::cos(azimuth) * x + std::sin(azimuth) * y; }
  // The angle from the pole to the edge of a cap that contains it.
  double Reach(const Cap& cap, double azimuth) const;
  Vec3d Edge(const Cap& cap, double azimuth) const;
};

}  // namespace retrolux
