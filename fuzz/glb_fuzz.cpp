// glTF, binary or as text: all that scenes and masks ask a file for. Seeds call their node 'n'.
#include "fuzz/target.h"
#include "scenes/gltf.h"

namespace retrolux::fuzz {

void FuzzOne(std::string_view input) {
  Try([&] {
    const GltfFile gltf(FileOf("a.gltf", input));
    Try([&] { gltf.Mesh(UpAxis::kZ); });
    Try([&] { gltf.NodeMesh("n", MeshFrame::kNode, UpAxis::kX); });
    Try([&] { gltf.Cameras(UpAxis::kX); });
    Try([&] { gltf.MeshMaterial(); });
    Try([&] { gltf.NodeMaterial("n"); });
  });
}

}  // namespace retrolux::fuzz
