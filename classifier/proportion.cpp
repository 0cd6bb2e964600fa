#include "classifier/proportion.h"

#include <algorithm>
#include <cmath>

namespace retrolux {

namespace {

constexpr double kNormalQuantile = 1.959963984540054;  // of 0.975

}  // namespace

std::optional<double> Proportion::Value() const {
  if (of == 0) return std::nullopt;
  return static_cast<double>(count) / static_cast<double>(of);
}

Interval Proportion::Wilson() const {
  if (of == 0) return {};
  const double n = static_cast<double>(of);
  const double p = static_cast<double>(count) / n;
  const double z2 = kNormalQuantile * kNormalQuantile;
  const double middle = p + 0.5 * z2 / n;
  const double half = kNormalQuantile * std::sqrt((p * (1.0 - p) + 0.25 * z2 / n) / n);
  const double scale = 1.0 / (1.0 + z2 / n);
  // At 0 and 1 the end is exact, whatever the rounding.
  return {count == 0 ? 0.0 : scale * (middle - half), count == of ? 1.0 : scale * (middle + half)};
}

double McNemarExactP(int64_t first_only, int64_t second_only) {
  const int64_t n = first_only + second_only;
  const int64_t fewer = std::min(first_only, second_only);
  const double trials = static_cast<double>(n);
  double tail = 0.0;
  for (int64_t k = 0; k <= fewer; ++k) {
    const double successes = static_cast<double>(k);
    tail += std::exp(std::lgamma(trials + 1.0) - std::lgamma(successes + 1.0) -
                     std::lgamma(trials - successes + 1.0) - trials * std::log(2.0));
  }
  return std::min(1.0, 2.0 * tail);
}

}  // namespace retrolux
