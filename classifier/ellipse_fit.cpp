#include "classifier/ellipse_fit.h"

#include <cmath>

namespace retrolux {

EllipseFit FitEllipse(const Polygon& outline) {
  const Vec2d centre = Centroid(outline);
  // Covariance of the region, by triangles from the centre: integral of p p^T over the triangle
  // (0, a, b) is cross(a, b) / 24 (a a^T + b b^T + (a + b)(a + b)^T).
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  double area = 0.0;
  for (size_t i = 0; i < outline.size(); ++i) {
    const Vec2d a = outline[i] - centre;
    const Vec2d b = outline[(i + 1) % outline.size()] - centre;
    const double cross = a.x() * b.y() - a.y() * b.x();
    area += 0.5 * cross;
    moment +=
        cross / 24.0 * (a * a.transpose() + b * b.transpose() + (a + b) * (a + b).transpose());
  }
  // An ellipse with semi-axis s has the variance s^2 / 4 along it.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(moment / area);
  const Vec2d semi = 2.0 * axes.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  EllipseFit fit{semi.y(), semi.x(), 0.0};
  if (!(semi.x() > 0.0)) return fit;
  double squares = 0.0;
  for (const Vec2d& p : outline) {
    const Vec2d x = axes.eigenvectors().transpose() * (p - centre);
    const Vec2d unit = x.cwiseQuotient(semi);
    // First-order distance: (|unit| - 1) over the length of its gradient.
    const double radius = unit.norm();
    const double gradient = unit.cwiseQuotient(semi).norm() / radius;
    const double distance = (radius - 1.0) / gradient;
    squares += distance * distance;
  }
  fit.rms_px = std::sqrt(squares / static_cast<double>(outline.size()));
  return fit;
}

}  // namespace retrolux
