#include "classifier/error_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace retrolux {

namespace {

double Percentile95(std::vector<double> sizes) {
  if (sizes.empty()) return 0.0;
  const auto rank = static_cast<size_t>(std::ceil(0.95 * static_cast<double>(sizes.size()))) - 1;
  const auto at = sizes.begin() + static_cast<ptrdiff_t>(rank);
  std::nth_element(sizes.begin(), at, sizes.end());
  return *at;
}

double SquaredSum(const std::vector<Vec2d>& detected,
                  const std::vector<std::optional<Vec2d>>& truth, size_t first) {
  double sum = 0.0;
  for (size_t i = 0; i < truth.size(); ++i) {
    if (truth[i]) sum += (detected[(i + first) % detected.size()] - *truth[i]).squaredNorm();
  }
  return sum;
}

// Which detected corner is corner 0.
size_t FirstCorner(const std::vector<Vec2d>& detected,
                   const std::vector<std::optional<Vec2d>>& truth) {
  if (truth.size() != 3) return 0;
  size_t best = 0;
  for (size_t first = 1; first < truth.size(); ++first) {
    if (SquaredSum(detected, truth, first) < SquaredSum(detected, truth, best)) best = first;
  }
  return best;
}

}  // namespace

double ScalarErrors::StandardError() const {
  return count > 0 ? sigma / std::sqrt(static_cast<double>(count)) : 0.0;
}

ScalarErrors ScalarErrorsOf(const std::vector<double>& errors) {
  ScalarErrors result;
  result.count = errors.size();
  if (errors.empty()) return result;
  const double n = static_cast<double>(errors.size());
  std::vector<double> sizes;
  for (const double error : errors) {
    result.bias += error / n;
    sizes.push_back(std::abs(error));
  }
  double squares = 0.0;
  for (const double error : errors) squares += (error - result.bias) * (error - result.bias);
  if (errors.size() > 1) result.sigma = std::sqrt(squares / (n - 1.0));
  result.p95 = Percentile95(std::move(sizes));
  return result;
}

PlaceErrors PlaceErrorsOf(const std::vector<PlaceError>& errors) {
  std::vector<double> u, v, tilt, outward, distances;
  double squares = 0.0;
  for (const PlaceError& e : errors) {
    u.push_back(e.error.x());
    v.push_back(e.error.y());
    if (e.tilt) tilt.push_back(e.error.dot(*e.tilt));
    if (e.outward) outward.push_back(e.error.dot(*e.outward));
    distances.push_back(e.error.norm());
    squares += e.error.squaredNorm();
  }
  PlaceErrors result{ScalarErrorsOf(u), ScalarErrorsOf(v), ScalarErrorsOf(tilt),
                     ScalarErrorsOf(outward)};
  if (errors.empty()) return result;
  result.rms = std::sqrt(squares / static_cast<double>(errors.size()));
  result.p95 = Percentile95(std::move(distances));
  return result;
}

std::vector<PlaceError> CornerErrors(const std::vector<Vec2d>& detected,
                                     const std::vector<std::optional<Vec2d>>& truth,
                                     const Vec2d& centre_px, const std::optional<Vec2d>& tilt) {
  std::vector<PlaceError> errors;
  if (detected.size() != truth.size()) return errors;
  const size_t first = FirstCorner(detected, truth);
  for (size_t i = 0; i < truth.size(); ++i) {
    if (!truth[i]) continue;
    PlaceError error{detected[(i + first) % detected.size()] - *truth[i], tilt, std::nullopt};
    const Vec2d outward = *truth[i] - centre_px;
    if (outward.norm() > 0.0) error.outward = outward.normalized();
    errors.push_back(error);
  }
  return errors;
}

}  // namespace retrolux
