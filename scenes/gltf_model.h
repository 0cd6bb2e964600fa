// What we use of a glTF file, checked: every index and every range of bytes is inside its array,
// every number is finite. Units and axes are still glTF's. gltf.h makes meshes and cameras of it,
// gltf_material.h materials.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/camera_model.h"
#include "core/json_reader.h"
#include "scenes/mesh.h"

namespace retrolux {

// How much may be made of a file. Its parts may share their data, of which each gets a copy: a
// small file could ask for any amount.
class GltfMemory {
 public:
  // `held`: the bytes that the file and those beside it hold.
  explicit GltfMemory(size_t held = 0) : size_((size_t{256} << 20) + 8 * held), left_(size_) {}
  // InputError if so much is not left.
  void Take(const std::filesystem::path& file, std::string_view place, size_t bytes);

 private:
  size_t size_;
  size_t left_;
};

struct GltfNode {
  std::string name;
  Eigen::Affine3d parent_from_node = Eigen::Affine3d::Identity();
  std::vector<size_t> children;  // a tree: no node is the child of two
  std::optional<size_t> mesh;
  std::optional<size_t> camera;
};

struct GltfCamera {
  double vertical_fov_rad = 0.0;
  double aspect_ratio = 1.0;          // width / height
  std::optional<CameraModel> opencv;  // intrinsics from extras.opencv; its pose is not set
};

struct GltfPrimitive {
  TriangleMesh mesh;
  std::optional<size_t> material;  // none: it has none
};

// A picture file as it stands in the file or beside it, not decoded.
struct GltfImage {
  std::string name;  // with the extension that says what it is
  std::string bytes;
};

struct GltfModel {
  std::filesystem::path file;
  std::vector<GltfNode> nodes;
  std::vector<size_t> roots;                       // of the default scene
  std::vector<std::vector<GltfPrimitive>> meshes;  // the primitives of each mesh
  std::vector<JsonReader> materials;               // as they stand in the file, unchecked
  std::vector<GltfImage> images;
  std::vector<std::optional<size_t>> textures;     // the image of each; none: in another format
  std::vector<std::optional<GltfCamera>> cameras;  // nothing for an orthographic one
  GltfMemory memory;                               // for each mesh that is made of the model
};

// Refused with an InputError that names file and place: truncated or damaged files, paths out of
// the folder of the file, primitives that are no triangles, sparse or compressed accessors, skins,
// morph targets.
GltfModel ReadGltfModel(const std::filesystem::path& file);

}  // namespace retrolux
