// blend: a surface of two materials in pieces too small to be told apart, or of one that wears off.
//   one, zero   descriptions of the two
//   share       of `one`, 0..1
#include "materials/blend.h"

#include <algorithm>

#include "materials/bsdf_factory.h"

namespace retrolux {

BsdfValue BsdfBlend::Evaluate(const Vec3f& wo, const Vec3f& wi, const Spectral& nm) const {
  if (zero == nullptr || share >= 1.0f) return one->Evaluate(wo, wi, nm);
  if (share <= 0.0f) return zero->Evaluate(wo, wi, nm);
  const BsdfValue a = one->Evaluate(wo, wi, nm);
  const BsdfValue b = zero->Evaluate(wo, wi, nm);
  return {share * a.f_cos + (1.0f - share) * b.f_cos, share * a.pdf + (1.0f - share) * b.pdf};
}

std::optional<BsdfSample> BsdfBlend::Sample(const Vec3f& wo, float lobe, const Vec2f& u,
                                            const Spectral& nm) const {
  if (zero == nullptr || share >= 1.0f) return one->Sample(wo, lobe, u, nm);
  if (share <= 0.0f) return zero->Sample(wo, lobe, u, nm);
  // What is left of `lobe` is uniform again; rounding must not make it 1.
  const bool first = lobe < share;
  const float rest =
      std::min(first ? lobe / share : (lobe - share) / (1.0f - share), 0x1.fffffep-1f);
  const std::optional<BsdfSample> drawn = (first ? one : zero)->Sample(wo, rest, u, nm);
  if (!drawn) return std::nullopt;
  const BsdfValue value = Evaluate(wo, drawn->wi, nm);
  if (!(value.pdf > 0.0f)) return std::nullopt;
  return BsdfSample{drawn->wi, value.f_cos / value.pdf, value.pdf};
}

namespace {

class Blend : public Bsdf {
 public:
  Blend(std::shared_ptr<const Bsdf> one, std::shared_ptr<const Bsdf> zero, float share)
      : one_(std::move(one)), zero_(std::move(zero)), blend_{one_.get(), zero_.get(), share} {}
  Blend(const Blend&) = delete;
  Blend& operator=(const Blend&) = delete;

  BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi, const Spectral& nm) const override {
    return blend_.Evaluate(wo, wi, nm);
  }
  std::optional<BsdfSample> Sample(const Vec3f& wo, float lobe, const Vec2f& u,
                                   const Spectral& nm) const override {
    return blend_.Sample(wo, lobe, u, nm);
  }

 private:
  std::shared_ptr<const Bsdf> one_, zero_;
  BsdfBlend blend_;
};

}  // namespace

std::shared_ptr<const Bsdf> MakeBlend(JsonReader& json) {
  const auto share = static_cast<float>(json.Number("share", 0.0, 1.0));
  return std::make_shared<Blend>(MakeBsdf(json.Child("one")), MakeBsdf(json.Child("zero")), share);
}

}  // namespace retrolux
