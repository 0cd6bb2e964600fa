#include "scenes/gltf_load.h"

#include <tiny_gltf.h>

#include "core/atomic_file.h"
#include "core/error.h"

namespace retrolux {

namespace fs = std::filesystem;

namespace {

// What the loader may read beside the file: only what lies in its folder or below.
struct FileAccess {
  fs::path folder;
  std::string refused;

  bool Allows(const fs::path& path) {
    const fs::path relative = path.lexically_normal().lexically_relative(folder);
    const bool inside = !relative.empty() && *relative.begin() != "..";
    if (!inside && path.is_absolute()) refused = path.filename().string();
    return inside;
  }
};

bool AllowedFileExists(const std::string& path, void* user) {
  return static_cast<FileAccess*>(user)->Allows(path) && fs::is_regular_file(path);
}

std::string SamePath(const std::string& path, void*) {
  return path;
}

bool ReadAllowedFile(std::vector<unsigned char>* out, std::string* error, const std::string& path,
                     void* user) {
  if (!static_cast<FileAccess*>(user)->Allows(path)) return false;
  try {
    const std::string bytes = ReadTextFile(path);
    out->assign(bytes.begin(), bytes.end());
    return true;
  } catch (const InputError& reason) {
    *error = reason.what();
    return false;
  }
}

// As they are: decoding them is work that a hostile file could multiply, and few are used.
bool KeepImage(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
               const unsigned char* bytes, int size, void*) {
  image->image.assign(bytes, bytes + size);
  return true;
}

std::string FirstLine(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

}  // namespace

tinygltf::Model LoadGltf(const fs::path& file, const std::string& bytes, bool binary) {
  FileAccess access{fs::absolute(file).parent_path().lexically_normal(), ""};
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(KeepImage, nullptr);
  loader.SetFsCallbacks({AllowedFileExists, SamePath, ReadAllowedFile, nullptr, &access});
  tinygltf::Model model;
  std::string error, warning;
  bool good = false;
  try {
    const auto size = static_cast<unsigned int>(bytes.size());
    const std::string folder = access.folder.string();
    good = binary
               ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                             reinterpret_cast<const unsigned char*>(bytes.data()),
                                             size, folder)
               : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, folder);
  } catch (const std::exception& thrown) {  // wrong types and empty arrays get so far
    error = thrown.what();
  }
  if (good) return model;
  if (!access.refused.empty()) {
    throw InputError::At(
        file, "", fmt::format("a path to '{}' that leaves the folder of the file", access.refused),
        "files in that folder");
  }
  throw InputError::At(file, "", fmt::format("cannot be read: {}", FirstLine(error)), "glTF 2.0");
}

}  // namespace retrolux
