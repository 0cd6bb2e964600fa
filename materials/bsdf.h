// How a surface scatters light. To add a BSDF: write materials/NAME.cpp with the class in an
// anonymous namespace and MakeNAME; add its row to the table in bsdf_factory.cpp. The tests of
// every BSDF (sampling against density, reciprocity, energy) run over materials/data/library.json
// by themselves.
#pragma once

#include <memory>
#include <optional>

#include "materials/spectrum.h"

namespace retrolux {

struct BsdfValue {
  Spectral f_cos = Spectral::Zero();  // BSDF times |cos(wi)|, 1/sr
  float pdf = 0.0f;  // of Bsdf::Sample to choose wi, 1/sr; does not depend on the wavelengths
};

struct BsdfSample {
  Vec3f wi;         // unit, local frame, points away from the surface
  Spectral weight;  // f |cos(wi)| / pdf
  float pdf;        // 1/sr
};

// Scattering at an opaque surface. All directions are unit vectors in the local frame (z = shading
// normal) and point away from the surface; `wo` to where the light goes, `wi` to where it comes
// from. Zero where either lies below the surface. `nm` holds the wavelengths of the path.
class Bsdf {
 public:
  virtual ~Bsdf() = default;

  // Value and density together: they share most of their work.
  virtual BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi, const Spectral& nm) const = 0;
  // Nothing if no direction could be drawn. `lobe` and `u` are uniform on [0, 1).
  virtual std::optional<BsdfSample> Sample(const Vec3f& wo, float lobe, const Vec2f& u,
                                           const Spectral& nm) const = 0;
};

// From {"type": NAME, parameters...}; unknown types list the known ones. Lengths of tables etc. are
// checked; errors name file and place.
std::shared_ptr<const Bsdf> MakeBsdf(JsonReader json);

}  // namespace retrolux
