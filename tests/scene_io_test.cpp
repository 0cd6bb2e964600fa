// Scenes to files and back: what is written is read unchanged, what is wrong is refused with one
// clear message, and glTF's axes are ours.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <limits>

#include "core/atomic_file.h"
#include "core/data_path.h"
#include "core/json_reader.h"
#include "scenes/built_in.h"
#include "scenes/gltf.h"
#include "scenes/scene_json.h"
#include "scenes/scene_json_sensor.h"

namespace retrolux {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// A folder that is removed again.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    static int count = 0;
    path_ = fs::temp_directory_path() / fmt::format("scene_io_test-{}-{}", ::getpid(), count++);
    fs::create_directories(path_);
  }
  ~TemporaryFolder() { fs::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  fs::path operator/(const std::string& name) const { return path_ / name; }
  const fs::path& Path() const { return path_; }

 private:
  fs::path path_;
};

// The message of the InputError that `action` throws, with the folder's path cut out.
template <typename Action>
std::string Message(const TemporaryFolder& folder, Action action) {
  try {
    action();
  } catch (const InputError& error) {
    std::string message = error.what();
    const std::string prefix = folder.Path().string() + "/";
    for (size_t at = message.find(prefix); at != std::string::npos; at = message.find(prefix)) {
      message.erase(at, prefix.size());
    }
    return message;
  }
  return "no error";
}

Mat3d AnyRotation() {
  return (Eigen::AngleAxisd(0.7, Vec3d(1, 2, 3).normalized()) *
          Eigen::AngleAxisd(-1.9, Vec3d::UnitY()))
      .toRotationMatrix();
}

