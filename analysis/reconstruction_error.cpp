#include "analysis/reconstruction_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/cap_area.h"
#include "core/error.h"

namespace retrolux {

namespace {

double LeastError(const std::vector<ErrorPoint>& points) {
  return std::min_element(
             points.begin(), points.end(),
             [](const ErrorPoint& a, const ErrorPoint& b) { return a.error_mm < b.error_mm; })
      ->error_mm;
}

void CheckPoints(const std::vector<ErrorPoint>& points) {
  RETROLUX_CHECK(points.size() >= 3, "{} known points", points.size());
  double last_deg = 0.0;
  for (const ErrorPoint& point : points) {
    RETROLUX_CHECK(point.angle_deg > last_deg && point.angle_deg <= 90.0, "{} deg after {} deg",
                   point.angle_deg, last_deg);
    RETROLUX_CHECK(point.error_mm > 0.0 && std::isfinite(point.error_mm), "{} mm at {} deg",
                   point.error_mm, point.angle_deg);
    last_deg = point.angle_deg;
  }
}

// The second derivatives at the knots of the cubic spline through (x, y) whose slope is `slope` at
// the first knot and -slope at the last (Burden and Faires, "Numerical Analysis", clamped spline).
std::vector<double> SecondDerivatives(const std::vector<double>& x, const std::vector<double>& y,
                                      double slope) {
  const auto n = static_cast<Eigen::Index>(x.size());
  Eigen::MatrixXd matrix =
      Eigen::MatrixXd::Zero(n, n);  // tridiagonal, symmetric, positive definite
  Eigen::VectorXd jump_of_slope = Eigen::VectorXd::Zero(n);
  jump_of_slope[0] = -slope;
  jump_of_slope[n - 1] = -slope;
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    const auto k = static_cast<size_t>(i);
    const double width = x[k + 1] - x[k];
    const double chord = (y[k + 1] - y[k]) / width;
    matrix.block<2, 2>(i, i) += width / 6.0 * (Eigen::Matrix2d() << 2, 1, 1, 2).finished();
    jump_of_slope[i] += chord;
    jump_of_slope[i + 1] -= chord;
  }
  const Eigen::VectorXd solution = matrix.llt().solve(jump_of_slope);
  return {solution.begin(), solution.end()};
}

// Where a function with one maximum in [begin, end] has it (Kiefer 1953).
template <typename F>
double GoldenSectionMaximum(const F& f, double begin, double end) {
  constexpr double kShare = 1.0 / std::numbers::phi;
  double left = end - kShare * (end - begin), right = begin + kShare * (end - begin);
  double f_left = f(left), f_right = f(right);
  while (end - begin > 1e-9) {
    if (f_left < f_right) {
      begin = left;
      left = right;
      f_left = f_right;
      right = begin + kShare * (end - begin);
      f_right = f(right);
    } else {
      end = right;
      right = left;
      f_right = f_left;
      left = end - kShare * (end - begin);
      f_left = f(left);
    }
  }
  return 0.5 * (begin + end);
}

}  // namespace

ReconstructionError::ReconstructionError(const std::vector<ErrorPoint>& points, double gamma_max_mm)
    : gamma_max_mm_(gamma_max_mm) {
  CheckPoints(points);
  RETROLUX_CHECK(gamma_max_mm > LeastError(points), "{} mm; least error {} mm", gamma_max_mm,
                 LeastError(points));
  for (const ErrorPoint& point : points) {
    angles_.push_back(RadFromDeg(point.angle_deg));
    errors_.push_back(point.error_mm);
  }
  for (auto point = points.rbegin(); point != points.rend(); ++point) {
    if (point->angle_deg == 90.0) continue;
    angles_.push_back(kPi - RadFromDeg(point->angle_deg));
    errors_.push_back(point->error_mm);
  }
  const double slope_of_continuation = -0.5 * errors_[0] / std::tan(0.5 * angles_[0]);
  second_derivatives_ = SecondDerivatives(angles_, errors_, slope_of_continuation);
}

double ReconstructionError::Error_mm(double psi) const {
  const double folded = std::min(psi, kPi - psi);
  if (folded <= 0.0) return std::numeric_limits<double>::infinity();
  if (folded >= angles_[0]) return Spline(folded);
  return errors_[0] * std::sin(0.5 * angles_[0]) / std::sin(0.5 * folded);
}

double ReconstructionError::Weight(double psi) const {
  return std::max(0.0, 1.0 - Error_mm(psi) / gamma_max_mm_);
}

double ReconstructionError::Spline(double psi) const {
  const auto next = std::upper_bound(angles_.begin() + 1, angles_.end() - 1, psi);
  const auto b = static_cast<size_t>(next - angles_.begin()), a = b - 1;
  const double width = angles_[b] - angles_[a];
  const double to_b = (angles_[b] - psi) / width, from_a = (psi - angles_[a]) / width;
  return to_b * errors_[a] + from_a * errors_[b] +
         width * width / 6.0 *
             ((to_b * to_b * to_b - to_b) * second_derivatives_[a] +
              (from_a * from_a * from_a - from_a) * second_derivatives_[b]);
}

double SphereOptimalAngle(const ReconstructionError& error, double cap_half_angle) {
  RETROLUX_CHECK(cap_half_angle > kPi / 4.0, "half-angle {} rad", cap_half_angle);
  const auto weighted_area = [&](double psi) {
    return error.Weight(psi) * TwoCapArea(1.0, cap_half_angle, cap_half_angle, psi);
  };
  constexpr double kStep = kPi / 180.0;
  double best = kStep;
  for (int i = 2; i < 180; ++i) {
    if (weighted_area(i * kStep) > weighted_area(best)) best = i * kStep;
  }
  return GoldenSectionMaximum(weighted_area, best - kStep, best + kStep);
}

double CalibrateGammaMax(const std::vector<ErrorPoint>& points, double optimal_angle,
                         double cap_half_angle) {
  CheckPoints(points);
  const auto optimum = [&](double gamma_max) {
    return SphereOptimalAngle(ReconstructionError(points, gamma_max), cap_half_angle);
  };
  constexpr double kLargest =
      1e6;  // times the least error: the optimum is below a tenth of a degree
  double low = LeastError(points) * (1.0 + 1e-9), high = 2.0 * low;
  while (optimum(high) > optimal_angle && high < kLargest * low) high *= 2.0;
  while (high - low > 1e-9 * high) {
    const double middle = 0.5 * (low + high);
    (optimum(middle) > optimal_angle ? low : high) = middle;
  }
  if (std::abs(optimum(high) - optimal_angle) > 1e-4) {
    throw InputError(
        fmt::format("no gamma_max makes {} deg the optimal angle; the nearest that the error curve "
                    "allows is {} "
                    "deg",
                    DegFromRad(optimal_angle), DegFromRad(optimum(high))));
  }
  return high;
}

}  // namespace retrolux
