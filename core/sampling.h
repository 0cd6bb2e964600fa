// Warps from the unit square, each with its density beside it.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/conventions.h"

namespace retrolux {

// An orthonormal frame around a unit normal (Duff et al., "Building an orthonormal basis,
// revisited", JCGT 6(1), 2017). Local z is the normal.
struct Frame {
  Vec3f tangent, bitangent, normal;

  explicit Frame(const Vec3f& n) : normal(n) {
    const float sign = std::copysign(1.0f, n.z());
    const float a = -1.0f / (sign + n.z());
    const float b = n.x() * n.y() * a;
    tangent = {1.0f + sign * n.x() * n.x() * a, sign * b, -sign * n.x()};
    bitangent = {b, sign + n.y() * n.y() * a, -n.y()};
  }
  Vec3f LocalFromWorld(const Vec3f& v) const {
    return {v.dot(tangent), v.dot(bitangent), v.dot(normal)};
  }
  Vec3f WorldFromLocal(const Vec3f& v) const {
    return tangent * v.x() + bitangent * v.y() + normal * v.z();
  }
};

// Uniform on the unit disc, area-preserving and continuous (Shirley and Chiu 1997). Density 1/pi.
inline Vec2f SampleUnitDisc(const Vec2f& u) {
  const float a = 2.0f * u.x() - 1.0f;
  const float b = 2.0f * u.y() - 1.0f;
  if (a == 0.0f && b == 0.0f) return Vec2f::Zero();
  const bool wide = std::abs(a) > std::abs(b);
  const float r = wide ? a : b;
  const float phi = wide ? (kPiF / 4.0f) * (b / a) : kPiF / 2.0f - (kPiF / 4.0f) * (a / b);
  return {r * std::cos(phi), r * std::sin(phi)};
}

// Cosine-weighted on the hemisphere z > 0.
inline Vec3f SampleCosineHemisphere(const Vec2f& u) {
  const Vec2f d = SampleUnitDisc(u);
  return {d.x(), d.y(), std::sqrt(std::max(0.0f, 1.0f - d.squaredNorm()))};
}
inline float PdfCosineHemisphere(float cos_theta) {
  return std::max(0.0f, cos_theta) / kPiF;
}

// The power heuristic of multiple importance sampling with exponent 2 (Veach 1995): the share of
// the technique whose density is `pdf`. Where one technique is far the better one, as light
// sampling is for a small LED, it leaves the other next to nothing, and so its scatter.
inline float PowerHeuristic(float pdf, float other_pdf) {
  if (pdf <= 0.0f) return 0.0f;
  const float ratio = other_pdf / pdf;
  return 1.0f / (1.0f + ratio * ratio);
}

}  // namespace retrolux
