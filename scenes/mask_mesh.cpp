#include "scenes/mask_mesh.h"

#include <algorithm>

#include "scenes/masks.h"
#include "scenes/mesh_import.h"

namespace retrolux {

namespace {

TriangleMesh MeshFile(const MaskSpec& spec, const std::filesystem::path& scenario_file) {
  const std::filesystem::path file = scenario_file.parent_path() / spec.mesh;
  // glTF says its unit itself.
  return ImportMesh(file, IsGltf(file) ? LengthUnit::kMetre : ParseLengthUnit(spec.unit));
}

}  // namespace

TriangleMesh MaskMesh(const MaskSpec& spec, const std::filesystem::path& scenario_file) {
  const std::vector<std::string> names = MaskNames();
  FaceShape face;
  face.relief = spec.relief;
  TriangleMesh mesh;
  if (spec.mesh == "face") {
    mesh = FaceMask(face);
  } else if (std::find(names.begin(), names.end(), spec.mesh) != names.end()) {
    mesh = MakeMask(spec.mesh);
  } else {
    mesh = MeshFile(spec, scenario_file);
  }
  for (Vec3f& position : mesh.positions) position *= static_cast<float>(spec.scale);
  return mesh;
}

}  // namespace retrolux
