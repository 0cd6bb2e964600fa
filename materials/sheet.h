// Retro-reflective sheeting: a retro-reflective part, which the BSDFs differ in, and what they
// share, a diffuse body under a rough dielectric cover (materials/coat.h).
#pragma once

#include <memory>

#include "core/sampling.h"
#include "materials/bsdf.h"
#include "materials/coat.h"

namespace retrolux {

// Cover and body of sheeting.
struct Sheet {
  Spectrum body;              // reflectance
  std::optional<Coat> cover;  // none: a bare body

  // f cos(wi), 1/sr; both directions above the surface.
  Spectral FCos(const Vec3f& wo, const Vec3f& wi, const Spectral& nm) const {
    if (!cover) return body.At(nm) * (wi.z() / kPiF);
    return cover->EvaluateSpecular(wo, wi).f_cos + body.At(nm) * cover->BodyCos(wo, wi);
  }
  // Share of the light to w that the cover reflects.
  float CoverAlbedo(const Vec3f& w) const { return cover ? cover->Albedo(w) : 0.0f; }
  // Share of the light along w that passes the cover, relative to normal incidence.
  float Passes(const Vec3f& w) const { return cover ? cover->Passes(w) : 1.0f; }
};

// diffuse_reflectance (default 0.27), ior (1: no cover; default 1.5), cover_roughness (GGX width,
// default 0.1).
Sheet ReadSheet(JsonReader& json);

// A sheet and its retro-reflective part. `Retro` has, for directions above the surface,
//   struct Value { float f_cos, pdf; };  Value Evaluate(wo, wi): f cos(wi) and the density of
//     Sample, 1/sr;
//   Vec3f Sample(wo, lobe, u): a direction, which may lie below the surface;
//   float Share(wo): about the share of the light to wo that it reflects.
template <typename Retro>
class Sheeting : public Bsdf {
 public:
  Sheeting(Retro retro, std::shared_ptr<const Sheet> sheet)
      : retro_(std::move(retro)), sheet_(std::move(sheet)), body_share_(sheet_->body.Max()) {}

  BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi, const Spectral& nm) const override {
    if (wo.z() <= 0.0f || wi.z() <= 0.0f) return {};
    const typename Retro::Value retro = retro_.Evaluate(wo, wi);
    const Shares shares = SharesAt(wo);
    float pdf = shares.retro * retro.pdf + shares.body * PdfCosineHemisphere(wi.z());
    if (sheet_->cover) pdf += shares.cover * sheet_->cover->EvaluateSpecular(wo, wi).pdf;
    return {retro.f_cos + sheet_->FCos(wo, wi, nm), pdf / shares.Sum()};
  }

  std::optional<BsdfSample> Sample(const Vec3f& wo, float lobe, const Vec2f& u,
                                   const Spectral& nm) const override {
    if (wo.z() <= 0.0f) return std::nullopt;
    const Vec3f wi = Draw(wo, lobe, u);
    if (wi.z() <= 0.0f) return std::nullopt;
    const BsdfValue value = Evaluate(wo, wi, nm);
    if (!(value.pdf > 0.0f)) return std::nullopt;
    return BsdfSample{wi, value.f_cos / value.pdf, value.pdf};
  }

 private:
  // Probabilities of the parts, not normalised.
  struct Shares {
    float retro, cover, body;
    float Sum() const { return retro + cover + body; }
  };
  Shares SharesAt(const Vec3f& wo) const {
    return {retro_.Share(wo), sheet_->CoverAlbedo(wo), body_share_ + 1e-6f};
  }

  Vec3f Draw(const Vec3f& wo, float lobe, const Vec2f& u) const {
    const Shares shares = SharesAt(wo);
    const float rest = lobe * shares.Sum();
    if (rest < shares.retro) return retro_.Sample(wo, rest / shares.retro, u);
    if (rest < shares.retro + shares.cover) return sheet_->cover->SampleSpecular(wo, u);
    return SampleCosineHemisphere(u);
  }

  Retro retro_;
  std::shared_ptr<const Sheet> sheet_;
  float body_share_;
};

}  // namespace retrolux
