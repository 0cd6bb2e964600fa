#include "materials/material_library.h"

#include <algorithm>

#include "core/atomic_file.h"
#include "core/data_path.h"

namespace retrolux {

namespace {

constexpr const char* kTextureKey = "reflectance_texture";
// What has a reflectance to be textured.
const std::vector<std::string> kTextured = {"coated_diffuse", "conductor", "diffuse",
                                            "rough_diffuse"};

JsonReader Library() {
  static const JsonReader library = JsonReader::FromFile(DataPath("materials/data/library.json"));
  JsonReader json = library;
  json.Schema("retrolux/materials-1");
  JsonReader materials = json.Child("materials");
  json.Finish();
  return materials;
}

}  // namespace

nlohmann::json ExportedSpec(const Material& material) {
  nlohmann::json spec = material.spec;
  if (material.texture) spec[kTextureKey] = material.texture->FileName();
  return spec;
}

Material ReadMaterial(const std::string& name, const JsonReader& json) {
  JsonReader keys = json;
  if (!keys.Has(kTextureKey)) return {name, json.Raw(), MakeBsdf(json), nullptr, nullptr};
  const std::filesystem::path file = keys.FileBelow(kTextureKey);
  return TexturedMaterial(name, json, std::make_shared<Texture>(file, ReadTextFile(file)));
}

Material TexturedMaterial(const std::string& name, const JsonReader& json,
                          std::shared_ptr<const Texture> texture) {
  JsonReader keys = json;
  const std::string type = keys.String("type");
  if (std::find(kTextured.begin(), kTextured.end(), type) == kTextured.end()) {
    keys.Child("type").Fail(fmt::format("a texture on '{}'", type),
                            fmt::format("one of {}", JoinNames(kTextured)));
  }
  nlohmann::json dark = json.Raw();
  dark.erase(kTextureKey);
  dark["reflectance"] = 0.0;
  return {name, json.Raw(), MakeBsdf(json), std::move(texture),
          MakeBsdf(JsonReader::FromText(dark.dump(), json.File()))};
}

Material LibraryMaterial(const std::string& name) {
  JsonReader library = Library();
  if (!library.Has(name)) {
    throw InputError(fmt::format("material '{}' is not in the library; expected one of {}", name,
                                 JoinNames(LibraryMaterialNames())));
  }
  return ReadMaterial(name, library.Child(name));
}

std::vector<std::string> LibraryMaterialNames() {
  return Library().Keys();
}

Material NamedOrFile(const std::string& name_or_file) {
  const std::filesystem::path file = name_or_file;
  if (file.extension() != ".json") return LibraryMaterial(name_or_file);
  return ReadMaterial(file.stem().string(), JsonReader::FromFile(file));
}

}  // namespace retrolux
