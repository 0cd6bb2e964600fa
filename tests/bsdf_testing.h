// What the tests of several BSDFs share.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/rng.h"
#include "core/sampling.h"
#include "materials/bsdf.h"

namespace retrolux {

using BsdfPtr = std::shared_ptr<const Bsdf>;

inline BsdfPtr FromJson(const std::string& text) {
  return MakeBsdf(JsonReader::FromText(text, "m.json"));
}

// Four different wavelengths, so that one that is taken for another shows.
inline Spectral AnyWavelengths() {
  return {450.0f, 620.0f, 880.0f, 1050.0f};
}

inline Vec3f AtAngle(double theta_deg, double phi_deg = 0.0) {
  const double t = RadFromDeg(theta_deg), p = RadFromDeg(phi_deg);
  return Vec3d(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)).cast<float>();
}

// f cos cos, the coefficient of retro-reflection in 1/sr.
inline double CoefficientOfRetroReflection(const Bsdf& bsdf, const Vec3f& wo, const Vec3f& wi) {
  return static_cast<double>(bsdf.Evaluate(wo, wi, AnyWavelengths()).f_cos[0] * wo.z());
}

// Share of the light to wo that is reflected: the mean of the weights over a stratified square of
// random numbers, with its standard error (an upper bound, because of the stratification), for the
// third wavelength.
struct Albedo {
  double mean, standard_error, least_weight;
};
inline Albedo DirectionalAlbedoOf(const Bsdf& bsdf, double theta_deg, int side, uint64_t key) {
  const Vec3f wo = AtAngle(theta_deg, 35.0);
  const Spectral nm = AnyWavelengths();
  KeyedRng rng(key);
  double sum = 0.0, sum2 = 0.0, least = 0.0;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const float lobe = rng.NextFloat();
      const Vec2f jitter(rng.NextFloat(), rng.NextFloat());
      const Vec2f u =
          (Vec2f(static_cast<float>(i), static_cast<float>(j)) + jitter) / static_cast<float>(side);
      const auto sample = bsdf.Sample(wo, lobe, u.cwiseMin(0x1.fffffep-1f), nm);
      const double weight = sample ? static_cast<double>(sample->weight[2]) : 0.0;
      sum += weight;
      sum2 += weight * weight;
      least = std::min(least, weight);
    }
  }
  const double n = static_cast<double>(side) * side, mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, sum2 / n - mean * mean) / n), least};
}

}  // namespace retrolux
