// Statistics for tests of random results. All seeds in the tests are fixed: a test passes always or
// never; the significance says how surprised to be when it fails after a change.
#pragma once

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace retrolux::statistics {

// Regularised upper incomplete gamma function Q(a, x) by series and continued fraction (Numerical
// Recipes 6.2).
inline double UpperGamma(double a, double x) {
  if (x <= 0.0) return 1.0;
  if (x < a + 1.0) {
    double term = 1.0 / a, sum = term;
    for (int n = 1; n < 10000 && std::abs(term) > std::abs(sum) * 1e-15; ++n)
      sum += term *= x / (a + n);
    return 1.0 - sum * std::exp(-x + a * std::log(x) - std::lgamma(a));
  }
  double b = x + 1.0 - a, c = 1e300, d = 1.0 / b, h = d;
  for (int n = 1; n < 10000; ++n) {
    const double an = -n * (n - a);
    b += 2.0;
    d = 1.0 / (an * d + b);
    c = b + an / c;
    const double step = d * c;
    h *= step;
    if (std::abs(step - 1.0) < 1e-15) break;
  }
  return std::exp(-x + a * std::log(x) - std::lgamma(a)) * h;
}

// The probability of counts that lie at least this far from the expected ones. Neighbouring cells
// are pooled until each expects five or more.
inline double ChiSquarePValue(const std::vector<double>& observed,
                              const std::vector<double>& expected) {
  std::vector<std::pair<double, double>> cells;  // observed, expected
  bool open = false;
  for (size_t i = 0; i < observed.size(); ++i) {
    if (!open) cells.emplace_back(0.0, 0.0);
    cells.back().first += observed[i];
    cells.back().second += expected[i];
    open = cells.back().second < 5.0;
  }
  if (open && cells.size() > 1) {  // what is left joins the cell before it
    const auto rest = cells.back();
    cells.pop_back();
    cells.back().first += rest.first;
    cells.back().second += rest.second;
  }
  if (cells.size() < 2) return 1.0;
  double chi2 = 0.0;
  for (const auto& [o, e] : cells) chi2 += (o - e) * (o - e) / e;
  return UpperGamma(0.5 * static_cast<double>(cells.size() - 1), 0.5 * chi2);
}

// Two-sided probability of a standard normal number at least this far from zero.
inline double NormalPValue(double z) {
  return std::erfc(std::abs(z) / std::sqrt(2.0));
}

// Significance of each of `tests` tests, so that all of them together have `significance` (Sidak).
inline double Sidak(double significance, double tests) {
  return 1.0 - std::pow(1.0 - significance, 1.0 / tests);
}

struct Moments {
  double mean = 0.0, variance = 0.0;  // of the values, not of their mean
  size_t count = 0;
  double StandardError() const { return std::sqrt(variance / static_cast<double>(count)); }
};
template <typename Values>
Moments MomentsOf(const Values& values) {
  Moments m;
  m.count = values.size();
  for (const auto v : values) m.mean += static_cast<double>(v);
  m.mean /= static_cast<double>(m.count);
  for (const auto v : values) m.variance += std::pow(static_cast<double>(v) - m.mean, 2);
  m.variance /= static_cast<double>(m.count - 1);
  return m;
}

}  // namespace retrolux::statistics
