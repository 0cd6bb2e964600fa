#include "classifier/registration.h"

#include <cmath>

#include "core/error.h"

namespace retrolux {

namespace {

struct Centres {
  Vec3d a = Vec3d::Zero(), b = Vec3d::Zero();
  double weight = 0.0;
};

Centres CentresOf(std::span<const PointPair> pairs) {
  Centres centres;
  for (const PointPair& pair : pairs) {
    centres.a += pair.weight * pair.in_a;
    centres.b += pair.weight * pair.in_b;
    centres.weight += pair.weight;
  }
  centres.a /= centres.weight;
  centres.b /= centres.weight;
  return centres;
}

// Mean squares along the principal axes (the columns of `axes`), ascending, mm2.
struct Spread {
  Vec3d squares;
  Mat3d axes;
};

Spread SpreadOf(std::span<const PointPair> pairs, const Vec3d& centre_a, double weight) {
  Mat3d covariance = Mat3d::Zero();
  for (const PointPair& pair : pairs) {
    const Vec3d d = pair.in_a - centre_a;
    covariance += pair.weight / weight * d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Mat3d> solver(covariance);
  return {solver.eigenvalues().cwiseMax(0.0), solver.eigenvectors()};
}

void CheckPairs(std::span<const PointPair> pairs) {
  if (const auto fault = RegistrationFault(pairs)) throw InputError(*fault);
}

}  // namespace

std::optional<std::string> RegistrationFault(std::span<const PointPair> pairs) {
  if (pairs.size() < 3) {
    return fmt::format("{} points to register; expected three that do not lie on a line",
                       pairs.size());
  }
  for (const PointPair& pair : pairs) {
    if (pair.weight > 0.0 && std::isfinite(pair.weight)) continue;
    return fmt::format("a point to register has the weight {}; expected above 0", pair.weight);
  }
  constexpr double kOnLine = 1e-3;
  const Centres centres = CentresOf(pairs);
  const Spread spread = SpreadOf(pairs, centres.a, centres.weight);
  const double along = std::sqrt(spread.squares[2]), across = std::sqrt(spread.squares[1]);
  if (across > kOnLine * along) return std::nullopt;
  return fmt::format(
      "the {} points to register lie on a line (spread {:.3g} mm along, {:.3g} mm across); "
      "expected three that do not",
      pairs.size(), along, across);
}

Registration RegisterPoints(std::span<const PointPair> pairs) {
  CheckPairs(pairs);
  const Centres centres = CentresOf(pairs);
  Mat3d cross = Mat3d::Zero();
  for (const PointPair& pair : pairs) {
    cross += pair.weight * (pair.in_b - centres.b) * (pair.in_a - centres.a).transpose();
  }
  const Eigen::JacobiSVD<Mat3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Mat3d product = svd.matrixU() * svd.matrixV().transpose();
  const Vec3d signs(1.0, 1.0, product.determinant() < 0.0 ? -1.0 : 1.0);
  Registration result;
  result.b_from_a.rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  result.b_from_a.translation = centres.b - result.b_from_a.rotation * centres.a;
  double sum = 0.0;
  for (const PointPair& pair : pairs) {
    sum += pair.weight * (result.b_from_a * pair.in_a - pair.in_b).squaredNorm();
  }
  result.fre_mm = std::sqrt(sum / centres.weight);
  return result;
}

double ExpectedFre_mm(double fle_mm, size_t points) {
  RETROLUX_CHECK(points >= 3, "{} points", points);
  return fle_mm * std::sqrt(1.0 - 2.0 / static_cast<double>(points));
}

double FleFromFre_mm(double fre_mm, size_t points) {
  return fre_mm / ExpectedFre_mm(1.0, points);
}

double ExpectedTre_mm(std::span<const PointPair> pairs, double fle_mm, const Vec3d& target_in_a) {
  CheckPairs(pairs);
  const Centres centres = CentresOf(pairs);
  const Spread spread = SpreadOf(pairs, centres.a, centres.weight);
  const Vec3d target = spread.axes.transpose() * (target_in_a - centres.a);
  double sum = 0.0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double d2 = target.squaredNorm() - target[k] * target[k];
    const double f2 = spread.squares.sum() - spread.squares[k];
    sum += d2 / f2;
  }
  return fle_mm * std::sqrt((1.0 + sum / 3.0) / static_cast<double>(pairs.size()));
}

double RotationAngle(const Mat3d& rotation) {
  return Eigen::AngleAxisd(rotation).angle();
}

}  // namespace retrolux
