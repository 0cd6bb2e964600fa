// The parser of glTF files: its own structures, of which nothing has been checked
// (scenes/gltf_model.cpp does).
#pragma once

#include <filesystem>
#include <string>

namespace tinygltf {
class Model;
}

namespace retrolux {

// Reads beside `file` only what lies in its folder or below, and no pictures. `bytes`: of the file,
// a GLB file if `binary`. InputError if it is no glTF.
tinygltf::Model LoadGltf(const std::filesystem::path& file, const std::string& bytes, bool binary);

}  // namespace retrolux
