#include "scenes/gltf_model.h"

#include <tiny_gltf.h>

#include <cmath>
#include <cstring>

#include "core/atomic_file.h"
#include "core/error.h"
#include "scenes/gltf_container.h"

namespace retrolux {

namespace fs = std::filesystem;

namespace {

constexpr size_t kMaxTreeDepth = 64;

// What the loader may read beside the file: only what lies in its folder or below.
struct FileAccess {
  fs::path folder;
  std::string refused;

  bool Allows(const fs::path& path) {
    const fs::path relative = path.lexically_normal().lexically_relative(folder);
    const bool inside = !relative.empty() && *relative.begin() != "..";
    if (!inside && path.is_absolute()) refused = path.filename().string();
    return inside;
  }
};

bool AllowedFileExists(const std::string& path, void* user) {
  return static_cast<FileAccess*>(user)->Allows(path) && fs::is_regular_file(path);
}

std::string SamePath(const std::string& path, void*) {
  return path;
}

bool ReadAllowedFile(std::vector<unsigned char>* out, std::string* error, const std::string& path,
                     void* user) {
  if (!static_cast<FileAccess*>(user)->Allows(path)) return false;
  try {
    const std::string bytes = ReadTextFile(path);
    out->assign(bytes.begin(), bytes.end());
    return true;
  } catch (const InputError& reason) {
    *error = reason.what();
    return false;
  }
}

// Pictures are of no use to us, and decoding them is work that a hostile file could multiply.
bool SkipImage(tinygltf::Image*, const int, std::string*, std::string*, int, int,
               const unsigned char*, int, void*) {
  return true;
}

std::string FirstLine(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

tinygltf::Model Load(const fs::path& file) {
  const std::string bytes = ReadTextFile(file);
  const bool glb = CheckGltfContainer(file, bytes);
  FileAccess access{fs::absolute(file).parent_path().lexically_normal(), ""};
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(SkipImage, nullptr);
  loader.SetFsCallbacks({AllowedFileExists, SamePath, ReadAllowedFile, nullptr, &access});
  tinygltf::Model model;
  std::string error, warning;
  bool good = false;
  try {
    const auto size = static_cast<unsigned int>(bytes.size());
    const std::string folder = access.folder.string();
    good = glb ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                             reinterpret_cast<const unsigned char*>(bytes.data()),
                                             size, folder)
               : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, folder);
  } catch (const std::exception& thrown) {  // wrong types and empty arrays get so far
    error = thrown.what();
  }
  if (good) return model;
  if (!access.refused.empty()) {
    throw InputError::At(
        file, "", fmt::format("a path to '{}' that leaves the folder of the file", access.refused),
        "files in that folder");
  }
  throw InputError::At(file, "", fmt::format("cannot be read: {}", FirstLine(error)), "glTF 2.0");
}

// Makes a GltfModel of the loader's, and believes nothing.
class Converter {
 public:
  Converter(const fs::path& file, const tinygltf::Model& model) : file_(file), model_(model) {}

  GltfModel Convert() {
    CheckVersion();
    GltfModel result;
    result.file = file_;
    for (size_t i = 0; i < model_.meshes.size(); ++i) result.meshes.push_back(ConvertMesh(i));
    for (const tinygltf::Camera& camera : model_.cameras)
      result.cameras.push_back(ConvertCamera(camera));
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
    if (index < 0 || static_cast<size_t>(index) >= size) {
      Fail(place, fmt::format("the index {} into {} elements", index, size),
           "an index of one of them");
    }
    return static_cast<size_t>(index);
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

  // The bytes of an accessor, all of them inside their buffer.
  struct Elements {
    const unsigned char* data;
    size_t count, stride;
    int component;

    template <typename T>
    T At(size_t i, size_t k = 0) const {  // accessors need not be aligned in memory
      T value;
      std::memcpy(&value, data + i * stride + k * sizeof(T), sizeof(T));
      return value;
    }
  };

  Elements ElementsOf(int index, const std::string& place, int type) const {
    const tinygltf::Accessor& accessor =
        model_.accessors[Index(place, index, model_.accessors.size())];
    if (accessor.sparse.isSparse) Fail(place, "a sparse accessor", "a plain one");
    if (accessor.type != type)
      Fail(place, "an accessor of another type", type == TINYGLTF_TYPE_VEC3 ? "VEC3" : "SCALAR");
    const int component_size =
        tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(accessor.componentType));
    if (component_size <= 0)
      Fail(place, fmt::format("component type {}", accessor.componentType), "one of glTF 2.0");
    const size_t element =
        static_cast<size_t>(component_size) * (type == TINYGLTF_TYPE_VEC3 ? 3 : 1);
    const tinygltf::BufferView& view = model_.bufferViews[Index(
        place + " bufferView", accessor.bufferView, model_.bufferViews.size())];
    const tinygltf::Buffer& buffer =
        model_.buffers[Index(place + " buffer", view.buffer, model_.buffers.size())];
    if (view.byteOffset > buffer.data.size() ||
        view.byteLength > buffer.data.size() - view.byteOffset) {
      Fail(place,
           fmt::format("a buffer view of {} bytes from byte {} in a buffer of {} bytes",
                       view.byteLength, view.byteOffset, buffer.data.size()),
           "bytes that are there");
    }
    const size_t stride = view.byteStride == 0 ? element : view.byteStride;
    if (stride < element)
      Fail(place, fmt::format("a stride of {} bytes", stride), fmt::format("at least {}", element));
    if (accessor.count == 0) Fail(place, "an empty accessor", "at least one element");
    const bool first_fits =
        accessor.byteOffset <= view.byteLength && element <= view.byteLength - accessor.byteOffset;
    if (!first_fits ||
        accessor.count - 1 > (view.byteLength - accessor.byteOffset - element) / stride) {
      Fail(place,
           fmt::format("{} elements from byte {} in a buffer view of {} bytes", accessor.count,
                       accessor.byteOffset, view.byteLength),
           "bytes that are there");
    }
    return {buffer.data.data() + view.byteOffset + accessor.byteOffset, accessor.count, stride,
            accessor.componentType};
  }