TriangleMesh Tetrahedron(bool with_normals) {
  TriangleMesh mesh;
  mesh.positions = {{0.1f, 0, -0.0f}, {100.3f, 0, 0}, {0, 77.7f, 1e-7f}, {0, 0, 33.333f}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  if (with_normals) {
    for (const Vec3f& p : mesh.positions)
      mesh.normals.push_back((p - Vec3f(20, 20, 10)).normalized());
  }
  return mesh;
}

Scene TestScene() {
  Scene scene;
  scene.name = "test scene";
  scene.UseMaterial("mask");
  scene.UseMaterial("retro_bead");
  scene.objects.push_back(
      {"smooth", Tetrahedron(true), {AnyRotation(), {1.0 / 3.0, -250.7, 12.0}}, "mask", true});
  scene.objects.push_back({"flat", Tetrahedron(false), {}, "retro_bead", false});
  CameraSpec camera;
  camera.model = CameraModel::FromFieldOfView("left", 321, 200, 12.18, 9.15,
                                              LookAt({1265, 600, 1109}, {1, 2, 3}, {1, 0, 0}));
  camera.lens = {25.0, 1.0 / 3.0 + 2.0, 0.9};
  camera.filter = DichroicFilter{850.0, 40.0, 0.8, 3.0, 2.1};
  camera.ring = DiodeRing{12, 25.5, 850.0, 42.0, 10.0, 0.125, 1.5, 60.0, 0.25, -0.4};
  camera.ring->spectrum_shape = LedShape::kOhno;
  camera.sensor.quantum_efficiency = "materials/data/qe_nir_cmos.csv";
  camera.sensor.full_well_e = 20000.0;
  camera.sensor.read_noise_e = 9.5;
  camera.sensor.dark_current_e_s = 3.0;
  camera.sensor.adc_bits = 12;
  camera.sensor.offset_dn = 16.0;
  camera.sensor.gain_dn_e = 0.2;
  camera.sensor.prnu = 0.02;
  camera.sensor.dsnu_e = 5.5;
  camera.sensor.charge_diffusion_um = 2.5;
  camera.model.distortion = {-0.2, 0.05, 1e-4, -2e-4, 0.01};
  camera.lens.focus_distance_mm = 1600.0;
  camera.lens.stop_radius_mm = 7.5;
  camera.lens.stop_distance_mm = 22.0;
  camera.lens.diffraction = true;
  camera.lens.veiling_glare = 0.015;
  camera.sensor.temperature_c = 41.5;
  camera.sensor.dark_reference_c = 20.0;
  camera.sensor.dark_doubling_k = 7.0;
  camera.sensor.serial = "part 7";
  camera.sensor.scan = Scan::kInterlaced;
  camera.sensor.blooming = Blooming{0.9};
  camera.sensor.smear = Smear{2e-5, 64e-6};
  camera.sensor.defects = DefectPixels{12.0, 3456.0, 7.0};
  scene.cameras.push_back(camera);
  CameraSpec plain;
  plain.model = CameraModel::FromFieldOfView("smooth", 640, 480, 30.0, 20.0,
                                             LookAt({0, 0, 900}, {0, 0, 0}, {1, 1, 0}));
  scene.cameras.push_back(plain);
  scene.markers = {{"m1", 2, "smooth", {10, 11, 12.5}, 33.3, "retro_bead", true},
                   {"m2", 0, "flat"}};
  scene.ambient.radiance_w_m2_sr = 1.25;
  scene.ambient.environment_w_m2_sr = 0.1;
  scene.ambient.panels = {{{1, 2, 3}, {0, 4, 0}, {0, 0, 5}}};
  scene.poses = {{"reference", {0, 0, 0}}, {"start", {0, 0, 140}}};
  scene.exposure = {0.001, 0.5, 1500.0, "retro_bead"};
  return scene;
}

void ExpectEqual(const CameraSpec& a, const CameraSpec& b) {
  EXPECT_EQ(a.model.name, b.model.name);
  EXPECT_EQ(
      std::tie(a.model.width, a.model.height, a.model.fx, a.model.fy, a.model.cx, a.model.cy),
      std::tie(b.model.width, b.model.height, b.model.fx, b.model.fy, b.model.cx, b.model.cy));
  EXPECT_EQ(a.model.camera_from_world.rotation, b.model.camera_from_world.rotation);
  EXPECT_EQ(a.model.camera_from_world.translation, b.model.camera_from_world.translation);
  const auto lens = [](const Lens& l) {
    return std::tie(l.focal_length_mm, l.f_number, l.transmission, l.focus_distance_mm,
                    l.stop_radius_mm, l.stop_distance_mm, l.diffraction, l.veiling_glare);
  };
  EXPECT_EQ(lens(a.lens), lens(b.lens));
  EXPECT_EQ(a.model.distortion, b.model.distortion);
  const auto sensor = [](const SensorSpec& s) {
    return std::tie(s.quantum_efficiency, s.full_well_e, s.read_noise_e, s.dark_current_e_s,
                    s.adc_bits, s.offset_dn, s.gain_dn_e, s.prnu, s.dsnu_e, s.charge_diffusion_um,
                    s.temperature_c, s.dark_reference_c, s.dark_doubling_k, s.serial, s.scan);
  };
  const auto options = [](const SensorSpec& s) {
    const Blooming blooming = s.blooming.value_or(Blooming{-1.0});
    const Smear smear = s.smear.value_or(Smear{-1.0});
    const DefectPixels defects = s.defects.value_or(DefectPixels{-1.0});
    return std::tuple(blooming.drained, smear.ratio, smear.line_time_s, defects.hot_per_million,
                      defects.hot_dark_current_e_s, defects.dead_per_million);
  };
  EXPECT_EQ(options(a.sensor), options(b.sensor));
  EXPECT_EQ(sensor(a.sensor), sensor(b.sensor));
  ASSERT_EQ(a.filter.has_value(), b.filter.has_value());
  EXPECT_EQ(ToJson(a.filter.value_or(DichroicFilter{})),
            ToJson(b.filter.value_or(DichroicFilter{})));
  ASSERT_EQ(a.ring.has_value(), b.ring.has_value());
  const auto ring = [](const DiodeRing& r) {
    return std::tie(r.count, r.radius_mm, r.peak_nm, r.fwhm_nm, r.half_angle_deg,
                    r.radiant_intensity_w_sr, r.led_radius_mm, r.spectrum_shape,
                    r.junction_temperature_c, r.peak_drift_nm_k, r.intensity_drift_percent_k);
  };
  const DiodeRing ring_a = a.ring.value_or(DiodeRing{}), ring_b = b.ring.value_or(DiodeRing{});
  EXPECT_EQ(ring(ring_a), ring(ring_b));
}

void ExpectEqual(const SceneObject& a, const SceneObject& b) {
  EXPECT_EQ(std::tie(a.name, a.material, a.moves_with_pose),
            std::tie(b.name, b.material, b.moves_with_pose));
  EXPECT_EQ(a.world_from_object.rotation, b.world_from_object.rotation);
  EXPECT_EQ(a.world_from_object.translation, b.world_from_object.translation);
  EXPECT_TRUE(a.mesh.positions == b.mesh.positions) << a.name;
  EXPECT_TRUE(a.mesh.normals == b.mesh.normals) << a.name;
  EXPECT_TRUE(a.mesh.triangles == b.mesh.triangles) << a.name;
}

void ExpectEqual(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.name, b.name);
  ASSERT_EQ(a.materials.size(), b.materials.size());
  for (const auto& [name, material] : a.materials)
    EXPECT_EQ(material.spec, b.materials.at(name).spec);
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (size_t i = 0; i < a.objects.size(); ++i) ExpectEqual(a.objects[i], b.objects[i]);
  ASSERT_EQ(a.cameras.size(), b.cameras.size());
  for (size_t i = 0; i < a.cameras.size(); ++i) ExpectEqual(a.cameras[i], b.cameras[i]);
  ASSERT_EQ(a.markers.size(), b.markers.size());
  const auto marker = [](const MarkerSpec& m) {
    return std::tie(m.name, m.number, m.object, m.at, m.roll_deg, m.material, m.dark);
  };
  for (size_t i = 0; i < a.markers.size(); ++i)
    EXPECT_EQ(marker(a.markers[i]), marker(b.markers[i]));
  EXPECT_EQ(
      std::tie(a.ambient.spectrum, a.ambient.radiance_w_m2_sr, a.ambient.environment_w_m2_sr),
      std::tie(b.ambient.spectrum, b.ambient.radiance_w_m2_sr, b.ambient.environment_w_m2_sr));
  ASSERT_EQ(a.ambient.panels.size(), b.ambient.panels.size());
  const auto panel = [](const LightPanel& p) { return std::tie(p.corner, p.edge_u, p.edge_v); };
  for (size_t i = 0; i < a.ambient.panels.size(); ++i)
    EXPECT_EQ(panel(a.ambient.panels[i]), panel(b.ambient.panels[i]));
  ASSERT_EQ(a.poses.size(), b.poses.size());
  for (size_t i = 0; i < a.poses.size(); ++i) {
    EXPECT_EQ(std::tie(a.poses[i].name, a.poses[i].translation),
              std::tie(b.poses[i].name, b.poses[i].translation));
  }
  const auto exposure = [](const Exposure& e) {
    return std::tie(e.time_s, e.fraction, e.distance_mm, e.marker_material);
  };
  EXPECT_EQ(exposure(a.exposure), exposure(b.exposure));
}

