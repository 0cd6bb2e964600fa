// The face mask: half an ellipsoid, displaced by smooth bumps in proportions of an adult's head
// (breadth about 150 mm, nose 20 to 25 mm high) under a mask that reaches from the top of the
// forehead to below the chin. The numbers are ours; docs/masks.md lists them. Lengths in this file
// are those before the whole is scaled to its area (by about 1.05).
#include <cmath>

#include "core/error.h"
#include "scenes/grid_mesh.h"
#include "scenes/masks.h"

namespace retrolux {

namespace {

// The half-ellipsoid x >= 0: depth, half width, half height.
const Vec3d kSemiAxes(100.0, 80.0, 115.0);

// height * exp(-((y - centre_y) / width_y)^2 - ((z - centre_z) / width_z)^2), added to x. With
// centre_y > 0 a second one mirrors it.
struct Bump {
  const char* name;
  double centre_y, centre_z, width_y, width_z, height;
};
constexpr Bump kBumps[] = {
    {"forehead", 0.0, 68.0, 52.0, 34.0, 13.0},     {"brow", 20.0, 30.0, 24.0, 10.0, 5.0},
    {"eye socket", 30.0, 11.0, 15.0, 12.0, -12.0}, {"eyeball", 30.0, 11.0, 11.0, 9.0, 4.0},
    {"cheek bone", 43.0, -8.0, 18.0, 16.0, 6.0},   {"wing of the nose", 11.0, -25.0, 8.0, 8.0, 6.0},
    {"jaws", 0.0, -50.0, 27.0, 22.0, 8.0},         {"upper lip", 0.0, -44.0, 20.0, 7.0, 3.0},
    {"lower lip", 0.0, -57.0, 18.0, 7.0, 3.0},     {"chin", 0.0, -80.0, 24.0, 13.0, 22.0},
};

double Gauss(double x, double width) {
  return std::exp(-(x / width) * (x / width));
}

// 0 to 1 over [from, to], with continuous second derivative.
double SmoothStep(double x, double from, double to) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * t * (10.0 + t * (6.0 * t - 15.0));
}

double BumpHeight(const Bump& bump, double y, double z) {
  const double across = bump.centre_y > 0.0 ? Gauss(y - bump.centre_y, bump.width_y) +
                                                  Gauss(y + bump.centre_y, bump.width_y)
                                            : Gauss(y, bump.width_y);
  return bump.height * across * Gauss(z - bump.centre_z, bump.width_z);
}

// A ridge that rises and widens from its root between the eyes to its tip, and ends in a steep
// base.
double NoseHeight(double y, double z) {
  constexpr double kRoot_z = 30.0, kTip_z = -18.0, kBase_z = -37.0;
  const double down = SmoothStep(-z, -kRoot_z, -kTip_z + 15.0);
  const double height = 25.0 * down * (1.0 - SmoothStep(-z, -kTip_z, -kBase_z));
  return height * Gauss(y, 9.0 + 6.0 * down);
}

// The face's features, by `relief`: the jaw narrows it, nose and bumps lift it along x.
Vec3d WithFeatures(const Vec3d& base, double relief) {
  const double y = base.y(), z = base.z();
  double lift = NoseHeight(y, z);
  for (const Bump& bump : kBumps) lift += BumpHeight(bump, y, z);
  const double jaw = SmoothStep(-z, 0.0, 85.0);
  Vec3d moved = base;
  moved.x() += relief * lift;
  moved.y() *= 1.0 - relief * 0.12 * jaw;
  return moved;
}

// The unit disc on the half sphere x >= 0, equal areas to equal areas (Lambert's azimuthal map).
Vec3d HalfSphereFromDisc(const Vec2d& q) {
  const double stretch = std::sqrt(2.0 - q.squaredNorm());
  return {1.0 - q.squaredNorm(), q.x() * stretch, q.y() * stretch};
}

// The square on the unit disc, equal areas to equal areas (Shirley and Chiu 1997).
Vec2d DiscFromSquare(const Vec2d& p) {
  const double a = p.x(), b = p.y();
  if (a == 0.0 && b == 0.0) return Vec2d::Zero();
  if (std::abs(a) > std::abs(b)) {
    const double phi = kPi / 4.0 * (b / a);
    return {a * std::cos(phi), a * std::sin(phi)};
  }
  const double phi = kPi / 4.0 * (a / b);
  return {b * std::sin(phi), b * std::cos(phi)};
}

}  // namespace

TriangleMesh FaceMask(const FaceShape& shape) {
  RETROLUX_CHECK(shape.area_mm2 > 0.0 && shape.relief >= 0.0 && shape.relief <= 1.5,
                 "area {} mm2, relief {}", shape.area_mm2, shape.relief);
  const auto surface = [&](const Vec2d& q) {
    return WithFeatures(kSemiAxes.cwiseProduct(HalfSphereFromDisc(q)), shape.relief);
  };
  TriangleMesh mesh = SymmetricGridMesh(shape.rows, shape.columns, DiscFromSquare, surface);
  const double scale = std::sqrt(shape.area_mm2 / mesh.Area());
  for (Vec3f& p : mesh.positions) p = (p.cast<double>() * scale).cast<float>();
  return mesh;
}

}  // namespace retrolux
