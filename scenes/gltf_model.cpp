#include "scenes/gltf_model.h"

#include <tiny_gltf.h>

#include <cmath>

#include "core/atomic_file.h"
#include "core/error.h"
#include "scenes/gltf_container.h"
#include "scenes/gltf_load.h"
#include "scenes/gltf_mesh.h"

namespace retrolux {

namespace fs = std::filesystem;

namespace {

constexpr size_t kMaxTreeDepth = 64;

// Makes a GltfModel of the loader's, and believes nothing.
class Converter {
 public:
  Converter(const fs::path& file, const tinygltf::Model& model)
      : file_(file), model_(model), memory_(BytesHeld(model)) {}

  GltfModel Convert() {
    CheckVersion();
    GltfModel result;
    result.file = file_;
    result.memory = memory_;
    for (size_t i = 0; i < model_.meshes.size(); ++i)
      result.meshes.push_back(ReadGltfMesh(file_, model_, i, memory_));
    for (const tinygltf::Camera& camera : model_.cameras)
      result.cameras.push_back(ConvertCamera(camera));
    for (size_t i = 0; i < model_.images.size(); ++i) result.images.push_back(ConvertImage(i));
    for (const tinygltf::Texture& texture : model_.textures) {
      result.textures.push_back(
          texture.source < 0
              ? std::nullopt
              : std::optional(Index("texture source", texture.source, model_.images.size())));
    }
    for (size_t i = 0; i < model_.nodes.size(); ++i) result.nodes.push_back(ConvertNode(i));
    result.roots = CheckedRoots(result.nodes);
    return result;
  }

 private:
  [[noreturn]] void Fail(std::string_view place, std::string_view found,
                         std::string_view expected) const {
    throw InputError::At(file_, place, found, expected);
  }

  size_t Index(std::string_view place, int index, size_t size) const {
    return CheckedGltfIndex(file_, place, index, size);
  }

  static size_t BytesHeld(const tinygltf::Model& model) {
    size_t bytes = 0;
    for (const tinygltf::Buffer& buffer : model.buffers) bytes += buffer.data.size();
    return bytes;
  }

  GltfImage ConvertImage(size_t index) {
    const tinygltf::Image& image = model_.images[index];
    const std::string place = fmt::format("image {}", index);
    std::span<const unsigned char> bytes = image.image;
    if (image.bufferView >= 0) bytes = GltfViewBytes(file_, model_, place, image.bufferView);
    memory_.Take(file_, place, bytes.size());
    const fs::path from = image.uri.starts_with("data:") ? "" : image.uri;
    const std::string extension = from.has_extension()             ? from.extension().string()
                                  : image.mimeType == "image/jpeg" ? ".jpg"
                                                                   : ".png";
    return {place + extension, {bytes.begin(), bytes.end()}};
  }

  void CheckVersion() const {
    if (!model_.asset.version.starts_with("2.")) {
      Fail("asset", fmt::format("version '{}'", model_.asset.version), "glTF 2.0");
    }
    for (const std::string& name : model_.extensionsRequired) {
      const bool harmless = name.starts_with("KHR_materials_") ||
                            name.starts_with("KHR_texture_") || name.starts_with("KHR_lights_");
      if (!harmless)
        Fail("extensionsRequired", fmt::format("'{}'", name),
             "meshes without extensions or compression");
    }
  }

  // Nothing, or exactly `count` finite numbers.
  bool Given(const std::vector<double>& numbers, size_t count, const std::string& place) const {
    if (numbers.empty()) return false;
    bool finite = true;
    for (const double number : numbers) finite &= std::isfinite(number);
    if (numbers.size() != count || !finite) {
      Fail(place,
           fmt::format("{} numbers{}", numbers.size(), finite ? "" : " that are not all finite"),
           fmt::format("{} finite numbers", count));
    }
    return true;
  }

  Eigen::Affine3d TransformOf(const tinygltf::Node& node, const std::string& place) const {
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
    if (Given(node.matrix, 16, place + " matrix")) {
      transform.matrix() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());
      if (transform.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
        Fail(place + " matrix", "a last row that is not 0, 0, 0, 1", "an affine transform");
      }
      return transform;
    }
    if (Given(node.translation, 3, place + " translation")) {
      transform.translation() = Eigen::Map<const Vec3d>(node.translation.data());
    }
    if (Given(node.rotation, 4, place + " rotation")) {
      const Eigen::Quaterniond q(node.rotation[3], node.rotation[0], node.rotation[1],
                                 node.rotation[2]);
      if (!(std::abs(q.norm() - 1.0) < 1e-2))
        Fail(place + " rotation", fmt::format("a quaternion of length {:.3g}", q.norm()),
             "length 1");
      transform.linear() = q.normalized().toRotationMatrix();
    }
    if (Given(node.scale, 3, place + " scale")) {
      transform.linear() =
          transform.linear() * Eigen::Map<const Vec3d>(node.scale.data()).asDiagonal();
    }
    return transform;
  }

