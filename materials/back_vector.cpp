// back_vector: another surface made retro-reflective, its glints sent back to where light comes
// from.
//   of   description of the other surface
//
// With wo' the view mirrored about the normal, f(wo, wi) = f_of(wo', wi): the minimal
// retroreflective microfacet model as a transformation of any BSDF (Portsmouth, Raab, Belcour, Liu,
// JCGT 15(1), 2026), as glTF's draft KHR_materials_retroreflection and OpenPBR's
// specular_retroreflectivity define it. Reciprocal if `of` is so and does not tell a direction from
// its mirror image (all of ours do not); mirroring maps the hemisphere onto itself, so that as much
// light is reflected.
#include "materials/bsdf_factory.h"

namespace retrolux {

namespace {

class BackVector : public Bsdf {
 public:
  explicit BackVector(std::shared_ptr<const Bsdf> of) : of_(std::move(of)) {}

  BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi, const Spectral& nm) const override {
    return of_->Evaluate(Mirrored(wo), wi, nm);
  }
  std::optional<BsdfSample> Sample(const Vec3f& wo, float lobe, const Vec2f& u,
                                   const Spectral& nm) const override {
    return of_->Sample(Mirrored(wo), lobe, u, nm);
  }

 private:
  static Vec3f Mirrored(const Vec3f& w) { return {-w.x(), -w.y(), w.z()}; }

  std::shared_ptr<const Bsdf> of_;
};

}  // namespace

std::shared_ptr<const Bsdf> MakeBackVector(JsonReader& json) {
  return std::make_shared<BackVector>(MakeBsdf(json.Child("of")));
}

}  // namespace retrolux
