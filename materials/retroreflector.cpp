// retroreflector: retro-reflective sheeting, the minimal retroreflective microfacet model (back
// vector; Portsmouth, Raab, Belcour, Liu, JCGT 15(1), 2026) with several GGX lobes, a weight for
// the entrance angle, and the cover: a rough dielectric coat over a diffuse body
// (materials/coat.h).
//   lobes                [{"roughness": GGX width, "albedo": share reflected at normal incidence},
//   ...] entrance_weight      table of w over the entrance angle; none: 1 everywhere
//   diffuse_reflectance  of the body under the cover, number or table       default 0.27
//   ior, cover_roughness of the cover; ior 1 means no cover                 default 1.5, 0.1
//
// With v' = (-v_x, -v_y, v_z), the view mirrored about the normal, a lobe is
//   f = albedo sqrt(w(v) w(l)) D(b) G2(v', l) / (4 cos cos),   b = normalise(v' + l),
// times what passes the cover at v and l relative to normal incidence (the albedos are measured
// with the cover on). Exchanging v and l mirrors b about the normal, which changes neither D nor
// G2; the weight is symmetric: the model is reciprocal. R_A = f cos cos: at normal incidence R_A(0)
// = sum of albedo / (4 pi alpha^2).
#include "core/sampling.h"
#include "materials/bsdf_factory.h"
#include "materials/coat.h"
#include "materials/entrance_weight.h"

namespace retrolux {

namespace {

struct Lobe {
  float alpha, albedo;
};

Vec3f MirroredAboutNormal(const Vec3f& w) {
  return {-w.x(), -w.y(), w.z()};
}

class Retroreflector : public Bsdf {
 public:
  Retroreflector(std::vector<Lobe> lobes, EntranceWeight weight, Spectrum body,
                 std::optional<Coat> cover)
      : lobes_(std::move(lobes)),
        weight_(std::move(weight)),
        body_(std::move(body)),
        body_share_(body_.Max()),
        cover_(std::move(cover)) {}

  BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi, const Spectral& nm) const override {
    if (wo.z() <= 0.0f || wi.z() <= 0.0f) return {};
    const Vec3f mirrored = MirroredAboutNormal(wo);
    const Vec3f b = (mirrored + wi).normalized();
    const Shares shares = SharesAt(wo);
    float retro = 0.0f;
    float pdf = shares.body * PdfCosineHemisphere(wi.z());
    for (const Lobe& lobe : lobes_) {
      const float facets = lobe.albedo * ggx::Distribution(b, lobe.alpha) / (4.0f * wo.z());
      const float lambda = ggx::Lambda(wo, lobe.alpha);
      retro += facets / (1.0f + lambda + ggx::Lambda(wi, lobe.alpha));
      pdf += shares.retro * facets / (1.0f + lambda);
    }
    retro *= std::sqrt(weight_.At(wo.z()) * weight_.At(wi.z()));
    BsdfValue value;
    if (cover_) {
      const Coat::Specular specular = cover_->EvaluateSpecular(wo, wi);
      pdf += shares.cover * specular.pdf;
      retro *= cover_->Passes(wo) * cover_->Passes(wi);
      value.f_cos = retro + specular.f_cos + body_.At(nm) * cover_->BodyCos(wo, wi);
    } else {
      value.f_cos = retro + body_.At(nm) * (wi.z() / kPiF);
    }
    value.pdf = pdf / shares.Sum(lobes_);
    return value;
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
  // Unnormalised probabilities of the parts; each lobe has retro * its albedo.
  struct Shares {
    float retro, cover, body;
    float Sum(const std::vector<Lobe>& lobes) const {
      float sum = cover + body;
      for (const Lobe& lobe : lobes) sum += retro * lobe.albedo;
      return sum;
    }
  };
  Shares SharesAt(const Vec3f& wo) const {
    return {weight_.At(wo.z()), cover_ ? cover_->Albedo(wo) : 0.0f, body_share_ + 1e-6f};
  }

  Vec3f Draw(const Vec3f& wo, float lobe, const Vec2f& u) const {
    const Shares shares = SharesAt(wo);
    float rest = lobe * shares.Sum(lobes_);
    const Vec3f mirrored = MirroredAboutNormal(wo);
    for (const Lobe& retro : lobes_) {
      rest -= shares.retro * retro.albedo;
      if (rest < 0.0f)
        return ggx::Reflect(mirrored, ggx::SampleVisibleNormal(mirrored, retro.alpha, u));
    }
    if (cover_ && rest < shares.cover) return cover_->SampleSpecular(wo, u);
    return SampleCosineHemisphere(u);
  }

  std::vector<Lobe> lobes_;
  EntranceWeight weight_;
  Spectrum body_;
  float body_share_;
  std::optional<Coat> cover_;
};

std::vector<Lobe> ReadLobes(JsonReader json) {
  std::vector<Lobe> lobes;
  for (size_t i = 0; i < json.Size(); ++i) {
    JsonReader entry = json.Child(i);
    const auto alpha = static_cast<float>(entry.Number("roughness", 0.0005, 1.0));
    const auto albedo = static_cast<float>(entry.Number("albedo", 0.0, 1.0));
    entry.Finish();
    lobes.push_back({alpha, albedo});
  }
  return lobes;
}

}  // namespace

std::shared_ptr<const Bsdf> MakeRetroreflector(JsonReader& json) {
  std::vector<Lobe> lobes = ReadLobes(json.Child("lobes"));
  EntranceWeight weight;
  if (json.Has("entrance_weight")) {
    weight = EntranceWeight::FromTable(ReadTablePath(json, "entrance_weight"));
  }
  Spectrum body = ReadSpectrum(json, "diffuse_reflectance", 0.0, 1.0, 0.27);
  const auto ior = static_cast<float>(json.Number("ior", 1.0, 4.0, 1.5));
  const auto alpha = static_cast<float>(json.Number("cover_roughness", 0.001, 1.0, 0.1));
  std::optional<Coat> cover;
  if (ior > 1.0f) cover.emplace(ior, alpha);
  // With E the coat's albedo and x = 1 - E: albedo x^2 / x0^2 + 1 - x + x body <= 1 for all angles
  // if albedo / x0 + body <= 1.
  const float passes = cover ? 1.0f - cover->Albedo(Vec3f::UnitZ()) : 1.0f;
  float total = body.Max();
  for (const Lobe& lobe : lobes) total += lobe.albedo / passes;
  if (total > 1.0f) {
    json.Fail(
        fmt::format("lobes and body that reflect {:.3f} of the light", total),
        "a sum of albedo / (share that passes the cover) and diffuse_reflectance of at most 1");
  }
  return std::make_shared<Retroreflector>(std::move(lobes), std::move(weight), std::move(body),
                                          std::move(cover));
}

}  // namespace retrolux
