// Isotropic GGX microfacets (Walter et al. 2007) and the Fresnel term. `alpha` is the GGX width;
// all directions are local (z = normal) and above the surface.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/conventions.h"

namespace retrolux::ggx {

// Distribution of microfacet normals, 1/sr. The tangent comes from the horizontal components, so
// that lobes far below a degree keep their digits in single precision.
inline float Distribution(const Vec3f& h, float alpha) {
  if (h.z() <= 0.0f) return 0.0f;
  const float alpha2 = alpha * alpha;
  const float c = h.z() * h.z() + (h.x() * h.x() + h.y() * h.y()) / alpha2;
  return 1.0f / (kPiF * alpha2 * c * c);
}

inline float Lambda(const Vec3f& w, float alpha) {
  const float tan2 = (w.x() * w.x() + w.y() * w.y()) / (w.z() * w.z());
  return 0.5f * (std::sqrt(1.0f + alpha * alpha * tan2) - 1.0f);
}

inline float MaskingOne(const Vec3f& w, float alpha) {
  return 1.0f / (1.0f + Lambda(w, alpha));
}

// Height-correlated Smith masking and shadowing.
inline float MaskingBoth(const Vec3f& a, const Vec3f& b, float alpha) {
  return 1.0f / (1.0f + Lambda(a, alpha) + Lambda(b, alpha));
}

// A microfacet normal among those visible from w (Heitz, JCGT 7(4), 2018). Reflecting w at it has
// the density D(h) / (4 w.z (1 + Lambda(w))) over directions: the Jacobian 1/(4 w.h) cancels the
// cosine.
inline Vec3f SampleVisibleNormal(const Vec3f& w, float alpha, const Vec2f& u) {
  const Vec3f stretched = Vec3f(alpha * w.x(), alpha * w.y(), w.z()).normalized();
  const float length2 = stretched.x() * stretched.x() + stretched.y() * stretched.y();
  const Vec3f t1 = length2 > 0.0f
                       ? Vec3f(Vec3f(-stretched.y(), stretched.x(), 0.0f) / std::sqrt(length2))
                       : Vec3f::UnitX();
  const Vec3f t2 = stretched.cross(t1);
  const float r = std::sqrt(u.x());
  const float phi = 2.0f * kPiF * u.y();
  const float p1 = r * std::cos(phi);
  const float s = 0.5f * (1.0f + stretched.z());
  const float p2 = (1.0f - s) * std::sqrt(std::max(0.0f, 1.0f - p1 * p1)) + s * r * std::sin(phi);
  const float p3 = std::sqrt(std::max(0.0f, 1.0f - p1 * p1 - p2 * p2));
  const Vec3f n = p1 * t1 + p2 * t2 + p3 * stretched;
  return Vec3f(alpha * n.x(), alpha * n.y(), std::max(1e-7f, n.z())).normalized();
}

// Unpolarised Fresnel reflectance of a dielectric of index `ior` seen from air, at cos(incidence) >
// 0.
inline float FresnelDielectric(float cosine, float ior) {
  const float g = std::sqrt(ior * ior - 1.0f + cosine * cosine);
  const float a = (g - cosine) / (g + cosine);
  const float b = (cosine * (g + cosine) - 1.0f) / (cosine * (g - cosine) + 1.0f);
  return 0.5f * a * a * (1.0f + b * b);
}

inline Vec3f Reflect(const Vec3f& w, const Vec3f& h) {
  return 2.0f * w.dot(h) * h - w;
}

}  // namespace retrolux::ggx
