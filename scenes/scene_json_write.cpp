#include <span>

#include "core/atomic_file.h"
#include "core/data_path.h"
#include "core/hash.h"
#include "scenes/gltf.h"
#include "scenes/scene_json.h"
#include "scenes/scene_json_sensor.h"

namespace retrolux {

namespace fs = std::filesystem;

namespace {

// Keeps the order of the keys, so that a file reads from top to bottom.
using Json = nlohmann::ordered_json;

constexpr size_t kLineLength = 110;
constexpr const char* kMarkerSetFile = "markers.json";

// Not indented, with a space after commas and colons.
std::string OnOneLine(const Json& node) {
  if (!node.is_structured()) return node.dump();
  std::vector<std::string> parts;
  for (const auto& item : node.items()) {
    const std::string value = OnOneLine(item.value());
    parts.push_back(node.is_object() ? Json(item.key()).dump() + ": " + value : value);
  }
  return fmt::format("{}{}{}", node.is_object() ? "{" : "[", fmt::join(parts, ", "),
                     node.is_object() ? "}" : "]");
}

// Indented, but what fits on a line stays on it.
std::string Pretty(const Json& node, size_t indent = 0) {
  std::string line = OnOneLine(node);
  if (!node.is_structured() || line.size() + indent < kLineLength) return line;
  std::vector<std::string> parts;
  const std::string margin(indent + 2, ' ');
  for (const auto& item : node.items()) {
    const std::string key = node.is_object() ? Json(item.key()).dump() + ": " : "";
    parts.push_back(margin + key + Pretty(item.value(), indent + 2));
  }
  return fmt::format("{}\n{}\n{}{}", node.is_object() ? "{" : "[", fmt::join(parts, ",\n"),
                     std::string(indent, ' '), node.is_object() ? "}" : "]");
}

Json ToJson(const Vec3d& v) {
  return {v.x(), v.y(), v.z()};
}

Json ToJson(const Mat3d& m) {
  Json rows = Json::array();
  for (int i = 0; i < 9; ++i) rows.push_back(m(i / 3, i % 3));
  return rows;
}

Json ToJson(const Lens& lens) {
  return {{"focal_length_mm", lens.focal_length_mm}, {"f_number", lens.f_number},
          {"transmission", lens.transmission},       {"focus_distance_mm", lens.focus_distance_mm},
          {"stop_radius_mm", lens.stop_radius_mm},   {"stop_distance_mm", lens.stop_distance_mm},
          {"diffraction", lens.diffraction},         {"veiling_glare", lens.veiling_glare}};
}

Json ToJson(const Blooming& blooming) {
  return {{"drained", blooming.drained}};
}

Json ToJson(const Smear& smear) {
  return {{"ratio", smear.ratio}, {"line_time_s", smear.line_time_s}};
}

Json ToJson(const DefectPixels& defects) {
  return {{"hot_per_million", defects.hot_per_million},
          {"hot_dark_current_e_s", defects.hot_dark_current_e_s},
          {"dead_per_million", defects.dead_per_million}};
}

Json ToJson(const Perforation& holes) {
  return {{"diameter_mm", holes.diameter_mm},
          {"pitch_mm", holes.pitch_mm},
          {"thickness_mm", holes.thickness_mm},
          {"axis", ToJson(holes.axis)},
          {"centre_mm", ToJson(holes.centre)}};
}

template <typename Option>
Json OrNull(const std::optional<Option>& option) {
  return option ? ToJson(*option) : Json();
}

Json ToJson(const SensorSpec& sensor) {
  return {{"quantum_efficiency", sensor.quantum_efficiency},
          {"full_well_e", sensor.full_well_e},
          {"read_noise_e", sensor.read_noise_e},
          {"dark_current_e_s", sensor.dark_current_e_s},
          {"adc_bits", sensor.adc_bits},
          {"offset_dn", sensor.offset_dn},
          {"gain_dn_e", sensor.gain_dn_e},
          {"prnu", sensor.prnu},
          {"dsnu_e", sensor.dsnu_e},
          {"charge_diffusion_um", sensor.charge_diffusion_um},
          {"temperature_c", sensor.temperature_c},
          {"dark_reference_c", sensor.dark_reference_c},
          {"dark_doubling_k", sensor.dark_doubling_k},
          {"serial", sensor.serial},
          {"scan", ScanName(sensor.scan)},
          {"blooming", OrNull(sensor.blooming)},
          {"smear", OrNull(sensor.smear)},
          {"defects", OrNull(sensor.defects)}};
}

Json ToJson(const DiodeRing& ring) {
  return {{"count", ring.count},
          {"radius_mm", ring.radius_mm},
          {"peak_nm", ring.peak_nm},
          {"fwhm_nm", ring.fwhm_nm},
          {"half_angle_deg", ring.half_angle_deg},
          {"radiant_intensity_w_sr", ring.radiant_intensity_w_sr},
          {"led_radius_mm", ring.led_radius_mm},
          {"spectrum_shape", LedShapeNames()[static_cast<size_t>(ring.spectrum_shape)]},
          {"junction_temperature_c", ring.junction_temperature_c},
          {"peak_drift_nm_k", ring.peak_drift_nm_k},
          {"intensity_drift_percent_k", ring.intensity_drift_percent_k}};
}

Json ToJson(const CameraSpec& camera) {
  const CameraModel& model = camera.model;
  return {{"name", model.name},
          {"size", {model.width, model.height}},
          {"camera_matrix", {model.fx, 0, model.cx, 0, model.fy, model.cy, 0, 0, 1}},
          {"distortion", model.distortion.Coefficients()},
          {"R", ToJson(model.camera_from_world.rotation)},
          {"t_mm", ToJson(model.camera_from_world.translation)},
          {"lens", ToJson(camera.lens)},
          {"filter", camera.filter ? Json(ToJson(*camera.filter)) : Json()},
          {"sensor", ToJson(camera.sensor)},
          {"ring", camera.ring ? ToJson(*camera.ring) : Json()}};
}

Json ToJson(const MarkerSpec& marker) {
  return {{"name", marker.name},         {"number", marker.number},
          {"object", marker.object},     {"at_mm", ToJson(marker.at)},
          {"roll_deg", marker.roll_deg}, {"material", marker.material},
          {"dark", marker.dark}};
}

Json ToJson(const AmbientLight& ambient) {
  Json panels = Json::array();
  for (const LightPanel& panel : ambient.panels) {
    panels.push_back({{"corner_mm", ToJson(panel.corner)},
                      {"edge_u_mm", ToJson(panel.edge_u)},
                      {"edge_v_mm", ToJson(panel.edge_v)}});
  }
  return {{"spectrum", ambient.spectrum},
          {"radiance_w_m2_sr", ambient.radiance_w_m2_sr},
          {"environment_w_m2_sr", ambient.environment_w_m2_sr},
          {"panels", panels}};
}

Json ToJson(const Exposure& exposure) {
  return {{"time_s", exposure.time_s == 0.0 ? Json("auto") : Json(exposure.time_s)},
          {"fraction", exposure.fraction},
          {"distance_mm", exposure.distance_mm},
          {"marker_material", exposure.marker_material}};
}

// Without its mesh.
Json ToJson(const SceneObject& object) {
  return {{"name", object.name},
          {"material", object.material},
          {"rotation_matrix", ToJson(object.world_from_object.rotation)},
          {"translation_mm", ToJson(object.world_from_object.translation)},
          {"moves_with_pose", object.moves_with_pose},
          {"perforation", OrNull(object.perforation)}};
}

template <typename T>
Json Array(const std::vector<T>& items) {
  Json array = Json::array();
  for (const T& item : items) array.push_back(ToJson(item));
  return array;
}

Json ToJson(const Pose& pose) {
  return {{"name", pose.name}, {"translation_mm", ToJson(pose.translation)}};
}

// All of the scene but its name and its meshes.
Json Description(const Scene& scene) {
  Json json = {{"materials", Json::object()},       {"objects", Array(scene.objects)},
               {"cameras", Array(scene.cameras)},   {"markers", Array(scene.markers)},
               {"ambient", ToJson(scene.ambient)},  {"poses", Json::array()},
               {"exposure", ToJson(scene.exposure)}};
  for (const auto& [name, material] : scene.materials) {
    json["materials"][name] = Json(ExportedSpec(material));
  }
  for (const Pose& pose : scene.poses) json["poses"].push_back(ToJson(pose));
  json["marker_set"] = ToJson(*scene.marker_set);
  return json;
}

// A name for files: letters, digits, '-', '_' and '.' stay.
std::string FileStem(const std::string& name) {
  std::string stem;
  for (const char c : name) {
    const bool plain =
        std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.';
    stem += plain ? c : '_';
  }
  return stem.empty() || stem.front() == '.' ? "scene" + stem : stem;
}

// Tables are data that the renderer reads: their names are replaced by the hash of what they hold.
void HashTables(Json& node) {
  if (node.is_string() && node.get<std::string>().ends_with(".csv")) {
    node = HexHash(HashBytes(ReadTextFile(DataPath(node.get<std::string>()))));
  } else if (node.is_structured()) {
    for (auto& child : node) HashTables(child);
  }
}

uint64_t HashVectors(const std::vector<Vec3f>& vectors, uint64_t hash) {
  for (const Vec3f& v : vectors) {
    const Vec3f unsigned_zero = v + Vec3f::Zero();  // -0 and +0 are the same place
    hash =
        HashBytes({reinterpret_cast<const char*>(unsigned_zero.data()), sizeof(float) * 3}, hash);
  }
  return hash;
}

uint64_t HashMesh(const TriangleMesh& mesh, uint64_t hash) {
  hash = HashBytes(
      fmt::format("{} {} {}", mesh.positions.size(), mesh.normals.size(), mesh.triangles.size()),
      hash);
  hash = HashVectors(mesh.normals, HashVectors(mesh.positions, hash));
  const auto uvs = std::as_bytes(std::span(mesh.uvs));
  hash = HashBytes({reinterpret_cast<const char*>(uvs.data()), uvs.size()}, hash);
  const auto indices = std::as_bytes(std::span(mesh.triangles));
  return HashBytes({reinterpret_cast<const char*>(indices.data()), indices.size()}, hash);
}

}  // namespace

void ExportScene(const Scene& scene, const fs::path& folder) {
  CheckScene(scene, scene.name);
  EnsureWritableFolder(folder);
  const std::string geometry = FileStem(scene.name) + ".glb";
  Json json = {{"schema", "retrolux/scene-1"},
               {"version", RETROLUX_VERSION},
               {"units", "mm"},
               {"pixel_origin", "center"},
               {"name", scene.name},
               {"up_axis", scene.up_axis == UpAxis::kZ ? "z" : "x"}};
  json.update(Description(scene));
  for (Json& object : json["objects"]) {
    object["file"] = geometry;
    object["node"] = object["name"];
    object["frame"] = "node";
  }
  for (const auto& [name, material] : scene.materials) {
    if (material.texture)
      WriteTextFile(folder / material.texture->FileName(), material.texture->Bytes());
  }
  json["marker_set"] = kMarkerSetFile;
  WriteTextFile(folder / kMarkerSetFile, Pretty(ToJson(*scene.marker_set)) + "\n");
  WriteGlb(scene, scene.up_axis, folder / geometry);
  WriteTextFile(folder / "scene.json", Pretty(json) + "\n");
}

std::string SceneHash(const Scene& scene) {
  Json json = Description(scene);
  HashTables(json);
  uint64_t hash = HashBytes(json.dump());
  for (const SceneObject& object : scene.objects) hash = HashMesh(object.mesh, hash);
  return HexHash(hash);
}

}  // namespace retrolux
