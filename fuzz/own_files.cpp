#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "fuzz/target.h"

namespace retrolux::fuzz {

namespace fs = std::filesystem;

namespace {

struct OwnFolder {
  fs::path path = fs::temp_directory_path() / ("retrolux-fuzz-" + std::to_string(::getpid()));
  OwnFolder() { fs::create_directories(path); }
  ~OwnFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;
};

}  // namespace

// Not WriteTextFile: its sync would be most of the work.
fs::path FileOf(const std::string& name, std::string_view bytes) {
  static const OwnFolder folder;
  const fs::path file = folder.path / name;
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  RETROLUX_CHECK(stream.flush(), "{} cannot be written", file.string());
  return file;
}

}  // namespace retrolux::fuzz
