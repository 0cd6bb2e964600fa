// The outer shell of a glTF file, checked before any library touches it.
#pragma once

#include <filesystem>
#include <string>

namespace retrolux {

// Whether the bytes are a GLB file (else they are the JSON of a .gltf file). InputError if they are
// neither, if header and chunks do not fit the size of the file, or if the JSON is nested absurdly
// deep.
bool CheckGltfContainer(const std::filesystem::path& file, const std::string& bytes);

}  // namespace retrolux
