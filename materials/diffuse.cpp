// diffuse: a Lambertian surface, f = reflectance / pi.
//   reflectance   0..1, number or table over wavelength   default 0.5
#include "core/sampling.h"
#include "materials/bsdf_factory.h"

namespace retrolux {

namespace {

class Diffuse : public Bsdf {
 public:
  explicit Diffuse(Spectrum reflectance) : reflectance_(std::move(reflectance)) {}

  BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi, const Spectral& nm) const override {
    if (wo.z() <= 0.0f || wi.z() <= 0.0f) return {};
    return {reflectance_.At(nm) * (wi.z() / kPiF), PdfCosineHemisphere(wi.z())};
  }
  std::optional<BsdfSample> Sample(const Vec3f& wo, float, const Vec2f& u,
                                   const Spectral& nm) const override {
    if (wo.z() <= 0.0f) return std::nullopt;
    const Vec3f wi = SampleCosineHemisphere(u);
    if (wi.z() <= 0.0f) return std::nullopt;
    return BsdfSample{wi, reflectance_.At(nm), PdfCosineHemisphere(wi.z())};
  }

 private:
  Spectrum reflectance_;
};

}  // namespace

std::shared_ptr<const Bsdf> MakeDiffuse(JsonReader& json) {
  return std::make_shared<Diffuse>(ReadSpectrum(json, "reflectance", 0.0, 1.0, 0.5));
}

}  // namespace retrolux
