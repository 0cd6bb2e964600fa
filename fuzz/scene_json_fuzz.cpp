// scene.json beside a mesh, a glTF file with a material of its own, a marker set and a picture.
#include "core/atomic_file.h"
#include "fuzz/target.h"
#include "scenes/scene_json.h"

namespace retrolux::fuzz {

namespace {

bool CopyNeighbours() {
  for (const auto& entry : std::filesystem::directory_iterator(RETROLUX_FUZZ_DATA "/beside_scene"))
    FileOf(entry.path().filename().string(), ReadTextFile(entry.path()));
  return true;
}

}  // namespace

void FuzzOne(std::string_view input) {
  [[maybe_unused]] static const bool copied = CopyNeighbours();
  Try([&] { ReadSceneFile(FileOf("scene.json", input)); });
}

}  // namespace retrolux::fuzz