  std::vector<Vec3f> Vectors(int index, const std::string& place) const {
    const Elements elements = ElementsOf(index, place, TINYGLTF_TYPE_VEC3);
    if (elements.component != TINYGLTF_COMPONENT_TYPE_FLOAT)
      Fail(place, fmt::format("component type {}", elements.component), "5126 (float)");
    std::vector<Vec3f> vectors(elements.count);
    for (size_t i = 0; i < elements.count; ++i) {
      vectors[i] = {elements.At<float>(i, 0), elements.At<float>(i, 1), elements.At<float>(i, 2)};
      if (!vectors[i].allFinite())
        Fail(place, fmt::format("a coordinate of element {} that is not a number", i),
             "finite numbers");
    }
    return vectors;
  }

  std::vector<uint32_t> Indices(int index, const std::string& place) const {
    const Elements elements = ElementsOf(index, place, TINYGLTF_TYPE_SCALAR);
    std::vector<uint32_t> indices(elements.count);
    for (size_t i = 0; i < elements.count; ++i) {
      switch (elements.component) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
          indices[i] = elements.At<uint8_t>(i);
          break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
          indices[i] = elements.At<uint16_t>(i);
          break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
          indices[i] = elements.At<uint32_t>(i);
          break;
        default:
          Fail(place, fmt::format("component type {}", elements.component),
               "unsigned bytes, shorts or ints");
      }
    }
    return indices;
  }

  TriangleMesh ConvertPrimitive(const tinygltf::Primitive& primitive,
                                const std::string& place) const {
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES)
      Fail(place, fmt::format("mode {}", primitive.mode), "4 (triangles)");
    if (!primitive.targets.empty()) Fail(place, "morph targets", "a mesh without");
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end())
      Fail(place, "no POSITION", "an accessor of positions");
    TriangleMesh mesh;
    mesh.positions = Vectors(position->second, place + " POSITION");
    if (const auto normal = primitive.attributes.find("NORMAL");
        normal != primitive.attributes.end()) {
      mesh.normals = Vectors(normal->second, place + " NORMAL");
      if (mesh.normals.size() != mesh.positions.size()) {
        Fail(place + " NORMAL", fmt::format("{} normals", mesh.normals.size()),
             fmt::format("{}, as many as positions", mesh.positions.size()));
      }
    }
    AddTriangles(primitive, place + " indices", mesh);
    return mesh;
  }

  void AddTriangles(const tinygltf::Primitive& primitive, const std::string& place,
                    TriangleMesh& mesh) const {
    const size_t vertices = mesh.positions.size();
    std::vector<uint32_t> indices;
    if (primitive.indices >= 0) {
      indices = Indices(primitive.indices, place);
    } else {
      for (uint32_t i = 0; i < vertices; ++i) indices.push_back(i);
    }
    if (indices.size() % 3 != 0)
      Fail(place, fmt::format("{} indices", indices.size()), "a multiple of three");
    for (size_t i = 0; i < indices.size(); ++i) {
      if (indices[i] >= vertices) {
        Fail(place, fmt::format("index {} at {} with {} vertices", indices[i], i, vertices),
             "vertices that exist");
      }
    }
    for (size_t i = 0; i < indices.size(); i += 3) {
      mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    }
  }

  std::vector<TriangleMesh> ConvertMesh(size_t index) const {
    const tinygltf::Mesh& mesh = model_.meshes[index];
    const std::string name =
        mesh.name.empty() ? fmt::format("mesh {}", index) : fmt::format("mesh '{}'", mesh.name);
    if (mesh.primitives.empty()) Fail(name, "no primitives", "triangles");
    std::vector<TriangleMesh> parts;
    for (size_t i = 0; i < mesh.primitives.size(); ++i) {
      parts.push_back(
          ConvertPrimitive(mesh.primitives[i], fmt::format("{} primitive {}", name, i)));
    }
    return parts;
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
};

}  // namespace

GltfModel ReadGltfModel(const fs::path& file) {
  const tinygltf::Model model = Load(file);
  return Converter(file, model).Convert();
}

}  // namespace retrolux
