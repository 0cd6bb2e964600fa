#include "analysis/marker_grid.h"

#include <cmath>

namespace retrolux::marker_grid {

Vec3d Point(const GridPosition& position) {
  const double z = -135.0 + 10.0 * position.row;
  const double angle = RadFromDeg((position.col + 0.5) * 90.0 / kColumns);
  const double relative = z / kHalfLength_mm;
  const double rho = kRadius_mm * std::sqrt(1.0 - relative * relative);
  const double y = rho * std::sin(angle);
  return {rho * std::cos(angle), position.mirrored ? -y : y, z};
}

// For a surface of revolution rho(z), dA = sqrt(rho^2 + (rho rho')^2) dz dphi, with rho rho' =
// -(R/L)^2 z; the integrand is smooth up to the tips, so the midpoint rule in steps of 0.01 mm is
// exact to nine digits.
double CellArea_mm2(int row) {
  constexpr int kSteps = 1000;
  const double z0 = -kHalfLength_mm + 10.0 * row;
  const double ratio2 = std::pow(kRadius_mm / kHalfLength_mm, 2);
  double integral = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double z = z0 + 10.0 * (i + 0.5) / kSteps;
    const double rho2 = kRadius_mm * kRadius_mm - ratio2 * z * z;
    integral += std::sqrt(rho2 + ratio2 * ratio2 * z * z) * 10.0 / kSteps;
  }
  return integral * RadFromDeg(90.0 / kColumns);
}

double FaceHalfArea_mm2() {
  double area = 0.0;
  for (int row = 0; row < kRows; ++row) area += 2.0 * kColumns * CellArea_mm2(row);
  return area;
}

}  // namespace retrolux::marker_grid
