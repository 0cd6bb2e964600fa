// The outer shell of a glTF file, checked before any library touches it.
#pragma once

#include <filesystem>
#include <string>

namespace retrolux {

struct GltfContainer {
  bool binary;       // a GLB file; else the JSON of a .gltf file
  std::string json;  // its text
};

// InputError if the bytes are neither, if header and chunks do not fit the size of the file, or if
// the JSON is nested absurdly deep.
GltfContainer OpenGltfContainer(const std::filesystem::path& file, const std::string& bytes);

}  // namespace retrolux
