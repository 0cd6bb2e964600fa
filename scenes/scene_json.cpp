#include "scenes/scene_json.h"

#include <algorithm>

#include "core/json_reader.h"
#include "scenes/built_in.h"
#include "scenes/gltf.h"
#include "scenes/mesh_import.h"
#include "scenes/scene_json_camera.h"
#include "scenes/scene_json_values.h"

namespace retrolux {

namespace fs = std::filesystem;

namespace {

Mat3d RotationFromEuler(const Vec3d& deg) {
  const auto about = [](double angle_deg, const Vec3d& axis) {
    return Eigen::AngleAxisd(RadFromDeg(angle_deg), axis).toRotationMatrix();
  };
  return about(deg.z(), Vec3d::UnitZ()) * about(deg.y(), Vec3d::UnitY()) *
         about(deg.x(), Vec3d::UnitX());
}

Material LibraryMaterialAt(const JsonReader& node, const std::string& expected) {
  const std::string name = node.AsString();
  const std::vector<std::string> names = LibraryMaterialNames();
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    node.Fail(fmt::format("the unknown material {}", Quoted(name)),
              fmt::format("{} {}", expected, JoinNames(names)));
  }
  return LibraryMaterial(name);
}

Material ReadDeclaredMaterial(const std::string& name, JsonReader json) {
  if (!json.Has("library")) return ReadMaterial(name, json);
  Material material = LibraryMaterialAt(json.Child("library"), "one of");
  json.Finish();
  material.name = name;
  return material;
}

// The name of a material: one that the scene declares, else one of the library, which the scene
// then has.
std::string UsedMaterial(Scene& scene, JsonReader& json, const std::string& key) {
  const JsonReader node = json.Child(key);
  const std::string name = node.AsString();
  if (!scene.materials.contains(name)) {
    scene.materials[name] = LibraryMaterialAt(node, "a material of the scene or of the library:");
  }
  return name;
}

MarkerSpec ReadMarker(Scene& scene, JsonReader json) {
  MarkerSpec marker;
  marker.name = json.String("name");
  marker.number = json.Integer("number", 0, 999);
  marker.object = json.String("object");
  marker.at = Position(json, "at_mm");
  marker.roll_deg = json.Number("roll_deg", -3600.0, 3600.0, marker.roll_deg);
  marker.dark = json.Bool("dark", marker.dark);
  if (json.Has("material")) {
    marker.material = UsedMaterial(scene, json, "material");
  } else {
    scene.UseMaterial(marker.material);
  }
  json.Finish();
  return marker;
}

AmbientLight ReadAmbient(JsonReader json) {
  AmbientLight ambient;
  ambient.spectrum = TableName(json, "spectrum", ambient.spectrum);
  ambient.radiance_w_m2_sr = json.Number("radiance_w_m2_sr", 0.0, 1e6, ambient.radiance_w_m2_sr);
  ambient.environment_w_m2_sr =
      json.Number("environment_w_m2_sr", 0.0, 1e6, ambient.environment_w_m2_sr);
  ForEach(json, "panels", [&](JsonReader panel) {
    const LightPanel light = {Position(panel, "corner_mm"), Position(panel, "edge_u_mm"),
                              Position(panel, "edge_v_mm")};
    panel.Finish();
    if (!(light.edge_u.cross(light.edge_v).norm() > 0.0))
      panel.Fail("a panel without area", "edges that span a rectangle");
    ambient.panels.push_back(light);
  });
  json.Finish();
  return ambient;
}

Pose ReadPose(JsonReader json) {
  const Pose pose = {json.String("name"), Position(json, "translation_mm", Vec3d::Zero())};
  json.Finish();
  return pose;
}

Exposure ReadExposure(Scene& scene, JsonReader json) {
  Exposure exposure;
  if (json.Has("time_s")) {
    const JsonReader time = json.Child("time_s");
    if (!time.IsString()) {
      exposure.time_s = time.AsNumber(1e-9, 1e4);
    } else if (time.AsString() != "auto") {
      time.Fail(Quoted(time.AsString()), "\"auto\" or a time in seconds");
    }
  }
  exposure.fraction = json.Number("fraction", 0.001, 1.0, exposure.fraction);
  exposure.distance_mm = json.Number("distance_mm", 1.0, 1e6, exposure.distance_mm);
  if (json.Has("marker_material"))
    exposure.marker_material = UsedMaterial(scene, json, "marker_material");
  json.Finish();
  return exposure;
}

RigidTransform ReadPlacement(JsonReader& json) {
  RigidTransform placement;
  placement.translation = Position(json, "translation_mm", placement.translation);
  if (json.Has("rotation_matrix") && json.Has("rotation_deg")) {
    json.Fail("both rotation_matrix and rotation_deg", "one of them");
  }
  if (json.Has("rotation_matrix")) placement.rotation = Rotation(json.Child("rotation_matrix"));
  if (json.Has("rotation_deg"))
    placement.rotation = RotationFromEuler(json.Vector3("rotation_deg"));
  return placement;
}

Perforation ReadPerforation(JsonReader json) {
  Perforation holes;
  holes.diameter_mm = json.Number("diameter_mm", 0.01, 1000.0, holes.diameter_mm);
  holes.pitch_mm = json.Number("pitch_mm", 0.01, 1000.0, holes.pitch_mm);
  holes.thickness_mm = json.Number("thickness_mm", 0.0, 1000.0, holes.thickness_mm);
  holes.axis = json.Vector3("axis", holes.axis);
  holes.centre = Position(json, "centre_mm", holes.centre);
  json.Finish();
  if (!(holes.pitch_mm > holes.diameter_mm)) {
    json.Fail(fmt::format("holes of {} mm every {} mm", holes.diameter_mm, holes.pitch_mm),
              "a pitch_mm greater than the diameter_mm");
  }
  if (!(holes.axis.norm() > 1e-6))
    json.Child("axis").Fail("no direction", "a vector with a length");
  return holes;
}

// Of all textures of a scene. Materials may share a picture, and each has a copy.
class TexturePixels {
 public:
  void Add(const JsonReader& place, const Material& material) {
    if (material.texture) pixels_ += material.texture->Pixels();
    if (pixels_ > kMost) {
      place.Fail(fmt::format("textures of {} pixels up to here", pixels_),
                 fmt::format("a scene with at most {}", kMost));
    }
  }

