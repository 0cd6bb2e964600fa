// Named materials as data: materials/data/library.json.
#pragma once

#include "materials/bsdf.h"
#include "materials/texture.h"

namespace retrolux {

// A material with the text that it was made from, so that a scene can be written out again.
struct Material {
  std::string name;
  nlohmann::json spec;
  std::shared_ptr<const Bsdf> bsdf;
  // The share of `reflectance` that places of the surface have, and the material without any.
  // Both or none. Between them the material is a blend: exact for diffuse and coated_diffuse,
  // whose BSDFs are linear in the reflectance.
  std::shared_ptr<const Texture> texture;
  std::shared_ptr<const Bsdf> dark;
};

// Its description beside its texture under Texture::FileName().
nlohmann::json ExportedSpec(const Material& material);

// From {"type": ..., parameters}. "reflectance_texture": a picture file beside the JSON or below.
Material ReadMaterial(const std::string& name, const JsonReader& json);
// The same, its texture given; `json` has none.
Material TexturedMaterial(const std::string& name, const JsonReader& json,
                          std::shared_ptr<const Texture> texture);

// A material of the library; InputError that lists the known names.
Material LibraryMaterial(const std::string& name);
std::vector<std::string> LibraryMaterialNames();
// As commands name materials: a file that ends in .json and holds {"type": ..., parameters}, else
// one of the library.
Material NamedOrFile(const std::string& name_or_file);

}  // namespace retrolux
