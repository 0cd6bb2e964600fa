// The mesh of a scenario's mask.
#pragma once

#include "scenes/mesh.h"
#include "scenes/scenario.h"

namespace retrolux {

// A mask of masks.h by name, or a mesh file (its path relative to the scenario's), scaled. mm, in
// the mask's frame. InputError.
TriangleMesh MaskMesh(const MaskSpec& spec, const std::filesystem::path& scenario_file);

}  // namespace retrolux
