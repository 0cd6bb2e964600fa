#include "materials/bsdf_factory.h"

namespace retrolux {

namespace {

struct Entry {
  const char* type;
  std::shared_ptr<const Bsdf> (*make)(JsonReader& json);
};

constexpr Entry kBsdfs[] = {
    {"absorber", MakeAbsorber},
    {"back_vector", MakeBackVector},
    {"blend", MakeBlend},
    {"coated_diffuse", MakeCoatedDiffuse},
    {"conductor", MakeConductor},
    {"diffuse", MakeDiffuse},
    {"retro_table", MakeRetroTable},
    {"retroreflector", MakeRetroreflector},
    {"rough_diffuse", MakeRoughDiffuse},
};

}  // namespace

std::shared_ptr<const Bsdf> MakeBsdf(JsonReader json) {
  std::vector<std::string> types;
  for (const Entry& entry : kBsdfs) types.emplace_back(entry.type);
  const std::string type = json.Choice("type", types);
  json.Has("comment");
  for (const Entry& entry : kBsdfs) {
    if (type != entry.type) continue;
    std::shared_ptr<const Bsdf> bsdf = entry.make(json);
    json.Finish();
    return bsdf;
  }
  RETROLUX_CHECK(false, "type {} has no maker", type);
  return nullptr;
}

}  // namespace retrolux
