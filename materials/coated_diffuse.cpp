// coated_diffuse: plastic, a rough dielectric coat over a diffuse body (materials/coat.h).
//   reflectance   of the body, 0..1, number or table     default 0.8
//   ior           refractive index of the coat           default 1.47
//   roughness     GGX width of the coat                  default 0.15
#include "materials/bsdf_factory.h"
#include "materials/coat.h"

namespace retrolux {

namespace {

class CoatedDiffuse : public Bsdf {
 public:
  CoatedDiffuse(Spectrum reflectance, float ior, float alpha)
      : reflectance_(std::move(reflectance)),
        mean_reflectance_(reflectance_.Max()),
        coat_(ior, alpha) {}

  BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi, const Spectral& nm) const override {
    if (wo.z() <= 0.0f || wi.z() <= 0.0f) return {};
    const Coat::Specular specular = coat_.EvaluateSpecular(wo, wi);
    const float share = SpecularShare(wo);
    return {specular.f_cos + reflectance_.At(nm) * coat_.BodyCos(wo, wi),
            share * specular.pdf + (1.0f - share) * PdfCosineHemisphere(wi.z())};
  }
  std::optional<BsdfSample> Sample(const Vec3f& wo, float lobe, const Vec2f& u,
                                   const Spectral& nm) const override {
    if (wo.z() <= 0.0f) return std::nullopt;
    const Vec3f wi =
        lobe < SpecularShare(wo) ? coat_.SampleSpecular(wo, u) : SampleCosineHemisphere(u);
    if (wi.z() <= 0.0f) return std::nullopt;
    const BsdfValue value = Evaluate(wo, wi, nm);
    return BsdfSample{wi, value.f_cos / value.pdf, value.pdf};
  }

 private:
  float SpecularShare(const Vec3f& wo) const {
    const float specular = coat_.Albedo(wo);
    return specular / (specular + (1.0f - specular) * mean_reflectance_ + 1e-6f);
  }
  Spectrum reflectance_;
  float mean_reflectance_;
  Coat coat_;
};

}  // namespace

std::shared_ptr<const Bsdf> MakeCoatedDiffuse(JsonReader& json) {
  Spectrum reflectance = ReadSpectrum(json, "reflectance", 0.0, 1.0, 0.8);
  const auto ior = static_cast<float>(json.Number("ior", 1.01, 4.0, 1.47));
  const auto alpha = static_cast<float>(json.Number("roughness", 0.001, 1.0, 0.15));
  return std::make_shared<CoatedDiffuse>(std::move(reflectance), ior, alpha);
}

}  // namespace retrolux
