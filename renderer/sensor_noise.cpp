#include "renderer/sensor_noise.h"

#include <cmath>

namespace retrolux {

namespace {

// The first count whose cumulated probability exceeds a uniform number.
double PoissonByInversion(double mean, KeyedRng& rng) {
  constexpr double kLast = 200.0;  // beyond any probability that 53 bits resolve, at means below 10
  double rest = rng.NextDouble();
  double probability = std::exp(-mean);
  double count = 0.0;
  while (rest >= probability && count < kLast) {
    rest -= probability;
    count += 1.0;
    probability *= mean / count;
  }
  return count;
}

double PoissonByRejection(double mean, KeyedRng& rng) {
  const double root = std::sqrt(mean);
  const double b = 0.931 + 2.53 * root;
  const double a = -0.059 + 0.02483 * b;
  const double v_r = 0.9277 - 3.6224 / (b - 2.0);
  while (true) {
    const double u = rng.NextDouble() - 0.5;
    const double v = rng.NextDouble();
    const double us = 0.5 - std::abs(u);
    const double x = (2.0 * a / us + b) * u + mean + 0.43;
    if (x < 0.0) continue;
    const auto k = static_cast<double>(static_cast<int64_t>(x));  // faster than floor
    if (us >= 0.07 && v <= v_r) return k;
    if (us < 0.013 && v > us) continue;
    const double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4);
    if (std::log(v * inverse_alpha / (a / (us * us) + b)) <=
        -mean + k * std::log(mean) - std::lgamma(k + 1.0)) {
      return k;
    }
  }
}

}  // namespace

double SamplePoisson(double mean, KeyedRng& rng) {
  if (mean <= 0.0) return 0.0;
  return mean < 10.0 ? PoissonByInversion(mean, rng) : PoissonByRejection(mean, rng);
}

double InverseNormalCdf(double p) {
  constexpr double a[] = {-3.969683028665376e+01, 2.209460984245205e+02,  -2.759285104469687e+02,
                          1.383577518672690e+02,  -3.066479806614716e+01, 2.506628277459239e+00};
  constexpr double b[] = {-5.447609879822406e+01, 1.615858368580409e+02, -1.556989798598866e+02,
                          6.680131188771972e+01, -1.328068155288572e+01};
  constexpr double c[] = {-7.784894002430293e-03, -3.223964580411365e-01, -2.400758277161838e+00,
                          -2.549732539343734e+00, 4.374664141464968e+00,  2.938163982698783e+00};
  constexpr double d[] = {7.784695709041462e-03, 3.224671290700398e-01, 2.445134137142996e+00,
                          3.754408661907416e+00};
  constexpr double kTail = 0.02425;
  const auto tail = [&](double q) {
    return (((((c[0] * q + c[1]) * q + c[2]) * q + c[3]) * q + c[4]) * q + c[5]) /
           ((((d[0] * q + d[1]) * q + d[2]) * q + d[3]) * q + 1.0);
  };
  if (p < kTail) return tail(std::sqrt(-2.0 * std::log(p)));
  if (p > 1.0 - kTail) return -tail(std::sqrt(-2.0 * std::log(1.0 - p)));
  const double q = p - 0.5;
  const double r = q * q;
  return (((((a[0] * r + a[1]) * r + a[2]) * r + a[3]) * r + a[4]) * r + a[5]) * q /
         (((((b[0] * r + b[1]) * r + b[2]) * r + b[3]) * r + b[4]) * r + 1.0);
}

// Half a step off zero, so that the tail is finite: 8.2 standard deviations at most.
double SampleNormal(KeyedRng& rng) {
  return InverseNormalCdf(rng.NextDouble() + 0x1p-54);
}

}  // namespace retrolux
