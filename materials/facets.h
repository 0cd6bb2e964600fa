// Microfacets of either distribution, as data.
#pragma once

#include "materials/beckmann.h"

namespace retrolux {

enum class FacetShape { kGgx, kBeckmann };

// An isotropic microfacet surface of width `alpha`; directions are local and above the surface.
struct Facets {
  FacetShape shape = FacetShape::kGgx;
  float alpha = 0.1f;

  // Of facet normals, 1/sr.
  float Distribution(const Vec3f& h) const {
    return shape == FacetShape::kGgx ? ggx::Distribution(h, alpha)
                                     : beckmann::Distribution(h, alpha);
  }
  // Smith's function: masking is 1 / (1 + Lambda(w)), of both directions, height-correlated,
  // 1 / (1 + Lambda(wo) + Lambda(wi)).
  float Lambda(const Vec3f& w) const {
    return shape == FacetShape::kGgx ? ggx::Lambda(w, alpha) : beckmann::Lambda(w, alpha);
  }
  // Reflecting w at it has the density D(h) / (4 w.z (1 + Lambda(w))) over directions.
  Vec3f SampleVisibleNormal(const Vec3f& w, const Vec2f& u) const {
    return shape == FacetShape::kGgx ? ggx::SampleVisibleNormal(w, alpha, u)
                                     : beckmann::SampleVisibleNormal(w, alpha, u);
  }
};

}  // namespace retrolux
