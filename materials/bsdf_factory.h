// The makers of the BSDFs, a row each in bsdf_factory.cpp. Each reads its parameters from `json`.
#pragma once

#include "materials/bsdf.h"

namespace retrolux {

std::shared_ptr<const Bsdf> MakeAbsorber(JsonReader& json);
std::shared_ptr<const Bsdf> MakeBackVector(JsonReader& json);
std::shared_ptr<const Bsdf> MakeBlend(JsonReader& json);
std::shared_ptr<const Bsdf> MakeCoatedDiffuse(JsonReader& json);
std::shared_ptr<const Bsdf> MakeConductor(JsonReader& json);
std::shared_ptr<const Bsdf> MakeDiffuse(JsonReader& json);
std::shared_ptr<const Bsdf> MakeRetroTable(JsonReader& json);
std::shared_ptr<const Bsdf> MakeRetroreflector(JsonReader& json);
std::shared_ptr<const Bsdf> MakeRoughDiffuse(JsonReader& json);

}  // namespace retrolux
