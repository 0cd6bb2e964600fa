// A lobe of the minimal retroreflective microfacet model (back vector; Portsmouth, Raab, Belcour,
// Liu, JCGT 15(1), 2026).
//
// With v' = (-v_x, -v_y, v_z), the view mirrored about the normal,
//   f = albedo D(b) G2(v', l) / (4 cos cos),   b = normalise(v' + l).
// Exchanging v and l mirrors b about the normal, which changes neither D nor G2: the model is
// reciprocal. Mirroring maps the hemisphere onto itself, so that the lobe reflects as much as the
// ordinary microfacet lobe of the same facets.
#pragma once

#include "materials/facets.h"

namespace retrolux {

struct RetroLobe {
  Facets facets;
  float albedo = 0.0f;  // of the facets themselves

  // f cos(wi), and the density of Sample; 1/sr. Both directions above the surface.
  struct Value {
    float f_cos, pdf;
  };
  Value Evaluate(const Vec3f& wo, const Vec3f& wi) const {
    const Vec3f b = (Mirrored(wo) + wi).normalized();
    const float density = facets.Distribution(b) / (4.0f * wo.z());
    const float lambda = facets.Lambda(wo);
    return {albedo * density / (1.0f + lambda + facets.Lambda(wi)), density / (1.0f + lambda)};
  }
  // May lie below the surface.
  Vec3f Sample(const Vec3f& wo, const Vec2f& u) const {
    const Vec3f mirrored = Mirrored(wo);
    return ggx::Reflect(mirrored, facets.SampleVisibleNormal(mirrored, u));
  }

 private:
  static Vec3f Mirrored(const Vec3f& w) { return {-w.x(), -w.y(), w.z()}; }
};

}  // namespace retrolux
