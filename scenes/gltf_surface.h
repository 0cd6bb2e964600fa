// glTF's metallic-roughness material, as far as we read and write it, and our materials.
//
// glTF (appendix B of the specification, KHR_materials_ior, draft KHR_materials_retroreflection)
// has a dielectric, diffuse under facets of an index, and a metal of the reflectance F0 at normal
// incidence, both with GGX facets of the width alpha = roughness^2, and mixes them:
//   f = (1 - metallic) f_dielectric + metallic f_metal
//   retroreflection:  (1 - r) f(v, l) + r f(v', l),   v' the view mirrored about the normal
// Our parts are a diffuse surface (index 1), coated_diffuse, conductor, blend and back_vector. The
// facets are the same. Ours lose no light, where glTF takes Schlick's curve for the dielectric, its
// value at one direction for what reaches the body, and leaves out the light between the facets of
// metals.
#pragma once

#include "core/json_reader.h"

namespace retrolux {

struct GltfSurface {
  double reflectance = 1.0;      // of body and metal, the same at all wavelengths
  double metallic = 1.0;         // share of the metal
  double roughness = 1.0;        // square root of the GGX width
  double ior = 1.5;              // of the dielectric
  double retroreflection = 0.0;  // share that goes back to where it comes from
};

// Its description as ReadMaterial takes it. An index below 1.01 means diffuse, widths below 0.001
// become 0.001.
nlohmann::json SpecOf(const GltfSurface& surface);

// The surface that comes closest to a material's description: the same again for what SpecOf gives;
// for sheeting albedo and peak of the lobes are kept at normal incidence, its cover and its
// fall-off with the entrance angle are left out. Tables over wavelength become their mean from 400
// to 1100 nm.
GltfSurface NearestGltfSurface(const nlohmann::json& spec);

}  // namespace retrolux
