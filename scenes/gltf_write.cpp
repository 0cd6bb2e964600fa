#include <tiny_gltf.h>

#include <cmath>
#include <cstring>
#include <set>
#include <sstream>

#include "core/atomic_file.h"
#include "scenes/gltf.h"
#include "scenes/gltf_surface.h"
#include "scenes/scene.h"

namespace retrolux {

namespace {

constexpr double kMPerMm = 0.001;

std::vector<double> List(const Vec3d& v) {
  return {v.x(), v.y(), v.z()};
}

// The library's own kind of JSON.
tinygltf::Value ValueOf(const nlohmann::json& json) {
  if (json.is_object()) {
    tinygltf::Value::Object object;
    for (const auto& [key, value] : json.items()) object[key] = ValueOf(value);
    return tinygltf::Value(object);
  }
  if (json.is_array()) {
    tinygltf::Value::Array array;
    for (const nlohmann::json& value : json) array.push_back(ValueOf(value));
    return tinygltf::Value(array);
  }
  if (json.is_string()) return tinygltf::Value(json.get<std::string>());
  if (json.is_boolean()) return tinygltf::Value(json.get<bool>());
  if (json.is_number_integer()) return tinygltf::Value(json.get<int>());
  return json.is_number() ? tinygltf::Value(json.get<double>()) : tinygltf::Value();
}

// As viewers show it, and whole for us.
tinygltf::Material MaterialOf(const std::string& name, const Material& ours) {
  const GltfSurface surface = NearestGltfSurface(ours.spec);
  tinygltf::Material material;
  material.name = name;
  const double grey = surface.reflectance;
  material.pbrMetallicRoughness.baseColorFactor = {grey, grey, grey, 1.0};
  material.pbrMetallicRoughness.metallicFactor = surface.metallic;
  material.pbrMetallicRoughness.roughnessFactor = surface.roughness;
  if (surface.ior != GltfSurface{}.ior) {
    material.extensions["KHR_materials_ior"] = ValueOf({{"ior", surface.ior}});
  }
  if (surface.retroreflection > 0.0) {
    material.extensions["KHR_materials_retroreflection"] =
        ValueOf({{"retroreflectionFactor", surface.retroreflection}});
  }
  material.extras = ValueOf({{"retrolux", ExportedSpec(ours)}});
  return material;
}

class GlbWriter {
 public:
  GlbWriter(const Scene& scene, UpAxis up) : scene_(scene), gltf_from_world_(GltfFromWorld(up)) {
    model_.asset.version = "2.0";
    model_.asset.generator = "Retrolux " RETROLUX_VERSION;
    model_.scenes.emplace_back();
    model_.scenes[0].name = scene.name;
    model_.defaultScene = 0;
  }

  std::string Bytes() {
    for (const SceneObject& object : scene_.objects) AddObject(object);
    for (const CameraSpec& camera : scene_.cameras) AddCamera(camera.model);
    for (const MarkerSpec& marker : scene_.markers) AddMarker(marker);
    model_.extensionsUsed = {extensions_used_.begin(), extensions_used_.end()};
    if (!buffer_.data.empty()) model_.buffers.push_back(std::move(buffer_));
    std::ostringstream bytes;
    RETROLUX_CHECK(tinygltf::TinyGLTF().WriteGltfSceneToStream(
                       &model_, bytes, /*prettyPrint=*/false, /*writeBinary=*/true),
                   "scene {}", scene_.name);
    return std::move(bytes).str();
  }

