// The body mask: the front of a trunk. Each cross-section is half a superellipse (exponent 2.5, a
// little flatter than an ellipse) whose half width and height vary along the body, with smooth
// bumps on it. Numbers in the proportions of an adult man; ours, listed in docs/masks.md.
#include <cmath>

#include "scenes/grid_mesh.h"
#include "scenes/masks.h"

namespace retrolux {

namespace {

constexpr int kRows = 61, kColumns = 41;
constexpr double kHalfLength = 225.0;
constexpr double kExponent = 2.5;

double Gauss(double x, double width) {
  return std::exp(-(x / width) * (x / width));
}

// height * exp(-((x - centre_x) / width_x)^2 - ((y - centre_y) / width_y)^2), added to z. With
// centre_y > 0 a second one mirrors it.
struct Bump {
  const char* name;
  double centre_x, centre_y, width_x, width_y, height;
};
constexpr Bump kBumps[] = {
    {"chest muscle", -135.0, 75.0, 55.0, 55.0, 12.0},
    {"furrow over the breast bone", -130.0, 0.0, 70.0, 16.0, -4.0},
    {"edge of the ribs", -20.0, 70.0, 30.0, 45.0, 6.0},
    {"pit of the stomach", -35.0, 0.0, 28.0, 30.0, -8.0},
    {"belly", 75.0, 0.0, 60.0, 80.0, 10.0},
    {"navel", 70.0, 0.0, 17.0, 17.0, -6.0},
    {"hip bone", 135.0, 115.0, 35.0, 28.0, 9.0},
    {"groin", 200.0, 65.0, 45.0, 30.0, -8.0},
};

double BumpHeight(const Bump& bump, double x, double y) {
  const double across = bump.centre_y > 0.0 ? Gauss(y - bump.centre_y, bump.width_y) +
                                                  Gauss(y + bump.centre_y, bump.width_y)
                                            : Gauss(y, bump.width_y);
  return bump.height * across * Gauss(x - bump.centre_x, bump.width_x);
}

double BumpSum(double x, double y) {
  double sum = 0.0;
  for (const Bump& bump : kBumps) sum += BumpHeight(bump, x, y);
  return sum;
}

// Chest and hips are wide, the waist between them is not.
double HalfWidth(double x) {
  return 180.0 - 26.0 * Gauss(x - 10.0, 85.0);
}

double Height(double x) {
  return 92.0 + 8.0 * Gauss(x + 110.0, 110.0) - 8.0 * Gauss(x - 20.0, 60.0);
}

// u: from the patient's right side (-1) to the left (1); v: from the hips (-1) to the chest (1).
Vec3d TrunkPoint(const Vec2d& uv) {
  const double x = -kHalfLength * uv.y();
  const double angle = 0.5 * kPi * uv.x();  // from straight up towards +y
  const double s = std::sin(angle), c = std::cos(angle);
  const double radius = std::pow(
      std::pow(std::abs(s), kExponent) + std::pow(std::abs(c), kExponent), -1.0 / kExponent);
  const double y = HalfWidth(x) * radius * s;
  return {x, y, Height(x) * radius * c + c * BumpSum(x, y)};
}

}  // namespace

TriangleMesh BodyMask() {
  const auto map = [](const Vec2d& place) { return place; };
  return SymmetricGridMesh(kRows, kColumns, map, TrunkPoint);
}

}  // namespace retrolux
