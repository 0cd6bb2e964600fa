#include "scenes/gltf_load.h"

#include <tiny_gltf.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/file_below.h"

namespace retrolux {

namespace fs = std::filesystem;

namespace {

// What the loader may read beside the file (core/file_below.h), and how much of it: the same file
// may be named any number of times.
struct FileAccess {
  fs::path folder;
  std::string objection;
  size_t bytes_left = size_t{1} << 30;

  bool Allows(const fs::path& path) {
    if (!path.is_absolute()) return false;  // the loader tries the working folder, too
    std::error_code error;
    const auto found = ObjectionToFile(folder, path.lexically_relative(folder));
    if (found && fs::exists(path, error)) objection = *found;
    return !found;
  }
  bool Takes(size_t bytes) {
    const bool fits = bytes <= bytes_left;
    if (fits) bytes_left -= bytes;
    return fits;
  }
};

bool AllowedFileExists(const std::string& path, void* user) {
  return static_cast<FileAccess*>(user)->Allows(path);
}

std::string SamePath(const std::string& path, void*) {
  return path;
}

bool ReadAllowedFile(std::vector<unsigned char>* out, std::string* error, const std::string& path,
                     void* user) {
  auto& access = *static_cast<FileAccess*>(user);
  if (!access.Allows(path)) return false;
  std::error_code ignored;
  if (!access.Takes(fs::file_size(path, ignored))) {
    *error = "more than 1 GiB in files beside it";
    return false;
  }
  try {
    const std::string bytes = ReadTextFile(path);
    out->assign(bytes.begin(), bytes.end());
    return true;
  } catch (const InputError& reason) {
    *error = reason.what();
    return false;
  }
}

// As they are: decoding them is work that a hostile file could multiply, and few are used. Those in
// a buffer stay there: the loader has not checked that their bytes are.
bool KeepImage(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
               const unsigned char* bytes, int size, void*) {
  if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
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
  if (!access.objection.empty())
    throw InputError::At(file, "", access.objection, "files in its folder or below");
  throw InputError::At(file, "", fmt::format("cannot be read: {}", FirstLine(error)), "glTF 2.0");
}

}  // namespace retrolux
