#include "materials/material_library.h"

#include "core/data_path.h"

namespace retrolux {

namespace {

JsonReader Library() {
  static const JsonReader library = JsonReader::FromFile(DataPath("materials/data/library.json"));
  JsonReader json = library;
  json.Schema("retrolux/materials-1");
  JsonReader materials = json.Child("materials");
  json.Finish();
  return materials;
}

}  // namespace

Material ReadMaterial(const std::string& name, const JsonReader& json) {
  return {name, json.Raw(), MakeBsdf(json)};
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
