// Isotropic Beckmann microfacets: a Gaussian distribution of slopes, exp(-tan^2 / alpha^2)
// (Beckmann and Spizzichino 1963; Walter et al. 2007). The functions are those of
// materials/microfacet.h.
#pragma once

#include "materials/microfacet.h"

namespace retrolux::beckmann {

// Distribution of microfacet normals, 1/sr.
inline float Distribution(const Vec3f& h, float alpha) {
  if (h.z() <= 0.0f) return 0.0f;
  const float alpha2 = alpha * alpha;
  const float cos2 = h.z() * h.z();
  const float tan2 = (h.x() * h.x() + h.y() * h.y()) / cos2;
  return std::exp(-tan2 / alpha2) / (kPiF * alpha2 * cos2 * cos2);
}

// The exact form, (erf(a) - 1) / 2 + exp(-a^2) / (2 a sqrt(pi)) with a = 1 / (alpha tan).
inline float Lambda(const Vec3f& w, float alpha) {
  const float tan2 = (w.x() * w.x() + w.y() * w.y()) / (w.z() * w.z());
  const float inverse = alpha * std::sqrt(tan2);
  if (inverse < 0.2f) return 0.0f;  // a > 5: below 1e-12
  const float a = 1.0f / inverse;
  constexpr float kTwoSqrtPi = 3.5449077f;
  return 0.5f * (std::erf(a) - 1.0f) + std::exp(-a * a) / (kTwoSqrtPi * a);
}

// A microfacet normal among those visible from w. Seen in the plane of w, a facet of slope s
// towards the viewer has the density (cos + s sin)+ exp(-s^2) / sqrt(pi), across it exp(-s^2) /
// sqrt(pi), both once the surface is stretched to alpha = 1 (Heitz and d'Eon 2014); the cumulated
// densities are inverted numerically (as Jakob 2014).
Vec3f SampleVisibleNormal(const Vec3f& w, float alpha, const Vec2f& u);

}  // namespace retrolux::beckmann
