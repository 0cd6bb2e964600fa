// conductor: a rough metal, GGX facets with the light that is scattered between them.
//   roughness    GGX width alpha                                          default 0.2
//   n, k         complex refractive index n + ik, numbers or tables; or
//   reflectance  of a facet at normal incidence, number or table (Schlick's curve beyond it)
//
//   f = F D G2 / (4 cos cos)  +  F_ms / pi  (1 - E(wo)) (1 - E(wi)) / (1 - E_mean)
//
// with E the directional albedo of facets that reflect all light. The second term is what leaves
// after two facets or more (Kulla and Conty 2017), with F_ms = F_mean^2 E_mean / (1 - F_mean (1 -
// E_mean)) and F_mean = 2 integral of F(c) c dc: reciprocal, and a metal without loss loses none.
#include "core/sampling.h"
#include "materials/bsdf_factory.h"
#include "materials/directional_albedo.h"
#include "materials/microfacet.h"

namespace retrolux {

namespace {

// Reflectance of the facets over wavelength and angle.
class FacetReflectance {
 public:
  // Schlick 1994.
  explicit FacetReflectance(Spectrum normal_incidence) : normal_(std::move(normal_incidence)) {}
  FacetReflectance(Spectrum n, Spectrum k) : n_(std::move(n)), k_(std::move(k)), exact_(true) {}

  Spectral At(float cosine, const Spectral& nm) const {
    if (exact_) return Fresnel(cosine, n_.At(nm), k_.At(nm));
    return Schlick(cosine, normal_.At(nm));
  }
  // Mean over diffuse light at one wavelength: 2 integral of F(c) c dc, midpoint rule.
  double Mean(double nm) const {
    constexpr int kPoints = 200;
    double sum = 0.0;
    for (int i = 0; i < kPoints; ++i) {
      const float cosine = (static_cast<float>(i) + 0.5f) / kPoints;
      sum +=
          static_cast<double>(cosine * At(cosine, Spectral::Constant(static_cast<float>(nm)))[0]);
    }
    return 2.0 * sum / kPoints;
  }

 private:
  static Spectral Schlick(float cosine, const Spectral& normal) {
    const float m = 1.0f - std::min(1.0f, cosine);
    return normal + (1.0f - normal) * (m * m * m * m * m);
  }
  // Unpolarised, from air (Born and Wolf, section 14.2): with a^2 + b^2 = |(n + ik)^2 - sin^2|,
  //   R_s = (a^2 + b^2 - 2 a c + c^2) / (a^2 + b^2 + 2 a c + c^2)
  //   R_p = R_s (c^2 (a^2 + b^2) - 2 a c s^2 + s^4) / (c^2 (a^2 + b^2) + 2 a c s^2 + s^4).
  static Spectral Fresnel(float cosine, const Spectral& n, const Spectral& k) {
    const float c2 = cosine * cosine, s2 = std::max(0.0f, 1.0f - c2);
    const Spectral real = n * n - k * k - s2;
    const Spectral a2b2 = (real * real + 4.0f * n * n * k * k).sqrt();
    const Spectral two_ac = 2.0f * cosine * (0.5f * (a2b2 + real)).max(0.0f).sqrt();
    const Spectral rs = (a2b2 + c2 - two_ac) / (a2b2 + c2 + two_ac);
    const Spectral p = c2 * a2b2 + s2 * s2;
    return 0.5f * rs * (1.0f + (p - two_ac * s2) / (p + two_ac * s2));
  }

  Spectrum normal_, n_, k_;
  bool exact_ = false;
};

class Conductor : public Bsdf {
 public:
  Conductor(FacetReflectance facets, float alpha)
      : facets_(std::move(facets)), alpha_(alpha), albedo_(DirectionalAlbedo::OfMirrors(alpha)) {
    const auto mean = static_cast<double>(albedo_.Mean());
    multiple_ = Spectrum::FromFunction([&](double nm) {
      const double f = facets_.Mean(nm);
      return f * f * mean / (1.0 - f * (1.0 - mean));
    });
  }

  BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi, const Spectral& nm) const override {
    if (wo.z() <= 0.0f || wi.z() <= 0.0f) return {};
    const Vec3f h = (wo + wi).normalized();
    const float density = ggx::Distribution(h, alpha_) / (4.0f * wo.z());
    const float lambda = ggx::Lambda(wo, alpha_);
    const float single = density / (1.0f + lambda + ggx::Lambda(wi, alpha_));
    const float share = SingleShare(wo);
    return {facets_.At(wo.dot(h), nm) * single + multiple_.At(nm) * MultipleCos(wo, wi),
            share * density / (1.0f + lambda) + (1.0f - share) * PdfCosineHemisphere(wi.z())};
  }
  std::optional<BsdfSample> Sample(const Vec3f& wo, float lobe, const Vec2f& u,
                                   const Spectral& nm) const override {
    if (wo.z() <= 0.0f) return std::nullopt;
    const Vec3f wi = lobe < SingleShare(wo)
                         ? ggx::Reflect(wo, ggx::SampleVisibleNormal(wo, alpha_, u))
                         : SampleCosineHemisphere(u);
    if (wi.z() <= 0.0f) return std::nullopt;
    const BsdfValue value = Evaluate(wo, wi, nm);
    if (!(value.pdf > 0.0f)) return std::nullopt;
    return BsdfSample{wi, value.f_cos / value.pdf, value.pdf};
  }

 private:
  // Share of the light that one facet does not send out again.
  float Lost(const Vec3f& w) const { return std::max(0.0f, 1.0f - albedo_.At(w.z())); }
  // f cos(wi) of the second term for F_ms = 1.
  float MultipleCos(const Vec3f& wo, const Vec3f& wi) const {
    return Lost(wo) * Lost(wi) / std::max(1e-6f, 1.0f - albedo_.Mean()) * wi.z() / kPiF;
  }
  float SingleShare(const Vec3f& wo) const { return 1.0f - Lost(wo); }

  FacetReflectance facets_;
  float alpha_;
  DirectionalAlbedo albedo_;
  Spectrum multiple_;  // F_ms
};

constexpr double kLargestIndex = 20.0;

FacetReflectance ReadFacets(JsonReader& json) {
  const bool has_index = json.Has("n") || json.Has("k");
  if (has_index == json.Has("reflectance")) {
    json.Fail(has_index ? "both a reflectance and an index" : "neither reflectance nor index",
              "either 'reflectance' or 'n' and 'k'");
  }
  if (!has_index) return FacetReflectance(ReadSpectrum(json, "reflectance", 0.0, 1.0, 1.0));
  for (const char* key : {"n", "k"}) {
    if (!json.Has(key)) json.Fail(fmt::format("no key '{}'", key), "'n' and 'k'");
  }
  return {ReadSpectrum(json, "n", 0.01, kLargestIndex, 1.0),
          ReadSpectrum(json, "k", 0.0, kLargestIndex, 0.0)};
}

}  // namespace

std::shared_ptr<const Bsdf> MakeConductor(JsonReader& json) {
  const auto alpha = static_cast<float>(json.Number("roughness", 0.001, 1.0, 0.2));
  return std::make_shared<Conductor>(ReadFacets(json), alpha);
}

}  // namespace retrolux