// --- round trips ---

TEST(SceneFile, ExportReadsBackEqual) {
  const TemporaryFolder folder;
  const Scene scene = TestScene();
  ExportScene(scene, folder.Path());
  EXPECT_TRUE(fs::exists(folder / "test_scene.glb"));
  const Scene read = LoadScene(folder.Path().string());
  ExpectEqual(scene, read);
  EXPECT_EQ(SceneHash(scene), SceneHash(read));
  ExpectEqual(scene, ReadSceneFile(folder / "scene.json"));
}

TEST(SceneFile, BuiltInScenesReadBackEqual) {
  for (const BuiltInEntry& entry : BuiltInScenes()) {
    SCOPED_TRACE(entry.name);
    const TemporaryFolder folder;
    const Scene scene = LoadScene(entry.name);
    ExportScene(scene, folder.Path());
    const Scene read = LoadScene((folder / "scene.json").string());
    ExpectEqual(scene, read);
    EXPECT_EQ(SceneHash(scene), SceneHash(read));
  }
}

TEST(SceneFile, HashSeesEveryPart) {
  const std::string hash = SceneHash(TestScene());
  EXPECT_THAT(hash, testing::MatchesRegex("[0-9a-f]+"));
  EXPECT_EQ(hash.size(), 16u);
  const auto changed = [&](auto change) {
    Scene scene = TestScene();
    change(scene);
    return SceneHash(scene) != hash;
  };
  EXPECT_TRUE(changed([](Scene& s) { s.objects[0].mesh.positions[1].x() += 1e-5f; }));
  EXPECT_TRUE(changed(
      [](Scene& s) { std::swap(s.objects[1].mesh.triangles[0], s.objects[1].mesh.triangles[1]); }));
  EXPECT_TRUE(changed([](Scene& s) { s.cameras[1].ring = DiodeRing{}; }));
  EXPECT_TRUE(changed([](Scene& s) { s.markers[0].roll_deg += 0.001; }));
  EXPECT_TRUE(changed([](Scene& s) { s.materials["mask"].spec["roughness"] = 0.2; }));
  EXPECT_FALSE(changed([](Scene& s) { s.name = "a copy"; }));
  EXPECT_FALSE(changed([](Scene& s) { s.objects[0].mesh.positions[0].z() = 0.0f; }));  // was -0
}

// --- scene.json ---

// The smallest scene.json that is good, beside the geometry of TestScene.
class SceneJson : public testing::Test {
 protected:
  SceneJson() { WriteGlb(TestScene(), UpAxis::kX, folder_ / "a.glb"); }

  static json Smallest() {
    return json::parse(R"({"schema": "retrolux/scene-1", "name": "small",
      "objects": [{"name": "mask", "file": "a.glb", "node": "smooth", "frame": "node", "material": "mask"}],
      "cameras": [{"name": "c", "eye_mm": [0, 0, 900], "look_at_mm": [0, 0, 0], "up": [1, 0, 0],
                   "field_of_view_deg": [12.18, 9.15]}]})");
  }
  Scene Read(const json& scene) const { return ReadText(scene.dump()); }
  Scene ReadText(const std::string& text) const {
    WriteTextFile(folder_ / "scene.json", text);
    return ReadSceneFile(folder_ / "scene.json");
  }
  // The message after `value` was put at the JSON pointer `at`.
  std::string Wrong(const std::string& at, const json& value) const {
    json scene = Smallest();
    scene[json::json_pointer(at)] = value;
    return Message(folder_, [&] { Read(scene); });
  }

  TemporaryFolder folder_;
};

