// cameras.yml.
#include "classifier/camera_file.h"
#include "fuzz/target.h"

namespace retrolux::fuzz {

void FuzzOne(std::string_view input) {
  Try([&] { ReadCameras(FileOf("cameras.yml", input)); });
}

}  // namespace retrolux::fuzz
