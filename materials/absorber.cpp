// absorber: black, takes all light. No parameters.
#include "materials/bsdf_factory.h"

namespace retrolux {

namespace {

class Absorber : public Bsdf {
 public:
  BsdfValue Evaluate(const Vec3f&, const Vec3f&, const Spectral&) const override { return {}; }
  std::optional<BsdfSample> Sample(const Vec3f&, float, const Vec2f&,
                                   const Spectral&) const override {
    return std::nullopt;
  }
};

}  // namespace

std::shared_ptr<const Bsdf> MakeAbsorber(JsonReader&) {
  return std::make_shared<Absorber>();
}

}  // namespace retrolux