TEST_F(SceneJson, DefaultsAreThoseOfTheStructs) {
  const Scene scene = ReadText("// a comment\n" + Smallest().dump());
  CameraSpec expected;
  expected.model = CameraModel::FromFieldOfView("c", 640, 480, 12.18, 9.15,
                                                LookAt({0, 0, 900}, {0, 0, 0}, {1, 0, 0}));
  ExpectEqual(scene.cameras[0], expected);
  EXPECT_EQ(scene.exposure.time_s, 0.0);
  EXPECT_TRUE(scene.materials.contains("mask"));
  EXPECT_TRUE(scene.materials.contains("retro_bead"));  // of the exposure
}

TEST_F(SceneJson, SchemaStatesTheDefaults) {
  const json schema = json::parse(ReadTextFile(DataPath("scenes/schema/scene-1.schema.json")));
  const auto defaults = [&](const std::string& part) {
    json values = json::object();
    for (const auto& [key, property] : schema["$defs"][part]["properties"].items())
      if (property.contains("default")) values[key] = property["default"];
    return values;
  };
  json scene = Smallest();
  for (const char* part : {"lens", "sensor", "filter", "ring"})
    scene["cameras"][0][part] = defaults(part);
  scene["exposure"] = defaults("exposure");
  CameraSpec expected = Read(Smallest()).cameras[0];
  expected.filter = DichroicFilter{};
  expected.ring = DiodeRing{};
  ExpectEqual(Read(scene).cameras[0], expected);
}

TEST_F(SceneJson, SensorOptionsHaveTheDefaultsOfTheSchema) {
  const json schema = json::parse(ReadTextFile(DataPath("scenes/schema/scene-1.schema.json")));
  json scene = Smallest();
  for (const char* option : {"blooming", "smear", "defects"}) {
    for (const auto& [key, property] : schema["$defs"][option]["properties"].items())
      scene["cameras"][0]["sensor"][option][key] = property["default"];
  }
  CameraSpec expected = Read(Smallest()).cameras[0];
  expected.sensor.blooming = Blooming{};
  expected.sensor.smear = Smear{};
  expected.sensor.defects = DefectPixels{};
  ExpectEqual(Read(scene).cameras[0], expected);
  scene["cameras"][0]["sensor"] = {
      {"blooming", json::object()}, {"smear", json::object()}, {"defects", json::object()}};
  ExpectEqual(Read(scene).cameras[0], expected);
}

TEST_F(SceneJson, SensorsBeginWithAPresetIfTheySaySo) {
  for (const std::string& name : SensorPresetNames()) {
    SCOPED_TRACE(name);
    json scene = Smallest();
    scene["cameras"][0]["sensor"] = {{"preset", name}};
    CameraSpec expected = Read(Smallest()).cameras[0];
    expected.sensor = SensorPreset(name);
    const Scene read = Read(scene);
    ExpectEqual(read.cameras[0], expected);
    // What stands beside it comes first; null takes an option away.
    scene["cameras"][0]["sensor"] = {{"preset", name}, {"adc_bits", 10}, {"smear", nullptr}};
    expected.sensor.adc_bits = 10;
    expected.sensor.smear.reset();
    ExpectEqual(Read(scene).cameras[0], expected);
    // An exported scene holds the values themselves.
    const TemporaryFolder folder;
    ExportScene(read, folder.Path());
    EXPECT_EQ(SceneHash(LoadScene(folder.Path().string())), SceneHash(read));
  }
  EXPECT_EQ(Wrong("/cameras/0/sensor", json{{"preset", "icx414"}}),
            "scene.json: /cameras/0/sensor/preset: found string \"icx414\"; expected one of "
            "icx414al, icx429al, imx900");
  EXPECT_EQ(Wrong("/cameras/0/sensor", json{{"smear", {{"ratios", 1}}}}),
            "scene.json: /cameras/0/sensor/smear: found the unknown key 'ratios'; expected "
            "'ratio', perhaps");
  EXPECT_EQ(Wrong("/cameras/0/sensor", json{{"scan", "both"}}),
            "scene.json: /cameras/0/sensor/scan: found string \"both\"; expected one of "
            "progressive, interlaced");
}

TEST_F(SceneJson, EulerAnglesTurnAboutXFirst) {
  json scene = Smallest();
  scene["objects"][0]["rotation_deg"] = {90, 0, 90};
  // Rx(90): y -> z. Rz(90): x -> y. So R y = Rz z = z, R x = Rz x = y, R z = Rz (-y) = x.
  Mat3d expected;
  expected << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  EXPECT_LT((Read(scene).objects[0].world_from_object.rotation - expected).norm(), 1e-15);
}

