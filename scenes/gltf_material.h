// Materials of glTF files as materials of ours.
#pragma once

#include <span>
#include <string>

#include "materials/material_library.h"
#include "scenes/gltf_model.h"
#include "scenes/gltf_surface.h"

namespace retrolux {

// What a material of a glTF file says, of its colour the luminance (Rec. 709). InputError that
// names the place in the file for numbers out of their range, for textures but that of the base
// colour, and for what would make another picture without anybody noticing it: alpha modes but
// OPAQUE, transmission, a clear coat, another strength of the glints. All else is passed over:
// emission, normal and occlusion textures, sheen, iridescence, anisotropy, tints of glints.
GltfSurface ReadGltfSurface(JsonReader material);

// The material that all triangles of these nodes and of those below them share, under its name in
// the file, `#` and its number if it has none. What WriteGlb leaves in extras.retrolux, a
// description as ReadMaterial takes it, comes before all else. InputError that names `place` if
// there is no material, or not one for all.
Material SharedGltfMaterial(const GltfModel& model, std::span<const size_t> nodes,
                            const std::string& place);

}  // namespace retrolux
