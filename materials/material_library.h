// Named materials as data: materials/data/library.json.
#pragma once

#include "materials/bsdf.h"

namespace retrolux {

// A material with the text that it was made from, so that a scene can be written out again.
struct Material {
  std::string name;
  nlohmann::json spec;
  std::shared_ptr<const Bsdf> bsdf;
};

// From {"type": ..., parameters}.
Material ReadMaterial(const std::string& name, const JsonReader& json);

// A material of the library; InputError that lists the known names.
Material LibraryMaterial(const std::string& name);
std::vector<std::string> LibraryMaterialNames();
// As commands name materials: a file that ends in .json and holds {"type": ..., parameters}, else
// one of the library.
Material NamedOrFile(const std::string& name_or_file);

}  // namespace retrolux
