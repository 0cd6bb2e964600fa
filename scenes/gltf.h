// Geometry, materials and cameras from and to glTF 2.0 (.glb, .gltf).
//
// glTF is metres, y up, front +z; its cameras look along -z with y up. Our worlds are mm, x or z
// up. The map between them is GltfFromWorld, a proper rotation that only exchanges axes and signs,
// so it is exact:
//   x up:  glTF (X, Y, Z) = (-y, x, z)    the room stands upright and its front is glTF's front
//   z up:  glTF (X, Y, Z) = (x, z, -y)    Blender, which is z up itself, shows our coordinates
//
// Written files keep mm in the accessors and scale the node by 0.001. Read with MeshFrame::kNode,
// such a mesh comes back bit for bit (but for the sign of zeros). MeshFrame::kFile rotates and
// shifts in double and rounds to float once: within half a unit in the last place, 1.3e-4 mm up to
// 4 m from the origin.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/camera_model.h"
#include "materials/material_library.h"
#include "scenes/gltf_model.h"
#include "scenes/mesh.h"
#include "scenes/up_axis.h"

namespace retrolux {

struct Scene;

// x_in_gltf = GltfFromWorld(up) * x_in_world, lengths apart.
Mat3d GltfFromWorld(UpAxis up);

// Which frame the mesh of a node is given in.
enum class MeshFrame {
  kFile,  // of the file: all transforms applied
  kNode,  // of the node: rotation and position of the node and its parents left out, their scale
          // applied
};

class GltfFile {
 public:
  // InputError if the file can't be read, is damaged, or holds what we don't read (see
  // gltf_model.h).
  explicit GltfFile(const std::filesystem::path& file) : model_(ReadGltfModel(file)) {}

  // All meshes of the file as one, mm.
  TriangleMesh Mesh(UpAxis up) const;
  // The meshes of the node of that name and of its children. InputError that lists the nodes with
  // meshes.
  TriangleMesh NodeMesh(const std::string& node, MeshFrame frame, UpAxis up) const;
  // The material of Mesh or NodeMesh, under its name in the file. InputError if they have none, or
  // several (see gltf_material.h).
  Material MeshMaterial() const;
  Material NodeMaterial(const std::string& node) const;
  // The perspective cameras. A file that we wrote gives the camera matrix back exactly; for others
  // pixels are square and the picture is 640 wide.
  std::vector<CameraModel> Cameras(UpAxis up) const;

 private:
  GltfModel model_;
};

// One .glb: a node for each object (mesh and material), camera and marker. Materials are written as
// glTF has them (gltf_surface.h), and whole in extras.retrolux.
void WriteGlb(const Scene& scene, UpAxis up, const std::filesystem::path& file);

}  // namespace retrolux