  GltfNode ConvertNode(size_t index) const {
    const tinygltf::Node& given = model_.nodes[index];
    GltfNode node;
    node.name = given.name.empty() ? fmt::format("#{}", index) : given.name;
    const std::string place = fmt::format("node '{}'", node.name);
    node.parent_from_node = TransformOf(given, place);
    if (given.mesh != -1) node.mesh = Index(place + " mesh", given.mesh, model_.meshes.size());
    if (given.camera != -1)
      node.camera = Index(place + " camera", given.camera, model_.cameras.size());
    if (given.mesh != -1 && given.skin != -1) Fail(place, "a skin", "a mesh that is not animated");
    for (const int child : given.children) {
      node.children.push_back(Index(place + " children", child, model_.nodes.size()));
    }
    return node;
  }

  std::vector<size_t> CheckedRoots(const std::vector<GltfNode>& nodes) const {
    std::vector<size_t> roots;
    std::vector<bool> seen(nodes.size(), false);
    if (!model_.scenes.empty()) {
      const int scene = model_.defaultScene == -1 ? 0 : model_.defaultScene;
      for (const int root : model_.scenes[Index("scene", scene, model_.scenes.size())].nodes) {
        roots.push_back(Index("scene nodes", root, nodes.size()));
      }
    } else {
      std::vector<bool> is_child(nodes.size(), false);
      for (const GltfNode& node : nodes) {
        for (const size_t child : node.children) is_child[child] = true;
      }
      for (size_t i = 0; i < nodes.size(); ++i) {
        if (!is_child[i]) roots.push_back(i);
      }
    }
    for (const size_t root : roots) CheckTree(nodes, root, 0, seen);
    return roots;
  }

  void CheckTree(const std::vector<GltfNode>& nodes, size_t index, size_t depth,
                 std::vector<bool>& seen) const {
    const std::string place = fmt::format("node '{}'", nodes[index].name);
    if (seen[index]) Fail(place, "a node that is reached twice", "nodes that form a tree");
    if (depth > kMaxTreeDepth)
      Fail(place, "a node that lies too deep", fmt::format("at most {} levels", kMaxTreeDepth));
    seen[index] = true;
    for (const size_t child : nodes[index].children) CheckTree(nodes, child, depth + 1, seen);
  }

  // {"K": [9 numbers, row by row], "width": .., "height": .., "distortion": [5 numbers]} as
  // WriteGlb writes it.
  static std::optional<CameraModel> OpenCvOf(const tinygltf::Value& extras) {
    if (!extras.IsObject() || !extras.Has("opencv")) return std::nullopt;
    const tinygltf::Value& opencv = extras.Get("opencv");
    if (!opencv.IsObject() || !opencv.Has("K") || !opencv.Has("width") || !opencv.Has("height"))
      return std::nullopt;
    const tinygltf::Value& k = opencv.Get("K");
    if (!k.IsArray() || k.ArrayLen() != 9) return std::nullopt;
    CameraModel camera;
    camera.width = opencv.Get("width").GetNumberAsInt();
    camera.height = opencv.Get("height").GetNumberAsInt();
    camera.fx = k.Get(0).GetNumberAsDouble();
    camera.cx = k.Get(2).GetNumberAsDouble();
    camera.fy = k.Get(4).GetNumberAsDouble();
    camera.cy = k.Get(5).GetNumberAsDouble();
    if (opencv.Has("distortion") && opencv.Get("distortion").ArrayLen() == 5) {
      const auto at = [&](int i) { return opencv.Get("distortion").Get(i).GetNumberAsDouble(); };
      camera.distortion = {at(0), at(1), at(2), at(3), at(4)};
    }
    if (camera.width < 1 || camera.height < 1 || !(camera.fx > 0.0) || !(camera.fy > 0.0))
      return std::nullopt;
    return camera;
  }

  std::optional<GltfCamera> ConvertCamera(const tinygltf::Camera& camera) const {
    if (camera.type != "perspective") return std::nullopt;
    const double fov_rad = camera.perspective.yfov;
    const double aspect =
        camera.perspective.aspectRatio > 0.0 ? camera.perspective.aspectRatio : 4.0 / 3.0;
    if (!(fov_rad > 0.0) || !(fov_rad < kPi) || !(aspect > 0.01) || !(aspect < 100.0)) {
      Fail(fmt::format("camera '{}'", camera.name),
           fmt::format("yfov {:.3g}, aspect ratio {:.3g}", fov_rad, aspect),
           "an angle between 0 and pi and a ratio from 0.01 to 100");
    }
    return GltfCamera{fov_rad, aspect, OpenCvOf(camera.extras)};
  }

  const fs::path& file_;
  const tinygltf::Model& model_;
  GltfMemory memory_;
};

std::vector<JsonReader> MaterialsOf(JsonReader json) {
  std::vector<JsonReader> materials;
  if (!json.Has("materials")) return materials;
  const JsonReader array = json.Child("materials");
  for (size_t i = 0; i < array.Size(); ++i) materials.push_back(array.Child(i));
  return materials;
}

}  // namespace

GltfModel ReadGltfModel(const fs::path& file) {
  const std::string bytes = ReadTextFile(file);
  const GltfContainer container = OpenGltfContainer(file, bytes);
  const tinygltf::Model model = LoadGltf(file, bytes, container.binary);
  GltfModel result = Converter(file, model).Convert();
  result.materials = MaterialsOf(container.json);
  return result;
}

}  // namespace retrolux
