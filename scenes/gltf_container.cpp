#include "scenes/gltf_container.h"

#include <cstdint>

#include "core/error.h"

namespace retrolux {

namespace fs = std::filesystem;

namespace {

uint32_t LittleEndian32(const std::string& bytes, size_t offset) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) {
    value |= static_cast<uint32_t>(static_cast<unsigned char>(bytes[offset + i])) << (8 * i);
  }
  return value;
}

// The container: header and chunks lie inside the file. Returns the text of the JSON chunk.
std::string CheckedGlbJson(const fs::path& file, const std::string& bytes) {
  if (bytes.size() < 20) {
    throw InputError::At(file, "header", fmt::format("{} bytes", bytes.size()),
                         "a GLB file of at least 20 bytes");
  }
  if (const uint32_t version = LittleEndian32(bytes, 4); version != 2) {
    throw InputError::At(file, "header", fmt::format("GLB version {}", version), "version 2");
  }
  if (const uint32_t length = LittleEndian32(bytes, 8); length != bytes.size()) {
    throw InputError::At(file, "header", fmt::format("a file of {} bytes", bytes.size()),
                         fmt::format("{} bytes, as its header says", length));
  }
  constexpr uint32_t kJson = 0x4E4F534A;
  std::string json;
  for (size_t offset = 12; offset < bytes.size();) {
    const std::string place = fmt::format("chunk at byte {}", offset);
    const size_t rest = bytes.size() - offset;
    if (rest < 8)
      throw InputError::At(file, place, fmt::format("{} bytes", rest), "a chunk header of 8 bytes");
    const size_t length = LittleEndian32(bytes, offset);
    if (length > rest - 8) {
      throw InputError::At(file, place, fmt::format("a length of {} bytes", length),
                           fmt::format("at most the {} bytes that are left", rest - 8));
    }
    if (offset == 12) {
      if (LittleEndian32(bytes, 16) != kJson)
        throw InputError::At(file, place, "no JSON", "the JSON chunk first");
      json = bytes.substr(20, length);
    }
    offset += 8 + length;
  }
  return json;
}

}  // namespace

GltfContainer OpenGltfContainer(const fs::path& file, const std::string& bytes) {
  const bool glb = bytes.starts_with("glTF");
  if (!glb && file.extension() != ".gltf") {
    throw InputError::At(file, "header", "no \"glTF\" in the first four bytes",
                         "a GLB file, or JSON in a .gltf file");
  }
  if (bytes.size() > UINT32_MAX) {
    throw InputError::At(file, "", fmt::format("a file of {} bytes", bytes.size()),
                         "less than 4 GiB");
  }
  return {glb, JsonReader::FromText(glb ? CheckedGlbJson(file, bytes) : bytes, file)};
}

}  // namespace retrolux
