// A rough dielectric coat and the diffuse body under it: the surface part shared by the mask's
// plastic and the cover of retro-reflective sheeting.
//
//   f = F D G2 / (4 cos cos)  +  reflectance / pi  (1 - E(wo)) (1 - E(wi)) / (1 - E_mean)
//
// with E the directional albedo of the coat's reflection. The second term couples the coat with the
// body so that a body of reflectance 1 reflects exactly what arrives (Kelemen and Szirmay-Kalos
// 2001): reciprocal, and no energy lost to the single scattering of the microfacet model.
#pragma once

#include "core/sampling.h"
#include "materials/directional_albedo.h"
#include "materials/microfacet.h"
#include "materials/spectrum.h"

namespace retrolux {

class Coat {
 public:
  Coat(float ior, float alpha) : ior_(ior), alpha_(alpha), albedo_(ior, alpha) {}

  // The coat's own reflection: f times cos(wi), and the density of SampleSpecular; both 1/sr. Both
  // directions above the surface.
  struct Specular {
    float f_cos, pdf;
  };
  Specular EvaluateSpecular(const Vec3f& wo, const Vec3f& wi) const {
    const Vec3f h = (wo + wi).normalized();
    const float facets = ggx::Distribution(h, alpha_) / (4.0f * wo.z());
    const float lambda = ggx::Lambda(wo, alpha_);
    return {ggx::FresnelDielectric(wo.dot(h), ior_) * facets /
                (1.0f + lambda + ggx::Lambda(wi, alpha_)),
            facets / (1.0f + lambda)};
  }
  Vec3f SampleSpecular(const Vec3f& wo, const Vec2f& u) const {
    return ggx::Reflect(wo, ggx::SampleVisibleNormal(wo, alpha_, u));
  }
  // f of a white body under the coat times cos(wi), 1/sr.
  float BodyCos(const Vec3f& wo, const Vec3f& wi) const {
    return (1.0f - Albedo(wo)) * (1.0f - Albedo(wi)) / (1.0f - albedo_.Mean()) * wi.z() / kPiF;
  }
  // Share of the light along w that passes the coat, relative to normal incidence.
  float Passes(const Vec3f& w) const { return (1.0f - Albedo(w)) / (1.0f - albedo_.At(1.0f)); }
  // Share of the light from wo that the coat reflects.
  float Albedo(const Vec3f& wo) const { return albedo_.At(wo.z()); }

 private:
  float ior_, alpha_;
  DirectionalAlbedo albedo_;
};

}  // namespace retrolux
