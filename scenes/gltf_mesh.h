// The meshes of a glTF file: every index and every range of bytes is checked.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/gltf_model.h"

namespace tinygltf {
class Model;
}

namespace retrolux {

// `index` as one into `size` elements. InputError if it is none.
size_t CheckedGltfIndex(const std::filesystem::path& file, std::string_view place, int index,
                        size_t size);

// The bytes of a buffer view, which live as long as the model. InputError if they are not there.
std::span<const unsigned char> GltfViewBytes(const std::filesystem::path& file,
                                             const tinygltf::Model& model, const std::string& place,
                                             int index);

// The primitives of one of the model's meshes. InputError as ReadGltfModel.
std::vector<GltfPrimitive> ReadGltfMesh(const std::filesystem::path& file,
                                        const tinygltf::Model& model, size_t index,
                                        GltfMemory& memory);

}  // namespace retrolux
