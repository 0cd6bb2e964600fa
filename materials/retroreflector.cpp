// retroreflector: retro-reflective sheeting, several back-vector microfacet lobes
// (materials/retro_lobe.h) with a weight for the entrance angle, in a sheet (materials/sheet.h).
//   lobes                [{"roughness": width alpha, "albedo": share reflected at normal incidence,
//                          "distribution": "ggx" (default) or "beckmann"}, ...]
//   entrance_weight      table of w over the entrance angle; none: 1 everywhere
//   diffuse_reflectance  of the body under the cover, number or table       default 0.27
//   ior, cover_roughness of the cover; ior 1 means no cover                 default 1.5, 0.1
//
// The lobes are multiplied by sqrt(w(v) w(l)), and by what passes the cover at v and l relative to
// normal incidence (the albedos are measured with the cover on): symmetric, so that the model stays
// reciprocal. R_A = f cos cos: at normal incidence R_A(0) = sum of albedo / (4 pi alpha^2).
#include "materials/bsdf_factory.h"
#include "materials/entrance_weight.h"
#include "materials/retro_lobe.h"
#include "materials/sheet.h"

namespace retrolux {

namespace {

class BackVectorLobes {
 public:
  using Value = RetroLobe::Value;
  BackVectorLobes(std::vector<RetroLobe> lobes, EntranceWeight weight,
                  std::shared_ptr<const Sheet> sheet)
      : lobes_(std::move(lobes)), weight_(std::move(weight)), sheet_(std::move(sheet)) {
    for (const RetroLobe& lobe : lobes_) total_albedo_ += lobe.albedo;
  }

  Value Evaluate(const Vec3f& wo, const Vec3f& wi) const {
    Value sum = {0.0f, 0.0f};
    for (const RetroLobe& lobe : lobes_) {
      if (lobe.albedo <= 0.0f) continue;
      const Value value = lobe.Evaluate(wo, wi);
      sum.f_cos += value.f_cos;
      sum.pdf += lobe.albedo / total_albedo_ * value.pdf;
    }
    sum.f_cos *= std::sqrt(weight_.At(wo.z()) * weight_.At(wi.z())) * sheet_->Passes(wo) *
                 sheet_->Passes(wi);
    return sum;
  }
  Vec3f Sample(const Vec3f& wo, float lobe, const Vec2f& u) const {
    float rest = lobe * total_albedo_;
    size_t i = 0;
    while (i + 1 < lobes_.size() && rest >= lobes_[i].albedo) rest -= lobes_[i++].albedo;
    return lobes_[i].Sample(wo, u);
  }
  float Share(const Vec3f& wo) const { return weight_.At(wo.z()) * total_albedo_; }

 private:
  std::vector<RetroLobe> lobes_;
  EntranceWeight weight_;
  std::shared_ptr<const Sheet> sheet_;
  float total_albedo_ = 0.0f;
};

FacetShape ReadShape(JsonReader& json) {
  if (!json.Has("distribution")) return FacetShape::kGgx;
  return json.Choice("distribution", {"ggx", "beckmann"}) == "ggx" ? FacetShape::kGgx
                                                                   : FacetShape::kBeckmann;
}

std::vector<RetroLobe> ReadLobes(JsonReader json) {
  std::vector<RetroLobe> lobes;
  for (size_t i = 0; i < json.Size(); ++i) {
    JsonReader entry = json.Child(i);
    RetroLobe lobe;
    lobe.facets.alpha = static_cast<float>(entry.Number("roughness", 0.0005, 1.0));
    lobe.albedo = static_cast<float>(entry.Number("albedo", 0.0, 1.0));
    lobe.facets.shape = ReadShape(entry);
    entry.Finish();
    lobes.push_back(lobe);
  }
  return lobes;
}

}  // namespace

std::shared_ptr<const Bsdf> MakeRetroreflector(JsonReader& json) {
  std::vector<RetroLobe> lobes = ReadLobes(json.Child("lobes"));
  EntranceWeight weight;
  if (json.Has("entrance_weight")) {
    weight = EntranceWeight::FromTable(ReadTablePath(json, "entrance_weight"));
  }
  const auto sheet = std::make_shared<const Sheet>(ReadSheet(json));
  // With E the coat's albedo and x = 1 - E: albedo x^2 / x0^2 + 1 - x + x body <= 1 for all angles
  // if albedo / x0 + body <= 1.
  const float passes = 1.0f - sheet->CoverAlbedo(Vec3f::UnitZ());
  float total = sheet->body.Max();
  for (const RetroLobe& lobe : lobes) total += lobe.albedo / passes;
  if (total > 1.0f) {
    json.Fail(
        fmt::format("lobes and body that reflect {:.3f} of the light", total),
        "a sum of albedo / (share that passes the cover) and diffuse_reflectance of at most 1");
  }
  return std::make_shared<Sheeting<BackVectorLobes>>(
      BackVectorLobes(std::move(lobes), std::move(weight), sheet), sheet);
}

}  // namespace retrolux