 private:
  // A bufferView and an accessor over `elements` of three or one components of four bytes.
  template <typename Element>
  int AddAccessor(const std::vector<Element>& elements, int type, int component_type, int target) {
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = buffer_.data.size();
    view.byteLength = elements.size() * sizeof(Element);
    view.target = target;
    buffer_.data.resize(view.byteOffset + view.byteLength);
    std::memcpy(buffer_.data.data() + view.byteOffset, elements.data(), view.byteLength);
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(model_.bufferViews.size());
    accessor.componentType = component_type;
    accessor.count =
        view.byteLength /
        static_cast<size_t>(4 * tinygltf::GetNumComponentsInType(static_cast<uint32_t>(type)));
    accessor.type = type;
    model_.bufferViews.push_back(view);
    model_.accessors.push_back(accessor);
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  int AddVectors(const std::vector<Vec3f>& vectors) {
    std::vector<Vec3f> turned;
    Vec3f low = Vec3f::Constant(INFINITY), high = -low;
    for (const Vec3f& v : vectors) {
      turned.push_back(gltf_from_world_.cast<float>() * v);
      low = low.cwiseMin(turned.back());
      high = high.cwiseMax(turned.back());
    }
    const int index = AddAccessor(turned, TINYGLTF_TYPE_VEC3, TINYGLTF_COMPONENT_TYPE_FLOAT,
                                  TINYGLTF_TARGET_ARRAY_BUFFER);
    model_.accessors.back().minValues = List(low.cast<double>());
    model_.accessors.back().maxValues = List(high.cast<double>());
    return index;
  }

  // -1 for a format that glTF does not have.
  int AddTexture(const Texture& texture) {
    const std::string extension = texture.File().extension().string();
    if (extension != ".png" && extension != ".jpg" && extension != ".jpeg") return -1;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = buffer_.data.size();
    view.byteLength = texture.Bytes().size();
    buffer_.data.insert(buffer_.data.end(), texture.Bytes().begin(), texture.Bytes().end());
    buffer_.data.resize((buffer_.data.size() + 3) / 4 * 4);  // accessors begin at words
    tinygltf::Image image;
    image.name = texture.FileName();
    image.mimeType = extension == ".png" ? "image/png" : "image/jpeg";
    image.bufferView = static_cast<int>(model_.bufferViews.size());
    model_.bufferViews.push_back(view);
    tinygltf::Texture reference;
    reference.source = static_cast<int>(model_.images.size());
    model_.images.push_back(std::move(image));
    model_.textures.push_back(reference);
    return static_cast<int>(model_.textures.size()) - 1;
  }

  void AddNode(tinygltf::Node node) {
    model_.scenes[0].nodes.push_back(static_cast<int>(model_.nodes.size()));
    model_.nodes.push_back(std::move(node));
  }

  // `rotation` in the axes of glTF.
  tinygltf::Node NodeAt(const std::string& name, const Mat3d& rotation,
                        const Vec3d& x_in_world) const {
    tinygltf::Node node;
    node.name = name;
    node.translation = List(gltf_from_world_ * x_in_world * kMPerMm);
    Eigen::Quaterniond q(rotation);
    q.normalize();
    node.rotation = {q.x(), q.y(), q.z(), q.w()};
    return node;
  }

  // Only what a mesh uses is written.
  int MaterialIndex(const std::string& name) {
    const auto [entry, is_new] =
        material_index_.emplace(name, static_cast<int>(model_.materials.size()));
    if (is_new) {
      const Material& material = scene_.materials.at(name);
      model_.materials.push_back(MaterialOf(name, material));
      if (material.texture) {
        model_.materials.back().pbrMetallicRoughness.baseColorTexture.index =
            AddTexture(*material.texture);
      }
      for (const auto& [extension, _] : model_.materials.back().extensions)
        extensions_used_.insert(extension);
    }
    return entry->second;
  }

  void AddObject(const SceneObject& object) {
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = MaterialIndex(object.material);
    primitive.attributes["POSITION"] = AddVectors(object.mesh.positions);
    if (!object.mesh.normals.empty())
      primitive.attributes["NORMAL"] = AddVectors(object.mesh.normals);
    if (!object.mesh.uvs.empty()) {
      primitive.attributes["TEXCOORD_0"] =
          AddAccessor(object.mesh.uvs, TINYGLTF_TYPE_VEC2, TINYGLTF_COMPONENT_TYPE_FLOAT,
                      TINYGLTF_TARGET_ARRAY_BUFFER);
    }
    primitive.indices =
        AddAccessor(object.mesh.triangles, TINYGLTF_TYPE_SCALAR,
                    TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    tinygltf::Mesh mesh;
    mesh.name = object.name;
    mesh.primitives.push_back(primitive);

    const Mat3d rotation =
        gltf_from_world_ * object.world_from_object.rotation * gltf_from_world_.transpose();
    tinygltf::Node node = NodeAt(object.name, rotation, object.world_from_object.translation);
    node.scale = {kMPerMm, kMPerMm, kMPerMm};
    node.mesh = static_cast<int>(model_.meshes.size());
    model_.meshes.push_back(std::move(mesh));
    AddNode(std::move(node));
  }

  void AddCamera(const CameraModel& model) {
    const auto real = [](double x) { return tinygltf::Value(x); };
    tinygltf::Value::Array k;
    for (const double x : {model.fx, 0.0, model.cx, 0.0, model.fy, model.cy, 0.0, 0.0, 1.0})
      k.push_back(real(x));
    tinygltf::Value::Object opencv;
    opencv["K"] = tinygltf::Value(k);
    if (!model.distortion.IsNone()) {
      tinygltf::Value::Array distortion;
      for (const double x : model.distortion.Coefficients()) distortion.push_back(real(x));
      opencv["distortion"] = tinygltf::Value(distortion);
    }
    opencv["width"] = tinygltf::Value(model.width);
    opencv["height"] = tinygltf::Value(model.height);
    tinygltf::Camera camera;
    camera.name = model.name;
    camera.type = "perspective";
    camera.perspective.yfov = 2.0 * std::atan(0.5 * model.height / model.fy);
    camera.perspective.aspectRatio = (model.width / model.fx) / (model.height / model.fy);
    camera.perspective.znear = 0.01;
    camera.perspective.zfar = 100.0;  // the writer would write an unset one as 0, which is invalid
    camera.extras = tinygltf::Value(tinygltf::Value::Object{{"opencv", tinygltf::Value(opencv)}});

    const Mat3d camera_from_gltf_camera = Vec3d(1, -1, -1).asDiagonal();
    const Mat3d rotation =
        gltf_from_world_ * model.camera_from_world.rotation.transpose() * camera_from_gltf_camera;
    tinygltf::Node node = NodeAt(model.name, rotation, model.Centre());
    node.camera = static_cast<int>(model_.cameras.size());
    model_.cameras.push_back(std::move(camera));
    AddNode(std::move(node));
  }

  // An empty node at the point that the marker is given at; the surface near it is the scene's to
  // find.
  void AddMarker(const MarkerSpec& marker) {
    const Vec3d at = scene_.Object(marker.object).world_from_object * marker.at;
    tinygltf::Node node = NodeAt(marker.name, Mat3d::Identity(), at);
    tinygltf::Value::Object extras;
    extras["marker"] = tinygltf::Value(marker.number);
    extras["object"] = tinygltf::Value(marker.object);
    extras["roll_deg"] = tinygltf::Value(marker.roll_deg);
    node.extras = tinygltf::Value(extras);
    AddNode(std::move(node));
  }

  const Scene& scene_;
  const Mat3d gltf_from_world_;
  tinygltf::Model model_;
  tinygltf::Buffer buffer_;
  std::map<std::string, int> material_index_;
  std::set<std::string> extensions_used_;
};

}  // namespace

void WriteGlb(const Scene& scene, UpAxis up, const std::filesystem::path& file) {
  WriteTextFile(file, GlbWriter(scene, up).Bytes());
}

}  // namespace retrolux
