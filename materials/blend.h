// A mix of two BSDFs by their shares of the surface.
#pragma once

#include "materials/bsdf.h"

namespace retrolux {

// f = share f_one + (1 - share) f_zero: linear, hence reciprocal, and without gain of energy, where
// both parts are. Directions are drawn from `one` with the probability `share`, else from `zero`;
// the density is the same mix of theirs. It owns neither part.
struct BsdfBlend {
  const Bsdf* one;
  const Bsdf* zero;  // none: `one` alone, whatever the share
  float share;       // 0..1, of `one`

  // As those of Bsdf (materials/bsdf.h).
  BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi, const Spectral& nm) const;
  std::optional<BsdfSample> Sample(const Vec3f& wo, float lobe, const Vec2f& u,
                                   const Spectral& nm) const;
};

}  // namespace retrolux
