// rough_diffuse: a matt surface of Lambertian facets, "EON", the energy-preserving Oren-Nayar model
// (Portsmouth, Kutz, Hill, JCGT 14(1), 2025; arXiv:2410.18026): flatter than Lambert's, brighter
// towards the light.
//   reflectance   of the facets, 0..1, number or table     default 0.5
//   roughness     0 (Lambertian) to 1                      default 0.5
//
// With mu the cosines, s = wo.wi - mu_o mu_i, and t = max(mu_o, mu_i) where s > 0, else 1,
//   f = rho / pi A (1 + r s / t)  +  rho_ms / pi  (1 - E(wo)) (1 - E(wi)) / (1 - E_mean)
//   A = 1 / (1 + (1/2 - 2/(3 pi)) r)
//   E = A (1 + r G / pi),   G = sin (theta - sin cos) + 2/3 (sin / cos (1 - sin^3) - sin)
//   E_mean = A (1 + (2/3 - 28/(15 pi)) r)
//   rho_ms = rho^2 E_mean / (1 - rho (1 - E_mean))
//
// The first term is that of Fujii, E its directional albedo for rho = 1 in closed form; the second
// is the light that meets two facets or more. Reciprocal; a reflectance of 1 gives all light back.
#include "core/sampling.h"
#include "materials/bsdf_factory.h"

namespace retrolux {

namespace {

class RoughDiffuse : public Bsdf {
 public:
  RoughDiffuse(Spectrum reflectance, float roughness)
      : reflectance_(std::move(reflectance)),
        roughness_(roughness),
        a_(1.0f / (1.0f + (0.5f - 2.0f / (3.0f * kPiF)) * roughness)),
        mean_(a_ * (1.0f + (2.0f / 3.0f - 28.0f / (15.0f * kPiF)) * roughness)) {}

  BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi, const Spectral& nm) const override {
    if (wo.z() <= 0.0f || wi.z() <= 0.0f) return {};
    const float s = wo.x() * wi.x() + wo.y() * wi.y();  // wo.wi - mu_o mu_i
    const float s_over_t = s > 0.0f ? s / std::max(wo.z(), wi.z()) : s;
    const float once = a_ * (1.0f + roughness_ * s_over_t);
    const float more = Lost(wo.z()) * Lost(wi.z()) / std::max(1e-7f, 1.0f - mean_);
    const Spectral rho = reflectance_.At(nm);
    const Spectral rho_ms = rho * rho * mean_ / (1.0f - rho * (1.0f - mean_));
    return {(rho * once + rho_ms * more) * (wi.z() / kPiF), Pdf(wo, wi.z())};
  }
  std::optional<BsdfSample> Sample(const Vec3f& wo, float lobe, const Vec2f& u,
                                   const Spectral& nm) const override {
    if (wo.z() <= 0.0f) return std::nullopt;
    const Vec3f wi =
        lobe < UniformShare(wo) ? SampleUniformHemisphere(u) : SampleCosineHemisphere(u);
    if (wi.z() <= 0.0f) return std::nullopt;
    const BsdfValue value = Evaluate(wo, wi, nm);
    return BsdfSample{wi, value.f_cos / value.pdf, value.pdf};
  }

 private:
  // 1 - E: share of the light that the first facet does not send out again.
  float Lost(float mu) const {
    const float sine = std::sqrt(std::max(0.0f, 1.0f - mu * mu));
    // sin / cos (1 - sin^3), without the difference of nearly equal numbers at grazing angles.
    const float last = sine * mu * (1.0f + sine + sine * sine) / (1.0f + sine);
    const float g =
        sine * (std::acos(std::min(1.0f, mu)) - sine * mu) + (2.0f / 3.0f) * (last - sine);
    return std::max(0.0f, 1.0f - a_ * (1.0f + roughness_ * g / kPiF));
  }
  // Towards the light f rises as s / t, up to 1 / mu_o at grazing views; uniform directions bound
  // the weights there.
  float UniformShare(const Vec3f& wo) const { return 0.5f * roughness_ * (1.0f - wo.z()); }
  float Pdf(const Vec3f& wo, float cos_i) const {
    const float share = UniformShare(wo);
    return share / (2.0f * kPiF) + (1.0f - share) * PdfCosineHemisphere(cos_i);
  }
  static Vec3f SampleUniformHemisphere(const Vec2f& u) {
    const float sine = std::sqrt(std::max(0.0f, 1.0f - u.x() * u.x()));
    const float azimuth = 2.0f * kPiF * u.y();
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), u.x()};
  }

  Spectrum reflectance_;
  float roughness_, a_, mean_;
};

}  // namespace

std::shared_ptr<const Bsdf> MakeRoughDiffuse(JsonReader& json) {
  Spectrum reflectance = ReadSpectrum(json, "reflectance", 0.0, 1.0, 0.5);
  const auto roughness = static_cast<float>(json.Number("roughness", 0.0, 1.0, 0.5));
  return std::make_shared<RoughDiffuse>(std::move(reflectance), roughness);
}

}  // namespace retrolux