 private:
  static constexpr size_t kMost = size_t{1} << 27;
  size_t pixels_ = 0;
};

// Reads the objects of one scene file; each glTF file is read once.
class ObjectReader {
 public:
  ObjectReader(Scene& scene, UpAxis up, TexturePixels& textures)
      : scene_(scene), up_(up), textures_(textures) {}

  SceneObject Read(JsonReader json) {
    SceneObject object;
    object.name = json.String("name");
    object.world_from_object = ReadPlacement(json);
    object.moves_with_pose = json.Bool("moves_with_pose", object.moves_with_pose);
    if (HasSome(json, "perforation"))
      object.perforation = ReadPerforation(json.Child("perforation"));
    const std::string file = json.PathBelow("file");
    // A glTF file may bring its own.
    if (json.Has("material") || !IsGltf(file))
      object.material = UsedMaterial(scene_, json, "material");
    const fs::path path = json.FileBelow("file");
    if (IsGltf(file)) {
      ReadGltf(json, file, path, object);
    } else {
      object.mesh = ReadOther(json, path);
    }
    // Objects may share a file, and each has a copy.
    triangles_ += object.mesh.triangles.size();
    if (triangles_ > kMaxTriangles) {
      json.Fail(fmt::format("{} triangles up to here", triangles_),
                fmt::format("a scene of at most {}", kMaxTriangles));
    }
    return object;
  }

