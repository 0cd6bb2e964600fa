// Meshes and clouds of points. First byte: p PLY, o OBJ, s STL, x text.
#include "fuzz/target.h"
#include "scenes/mesh_check.h"
#include "scenes/mesh_import.h"

namespace retrolux::fuzz {

namespace {

const char* NameOf(char tag) {
  switch (tag) {
    case 'p':
      return "a.ply";
    case 'o':
      return "a.obj";
    case 's':
      return "a.stl";
    default:
      return "a.xyz";
  }
}

}  // namespace

void FuzzOne(std::string_view input) {
  const Tagged tagged = TaggedInput(input);
  const std::filesystem::path file = FileOf(NameOf(tagged.tag), tagged.bytes);
  Try([&] { CheckMesh(ImportMesh(file, LengthUnit::kMillimetre)); });
  Try([&] { ReadPointCloud(file, LengthUnit::kMetre); });
}

}  // namespace retrolux::fuzz
