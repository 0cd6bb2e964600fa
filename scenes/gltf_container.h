// The outer shell of a glTF file, checked before any library touches it.
#pragma once

#include <filesystem>
#include <string>

#include "core/json_reader.h"

namespace retrolux {

struct GltfContainer {
  bool binary;  // a GLB file; else the JSON of a .gltf file
  JsonReader json;
};

// InputError if the bytes are neither, if header and chunks do not fit the size of the file, or if
// the JSON is none or too deep for the library, which recurses.
GltfContainer OpenGltfContainer(const std::filesystem::path& file, const std::string& bytes);

}  // namespace retrolux