 private:
  // Which mesh of the file, and in which frame; its material, if the object has none yet.
  void ReadGltf(JsonReader& json, const std::string& file, const fs::path& path,
                SceneObject& object) {
    const bool has_node = json.Has("node");
    const std::string node = has_node ? json.String("node") : "";
    const bool in_node = json.Has("frame") && json.Choice("frame", {"file", "node"}) == "node";
    if (in_node && !has_node)
      json.Fail("\"frame\": \"node\" without a node", "the key 'node' with its name");
    json.Finish();
    const auto open = files_.find(file);
    const GltfFile& gltf =
        open != files_.end() ? open->second : files_.emplace(file, GltfFile(path)).first->second;
    object.mesh = has_node ? gltf.NodeMesh(node, in_node ? MeshFrame::kNode : MeshFrame::kFile, up_)
                           : gltf.Mesh(up_);
    if (!object.material.empty()) return;
    Material material = has_node ? gltf.NodeMaterial(node) : gltf.MeshMaterial();
    object.material = material.name = fmt::format("{}:{}", file, material.name);
    const auto [entry, is_new] = scene_.materials.emplace(object.material, std::move(material));
    if (is_new) textures_.Add(json, entry->second);
  }

  // PLY, OBJ, STL: their axes are the object's, their unit must be said.
  static TriangleMesh ReadOther(JsonReader& json, const fs::path& path) {
    const LengthUnit unit = ParseLengthUnit(json.Choice("unit", {"mm", "cm", "m"}));
    json.Finish();
    return ImportMesh(path, unit);
  }

  Scene& scene_;
  const UpAxis up_;
  TexturePixels& textures_;
  std::map<std::string, GltfFile> files_;  // by their names in the scene file
  size_t triangles_ = 0;
};

// What a file says of itself: checked where wrong values would be misread.
void ReadPreamble(JsonReader& json) {
  json.Schema("retrolux/scene-1");
  json.String("version", "");
  if (json.Has("units")) json.Choice("units", {"mm"});
  if (json.Has("pixel_origin")) json.Choice("pixel_origin", {"center"});
}

}  // namespace

Scene ReadSceneFile(const fs::path& file) {
  JsonReader json = JsonReader::FromFile(file);
  ReadPreamble(json);
  Scene scene;
  scene.name = json.String("name");
  if (json.Has("up_axis") && json.Choice("up_axis", {"x", "z"}) == "z") scene.up_axis = UpAxis::kZ;
  TexturePixels textures;
  if (json.Has("materials")) {
    JsonReader materials = json.Child("materials");
    for (const std::string& name : materials.Keys()) {
      const Material material = ReadDeclaredMaterial(name, materials.Child(name));
      textures.Add(materials.Child(name), material);
      scene.materials[name] = material;
    }
  }
  ObjectReader objects(scene, scene.up_axis, textures);
  ForEach(json, "objects",
          [&](const JsonReader& object) { scene.objects.push_back(objects.Read(object)); });
  ForEach(json, "cameras",
          [&](const JsonReader& camera) { scene.cameras.push_back(ReadCamera(camera)); });
  if (json.Has("marker_set")) {
    scene.marker_set =
        std::make_shared<const MarkerSet>(ReadMarkerSet(json.FileBelow("marker_set")));
  }
  ForEach(json, "markers",
          [&](const JsonReader& marker) { scene.markers.push_back(ReadMarker(scene, marker)); });
  ForEach(json, "poses", [&](const JsonReader& pose) { scene.poses.push_back(ReadPose(pose)); });
  if (json.Has("ambient")) scene.ambient = ReadAmbient(json.Child("ambient"));
  if (json.Has("exposure")) scene.exposure = ReadExposure(scene, json.Child("exposure"));
  scene.UseMaterial(scene.exposure.marker_material);
  json.Finish();
  CheckScene(scene, file);
  return scene;
}

Scene LoadScene(const std::string& name_or_path) {
  std::vector<std::string> names;
  for (const BuiltInEntry& entry : BuiltInScenes()) {
    if (name_or_path == entry.name) return entry.make();
    names.emplace_back(entry.name);
  }
  const fs::path path = name_or_path;
  if (fs::is_directory(path)) return ReadSceneFile(path / "scene.json");
  if (fs::is_regular_file(path)) return ReadSceneFile(path);
  throw InputError(
      fmt::format("no scene '{}'; expected {}, or the path of a scene.json or of its folder",
                  name_or_path, JoinNames(names)));
}

}  // namespace retrolux