TEST_F(SceneJson, WrongFilesAreRefusedWithOneMessage) {
  EXPECT_EQ(Message(folder_, [&] { ReadSceneFile(folder_ / "none.json"); }),
            "none.json: cannot be read (No such file or directory); expected a readable file");
  std::vector<std::string> names;
  for (const BuiltInEntry& entry : BuiltInScenes()) names.emplace_back(entry.name);
  EXPECT_EQ(Message(folder_, [&] { LoadScene("ct-rom"); }),
            "no scene 'ct-rom'; expected " + JoinNames(names) +
                ", or the path of a scene.json or of its folder");
  EXPECT_THAT(Message(folder_, [&] { ReadText("{\"name\": NaN}"); }),
              testing::StartsWith("scene.json: parse error at line 1, column 10: syntax error"));
  EXPECT_EQ(
      Wrong("/schema", "retrolux/scene-9"),
      "scene.json: /schema: found string \"retrolux/scene-9\"; expected \"retrolux/scene-1\"");
  EXPECT_EQ(Wrong("/camras", 1),
            "scene.json: /: found the unknown key 'camras'; expected 'cameras', perhaps");
  EXPECT_EQ(Wrong("/units", "m"), "scene.json: /units: found string \"m\"; expected one of mm");
}

TEST_F(SceneJson, WrongCamerasAreRefused) {
  EXPECT_EQ(Wrong("/cameras/0/ring", json{{"radius_m", 3}}),
            "scene.json: /cameras/0/ring: found the unknown key 'radius_m'; expected 'radius_mm', "
            "perhaps");
  EXPECT_EQ(Wrong("/cameras/0/lens", json{{"f_number", "5.6"}}),
            "scene.json: /cameras/0/lens/f_number: found string \"5.6\"; expected a number from "
            "0.5 to 256");
  EXPECT_EQ(
      Wrong("/cameras/0/sensor", json{{"adc_bits", 40}}),
      "scene.json: /cameras/0/sensor/adc_bits: found number 40; expected a number from 1 to 16");
  EXPECT_EQ(Wrong("/cameras/0/eye_mm", json{0, "x", 0}),
            "scene.json: /cameras/0/eye_mm/1: found string \"x\"; expected a number from "
            "-1000000000 to 1000000000");
  EXPECT_EQ(Wrong("/cameras/0/up", json{0, 0, 1}),
            "scene.json: /cameras/0: found an 'up' along the line of sight, or no line of sight; "
            "expected eye_mm "
            "apart from look_at_mm, and another direction for 'up'");
  EXPECT_EQ(Wrong("/cameras/0/camera_matrix", json{1, 0, 0, 0, 1, 0, 0, 0, 1}),
            "scene.json: /cameras/0: found both camera_matrix and field_of_view_deg; expected "
            "either camera_matrix or "
            "field_of_view_deg");
  EXPECT_EQ(
      Wrong("/cameras/0/size", json{640.5, 480}),
      "scene.json: /cameras/0/size: found 640.5 pixels; expected whole numbers from 1 to 32768");
  EXPECT_EQ(Wrong("/cameras", json::array()),
            "scene.json: cameras: none; expected at least one camera");
}

TEST_F(SceneJson, WrongObjectsAreRefused) {
  EXPECT_EQ(Wrong("/objects/0/material", "msk"),
            "scene.json: /objects/0/material: found the unknown material \"msk\"; expected a "
            "material of the scene or "
            "of the library: " +
                JoinNames(LibraryMaterialNames()));
  EXPECT_EQ(Wrong("/objects/0/rotation_matrix", json{1, 0, 0, 0, 1, 0, 0, 0, -1}),
            "scene.json: /objects/0/rotation_matrix: found a matrix that is no rotation; expected "
            "orthonormal rows "
            "with determinant +1");
  EXPECT_EQ(Wrong("/objects/0/file", "none.glb"),
            "scene.json: /objects/0/file: found no file \"none.glb\"; expected a file below the "
            "folder of scene.json");
  for (const std::string path : {"../a.glb", "/etc/a.glb", "x/../../a.glb"}) {
    EXPECT_EQ(Wrong("/objects/0/file", path),
              "scene.json: /objects/0/file: found \"" + path +
                  "\"; expected a relative path that does not leave its folder");
  }
  EXPECT_EQ(Wrong("/ambient", json{{"spectrum", "materials/data/none.csv"}}),
            "scene.json: /ambient/spectrum: found no table \"materials/data/none.csv\"; expected a "
            "table of the data "
            "folder, such as materials/data/fluorescent.csv");
  EXPECT_EQ(Wrong("/objects/0/node", "smoth"),
            "a.glb: no node 'smoth' with a mesh; expected one of smooth, flat");
  EXPECT_EQ(Wrong("/exposure", json{{"time_s", "long"}}),
            "scene.json: /exposure/time_s: found \"long\"; expected \"auto\" or a time in seconds");
}

