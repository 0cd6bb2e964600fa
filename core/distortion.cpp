#include "core/distortion.h"

#include <cmath>
#include <complex>
#include <limits>

namespace retrolux {

namespace {

// The first zero of d(r radial)/dr = 1 + 3 k1 s + 5 k2 s^2 + 7 k3 s^3 over s = r^2: the smallest
// positive eigenvalue of the polynomial's companion matrix.
double RadiusOfTurn(double k1, double k2, double k3) {
  const double coefficients[] = {1.0, 3.0 * k1, 5.0 * k2, 7.0 * k3};
  Eigen::Index degree = 3;
  while (degree > 0 && coefficients[degree] == 0.0) --degree;
  double smallest = std::numeric_limits<double>::infinity();
  if (degree == 0) return smallest;
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(degree, degree);
  for (Eigen::Index i = 0; i < degree; ++i) {
    companion(i, degree - 1) = -coefficients[i] / coefficients[degree];
    if (i > 0) companion(i, i - 1) = 1.0;
  }
  const Eigen::VectorXcd roots = companion.eigenvalues();
  for (const std::complex<double>& root : roots) {
    const bool real = std::abs(root.imag()) <= 1e-9 * std::abs(root);
    if (real && root.real() > 0.0) smallest = std::min(smallest, std::sqrt(root.real()));
  }
  return smallest;
}

}  // namespace

Distortion::Distortion(double k1, double k2, double p1, double p2, double k3)
    : k1_(k1), k2_(k2), p1_(p1), p2_(p2), k3_(k3), largest_radius_(RadiusOfTurn(k1, k2, k3)) {}

Vec2d Distortion::Apply(const Vec2d& ideal) const {
  const double x = ideal.x(), y = ideal.y(), r2 = ideal.squaredNorm();
  const double radial = 1.0 + r2 * (k1_ + r2 * (k2_ + r2 * k3_));
  return {x * radial + 2.0 * p1_ * x * y + p2_ * (r2 + 2.0 * x * x),
          y * radial + p1_ * (r2 + 2.0 * y * y) + 2.0 * p2_ * x * y};
}

Eigen::Matrix2d Distortion::Jacobian(const Vec2d& ideal) const {
  if (IsNone()) return Eigen::Matrix2d::Identity();
  const double x = ideal.x(), y = ideal.y(), r2 = ideal.squaredNorm();
  const double radial = 1.0 + r2 * (k1_ + r2 * (k2_ + r2 * k3_));
  const double slope = 2.0 * (k1_ + r2 * (2.0 * k2_ + r2 * 3.0 * k3_));  // d radial / dx = slope x
  const double mixed = slope * x * y + 2.0 * p1_ * x + 2.0 * p2_ * y;
  Eigen::Matrix2d jacobian;
  jacobian << radial + slope * x * x + 2.0 * p1_ * y + 6.0 * p2_ * x, mixed, mixed,
      radial + slope * y * y + 6.0 * p1_ * y + 2.0 * p2_ * x;
  return jacobian;
}

std::optional<Vec2d> Distortion::Remove(const Vec2d& distorted) const {
  if (IsNone()) return distorted;
  constexpr int kSteps = 50;
  Vec2d ideal = distorted;
  for (int i = 0; i < kSteps; ++i) {
    const Vec2d step = Jacobian(ideal).inverse() * (distorted - Apply(ideal));
    if (!step.allFinite()) return std::nullopt;
    // Not further than the point lies from the axis at once: the inverse is found near it or not
    // at all.
    const double most = std::max(0.5 * ideal.norm(), 1e-3);
    ideal += step.norm() > most ? Vec2d(step * (most / step.norm())) : step;
    if (step.norm() <= 1e-15 * (1.0 + ideal.norm())) break;
  }
  const bool good = (Apply(ideal) - distorted).norm() <= 1e-12 * (1.0 + distorted.norm()) &&
                    ideal.norm() < largest_radius_;
  return good ? std::optional(ideal) : std::nullopt;
}

}  // namespace retrolux
