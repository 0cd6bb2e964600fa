#include "materials/sheet.h"

namespace retrolux {

Sheet ReadSheet(JsonReader& json) {
  Sheet sheet;
  sheet.body = ReadSpectrum(json, "diffuse_reflectance", 0.0, 1.0, 0.27);
  const auto ior = static_cast<float>(json.Number("ior", 1.0, 4.0, 1.5));
  const auto alpha = static_cast<float>(json.Number("cover_roughness", 0.001, 1.0, 0.1));
  if (ior > 1.0f) sheet.cover.emplace(ior, alpha);
  return sheet;
}

}  // namespace retrolux