// --- glTF ---

// One triangle with an index buffer, as JSON to be spoiled and 44 bytes of data.
class Gltf : public testing::Test {
 protected:
  Gltf() {
    gltf_ = json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
      "nodes": [{"name": "n", "mesh": 0}],
      "meshes": [{"name": "m", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                    {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
      "buffers": [{"uri": "data.bin", "byteLength": 44}]})");
    SetData({0, 0, 0, 1, 0, 0, 0, 2, 0}, {0, 1, 2, 0});
  }
  void SetData(const std::array<float, 9>& positions, const std::array<uint16_t, 4>& indices) {
    std::string data(44, '\0');
    std::memcpy(data.data(), positions.data(), 36);
    std::memcpy(data.data() + 36, indices.data(), 8);
    WriteTextFile(folder_ / "data.bin", data);
  }
  TriangleMesh Mesh(UpAxis up = UpAxis::kX) const {
    WriteTextFile(folder_ / "t.gltf", gltf_.dump());
    return GltfFile(folder_ / "t.gltf").Mesh(up);
  }
  std::string Wrong(const std::string& at, const json& value) {
    const json good = gltf_;
    gltf_[json::json_pointer(at)] = value;
    const std::string message = Message(folder_, [&] { Mesh(); });
    gltf_ = good;
    return message;
  }

  TemporaryFolder folder_;
  json gltf_;
};

TEST_F(Gltf, UprightAndRightHanded) {
  // glTF: 1 m to the right (+x), 2 m up (+y), 3 m to the front (+z).
  SetData({1, 0, 0, 0, 2, 0, 0, 0, 3}, {0, 1, 2, 0});
  const TriangleMesh x_up = Mesh(UpAxis::kX);
  EXPECT_EQ(x_up.positions[1], Vec3f(2000, 0, 0));  // up is x
  EXPECT_EQ(x_up.positions[2], Vec3f(0, 0, 3000));  // the front is z
  EXPECT_EQ(x_up.positions[0],
            Vec3f(0, -1000, 0));  // right is -y, for y is left of who faces the scanner
  const TriangleMesh z_up = Mesh(UpAxis::kZ);
  EXPECT_EQ(z_up.positions[1], Vec3f(0, 0, 2000));  // up is z
  EXPECT_EQ(z_up.positions[0], Vec3f(1000, 0, 0));
  EXPECT_EQ(z_up.positions[2], Vec3f(0, -3000, 0));
  for (const UpAxis up : {UpAxis::kX, UpAxis::kZ}) EXPECT_EQ(GltfFromWorld(up).determinant(), 1.0);
}

TEST_F(Gltf, CamerasComeBackAndSeeThePointWhereItWas) {
  const Scene scene = TestScene();
  for (const UpAxis up : {UpAxis::kX, UpAxis::kZ}) {
    WriteGlb(scene, up, folder_ / "c.glb");
    const std::vector<CameraModel> cameras = GltfFile(folder_ / "c.glb").Cameras(up);
    ASSERT_EQ(cameras.size(), scene.cameras.size());
    for (size_t i = 0; i < cameras.size(); ++i) {
      const CameraModel& expected = scene.cameras[i].model;
      EXPECT_EQ(cameras[i].name, expected.name);
      EXPECT_EQ(cameras[i].fx, expected.fx);
      const Vec3d x(13.0, -7.0, 21.0);
      EXPECT_LT((*cameras[i].Project(x) - *expected.Project(x)).norm(), 1e-9);
      EXPECT_LT((cameras[i].Centre() - expected.Centre()).norm(), 1e-9);
    }
  }
}

TEST_F(Gltf, CameraWithoutOurExtrasLooksAlongMinusZ) {
  gltf_["nodes"].push_back({{"name", "eye"}, {"camera", 0}, {"translation", {0, 0, 5}}});
  gltf_["scenes"][0]["nodes"] = {0, 1};
  gltf_["cameras"] = json::parse(
      R"([{"type": "perspective", "perspective": {"yfov": 0.5, "aspectRatio": 2.0, "znear": 0.1}}])");
  Mesh();
  const CameraModel camera = GltfFile(folder_ / "t.gltf").Cameras(UpAxis::kX).at(0);
  EXPECT_EQ(camera.height, 320);
  EXPECT_LT((camera.Forward() - Vec3d(0, 0, -1)).norm(), 1e-15);
  // A point above the axis lies in the upper half: v below the centre's. One to the left (+y) lies
  // left.
  EXPECT_LT(camera.Project({100, 0, 0})->y(), camera.cy);
  EXPECT_LT(camera.Project({0, 100, 0})->x(), camera.cx);
}

TEST_F(Gltf, TransformsOfTheHierarchyApply) {
  gltf_["nodes"] = json::parse(
      R"([{"name": "parent", "children": [1], "translation": [0, 1, 0], "scale": [-2, 2, 2]},
                                   {"name": "n", "mesh": 0, "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476]}])");
  const TriangleMesh mesh = Mesh(UpAxis::kZ);
  // Vertex 1 is (1, 0, 0) m; turned by 90 degrees about z (0, 1, 0), scaled (0, 2, 0), shifted (0,
  // 3, 0): 3 m up.
  EXPECT_LT((mesh.positions[1] - Vec3f(0, 0, 3000)).norm(), 1e-3f);
  // Vertex 2 is (0, 2, 0) m; turned (-2, 0, 0), mirrored (4, 0, 0), shifted (4, 1, 0).
  EXPECT_LT((mesh.positions[2] - Vec3f(4000, 0, 1000)).norm(), 1e-3f);
  EXPECT_EQ(mesh.triangles[0], (std::array<uint32_t, 3>{0, 2, 1}));  // a mirror flips the winding
  EXPECT_EQ(
      Message(folder_,
              [&] { GltfFile(folder_ / "t.gltf").NodeMesh("n", MeshFrame::kNode, UpAxis::kX); }),
      "t.gltf: node 'n': a transform that mirrors, shears or flattens; expected scale, rotation "
      "and translation "
      "only for a mesh in the frame of its node");
}

TEST_F(Gltf, InterleavedBuffersAndByteIndices) {
  // Position and normal (0, 0, 1) in turns, 24 bytes each; three indices of a byte after them.
  std::string data(76, '\0');
  const float vertices[18] = {0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 2, 0, 0, 0, 1};
  std::memcpy(data.data(), vertices, 72);
  data[73] = 1, data[74] = 2;
  WriteTextFile(folder_ / "data.bin", data);
  gltf_["buffers"][0]["byteLength"] = 76;
  gltf_["bufferViews"] = json::parse(R"([{"buffer": 0, "byteLength": 72, "byteStride": 24},
                                         {"buffer": 0, "byteOffset": 72, "byteLength": 3}])");
  gltf_["accessors"][1]["componentType"] = 5121;
  gltf_["accessors"].push_back({{"bufferView", 0},
                                {"byteOffset", 12},
                                {"componentType", 5126},
                                {"count", 3},
                                {"type", "VEC3"}});
  gltf_["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = 2;
  const TriangleMesh mesh = Mesh();
  EXPECT_EQ(mesh.positions[2], Vec3f(2000, 0, 0));
  ASSERT_EQ(mesh.normals.size(), 3u);
  EXPECT_EQ(mesh.normals[2], Vec3f(0, 0, 1));
  // A primitive without normals beside one with normals gets those of its triangles.
  gltf_["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}});
  EXPECT_EQ(Mesh().normals.size(), 6u);
}

TEST_F(Gltf, WrongAccessorsAreRefused) {
  EXPECT_EQ(Wrong("/accessors/0/count", 4),
            "t.gltf: mesh 'm' primitive 0 POSITION: 4 elements from byte 0 in a buffer view of 36 "
            "bytes; expected bytes "
            "that are there");
  EXPECT_EQ(Wrong("/accessors/0/byteOffset", 1ull << 60),
            "t.gltf: mesh 'm' primitive 0 POSITION: 3 elements from byte 1152921504606846976 in a "
            "buffer view of 36 "
            "bytes; expected bytes that are there");
  EXPECT_EQ(Wrong("/bufferViews/1/byteLength", 400),
            "t.gltf: mesh 'm' primitive 0 indices: a buffer view of 400 bytes from byte 36 in a "
            "buffer of 44 bytes; "
            "expected bytes that are there");
  EXPECT_EQ(Wrong("/accessors/1/bufferView", 7),
            "t.gltf: cannot be read: accessor[1] invalid bufferView; expected glTF 2.0");
  EXPECT_EQ(Wrong("/meshes/0/primitives/0/attributes/POSITION", -3),
            "t.gltf: mesh 'm' primitive 0 POSITION: the index -3 into 2 elements; expected an "
            "index of one of them");
  EXPECT_EQ(Wrong("/accessors/0/sparse",
                  json::parse(R"({"count": 1, "indices": {"bufferView": 1, "componentType": 5123},
                                                         "values": {"bufferView": 0}})")),
            "t.gltf: mesh 'm' primitive 0 POSITION: a sparse accessor; expected a plain one");
  EXPECT_EQ(Wrong("/meshes/0/primitives/0/mode", 1),
            "t.gltf: mesh 'm' primitive 0: mode 1; expected 4 (triangles)");
  EXPECT_EQ(Wrong("/extensionsRequired", json{"KHR_draco_mesh_compression"}),
            "t.gltf: extensionsRequired: 'KHR_draco_mesh_compression'; expected meshes without "
            "extensions or compression");
}

TEST_F(Gltf, WrongContentsAreRefused) {
  SetData({0, 0, 0, 1, 0, 0, 0, 2, 0}, {0, 1, 3, 0});
  EXPECT_EQ(Message(folder_, [&] { Mesh(); }),
            "t.gltf: mesh 'm' primitive 0 indices: index 3 at 2 with 3 vertices; expected vertices "
            "that exist");
  SetData({0, 0, 0, 1, 0, 0, 0, std::numeric_limits<float>::quiet_NaN(), 0}, {0, 1, 2, 0});
  EXPECT_EQ(Message(folder_, [&] { Mesh(); }),
            "t.gltf: mesh 'm' primitive 0 POSITION: a coordinate of element 2 that is not a "
            "number; expected finite "
            "numbers");
  SetData({0, 0, 0, 1e30f, 0, 0, 0, 2, 0}, {0, 1, 2, 0});
  EXPECT_EQ(Message(folder_, [&] { Mesh(); }),
            "t.gltf: node 'n': a vertex at (0, -1e+33, 0) mm; expected coordinates below 1e+09 mm");
}

TEST_F(Gltf, WrongNodesAndFilesAreRefused) {
  EXPECT_EQ(Wrong("/nodes/0/mesh", 4),
            "t.gltf: node 'n' mesh: the index 4 into 1 elements; expected an index of one of them");
  EXPECT_EQ(Wrong("/nodes/0/children", json{0}),
            "t.gltf: node 'n': a node that is reached twice; expected nodes that form a tree");
  EXPECT_EQ(Wrong("/nodes/0/scale", json{1, 0, 1}),
            "t.gltf: node 'n': a singular transform; expected one that keeps a volume");
  EXPECT_EQ(Wrong("/nodes", json{{{"name", "empty"}}}), "t.gltf: no mesh; expected triangles");
  EXPECT_EQ(Wrong("/meshes/0/primitives", json::array()),
            "t.gltf: mesh 'm': no primitives; expected triangles");
  EXPECT_EQ(Wrong("/asset/version", "1.0"), "t.gltf: asset: version '1.0'; expected glTF 2.0");
  EXPECT_EQ(Wrong("/buffers/0/uri", "none.bin"),
            "t.gltf: cannot be read: File not found : none.bin; expected glTF 2.0");
  WriteTextFile(folder_.Path().string() + ".bin", std::string(44, '\0'));
  const std::string outside = folder_.Path().filename().string() + ".bin";
  EXPECT_EQ(Wrong("/buffers/0/uri", "../" + outside),
            "t.gltf: a path \"../" + outside +
                "\" that leaves the folder; expected files in its folder or below");
  fs::remove(folder_.Path().string() + ".bin");
}

TEST_F(Gltf, DamagedGlbIsRefusedAtEveryLength) {
  WriteGlb(TestScene(), UpAxis::kX, folder_ / "a.glb");
  const std::string good = ReadTextFile(folder_ / "a.glb");
  const auto message = [&](const std::string& bytes) {
    WriteTextFile(folder_ / "b.glb", bytes);
    return Message(folder_, [&] { GltfFile(folder_ / "b.glb").Mesh(UpAxis::kX); });
  };
  EXPECT_EQ(message(good), "no error");
  EXPECT_EQ(
      message(good.substr(0, 1000)),
      fmt::format("b.glb: header: a file of 1000 bytes; expected {} bytes, as its header says",
                  good.size()));
  EXPECT_EQ(message(good.substr(0, 12)),
            "b.glb: header: 12 bytes; expected a GLB file of at least 20 bytes");
  EXPECT_EQ(message("solid cube"),
            "b.glb: header: no \"glTF\" in the first four bytes; expected a GLB file, or JSON in a "
            ".gltf file");
  EXPECT_EQ(message(""), message("solid cube"));
  std::string version = good;
  version[4] = 1;
  EXPECT_EQ(message(version), "b.glb: header: GLB version 1; expected version 2");
  // Truncated with a header that agrees, so that the chunks are wrong.
  for (size_t length = 20; length < good.size(); length += 97) {
    std::string cut = good.substr(0, length);
    const auto stated = static_cast<uint32_t>(length);
    std::memcpy(cut.data() + 8, &stated, 4);
    EXPECT_NE(message(cut), "no error") << length;
  }
  // One byte changed anywhere: any answer but a crash (the sanitizer build watches).
  for (size_t at = 0; at < good.size(); at += 13) {
    std::string spoiled = good;
    spoiled[at] = static_cast<char>(spoiled[at] ^ 0x15);
    message(spoiled);
  }
}

}  // namespace
}  // namespace retrolux
