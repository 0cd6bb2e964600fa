// Files from elsewhere: what they claim to hold takes no memory, and what they name lies in their
// own folder.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "classifier/camera_file.h"
#include "classifier/detections_json.h"
#include "core/atomic_file.h"
#include "core/camera_model.h"
#include "core/image_file.h"
#include "scenes/gltf.h"
#include "scenes/mesh_import.h"
#include "scenes/scenario.h"
#include "scenes/scene_json.h"
#include "tests/message_of.h"
#include "tests/own_folder.h"

namespace retrolux {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

fs::path Write(const std::string& name, const std::string& text) {
  const fs::path file = OwnFolder() / name;
  fs::create_directories(file.parent_path());
  WriteTextFile(file, text);
  return file;
}

std::string Bytes32(uint32_t value, bool big_endian = false) {
  std::string bytes;
  for (int i = 0; i < 4; ++i)
    bytes += static_cast<char>(value >> (8 * (big_endian ? 3 - i : i)) & 0xFF);
  return bytes;
}

// --- claims ---

constexpr uint32_t k2GBSide = 46341;  // squared 2^31

// A test that takes what a file claims runs into std::bad_alloc. (A sanitizer needs far more.)
class Claims : public testing::Test {
 protected:
  void SetUp() override {
#ifndef __SANITIZE_ADDRESS__
    constexpr rlim_t kMost = rlim_t{1} << 29;
    const rlimit limit{kMost, kMost};
    ASSERT_EQ(::setrlimit(RLIMIT_DATA, &limit), 0);
#endif
  }
  static std::string Mesh(const std::string& name, const std::string& bytes) {
    const fs::path file = Write(name, bytes);
    return MessageOf([&] { ImportMesh(file, LengthUnit::kMillimetre); });
  }
  static std::string Picture(const std::string& name, std::string bytes) {
    bytes.resize(std::max<size_t>(bytes.size(), 1024));
    const fs::path file = Write(name, bytes);
    const std::string message = MessageOf([&] { ReadGrey(file); });
    EXPECT_EQ(MessageOf([&] { ReadExr(file); }), message);
    return message;
  }
};

TEST_F(Claims, OfPly) {
  const std::string header =
      "element vertex 178956970\nproperty float x\nproperty float y\n"
      "property float z\nelement face 2147483647\n"
      "property list uint int vertex_indices\nend_header\n";
  EXPECT_THAT(Mesh("a.ply", "ply\nformat ascii 1.0\n" + header + "0 0 0\n"),
              HasSubstr("vertex 1: the end of the file"));
  EXPECT_THAT(Mesh("b.ply",
                   "ply\nformat binary_little_endian 1.0\nelement face 1\nproperty list "
                   "uint int vertex_indices\nend_header\n" +
                       Bytes32(536870912)),
              HasSubstr("face 0: a list of 536870912; expected a length that the file can hold"));
  EXPECT_THAT(Mesh("c.ply", "ply\nformat ascii 1.0\n" + header.substr(0, header.size() - 11) +
                                "element vertex 1\nend_header\n"),
              HasSubstr("'element vertex 1'; expected each element once"));
}

TEST_F(Claims, OfStl) {
  EXPECT_THAT(Mesh("a.stl", std::string(80, 'x') + Bytes32(42949673) + std::string(1000, '\0')),
              HasSubstr("cannot be read"));
}

// One triangle, with changes by text.
std::string Gltf(const std::string& what, const std::string& by) {
  std::string text =
      R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri":
 "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
  text.replace(text.find(what), what.size(), by);
  return text;
}

std::string GltfMessage(const std::string& text) {
  const fs::path file = Write("t.gltf", text);
  return MessageOf([&] { GltfFile(file).Mesh(UpAxis::kZ); });
}

TEST_F(Claims, OfGltf) {
  EXPECT_EQ(GltfMessage(Gltf("2.0", "2.0")), "no error");
  EXPECT_THAT(GltfMessage(Gltf("\"count\": 3", "\"count\": 178956970")),
              HasSubstr("178956970 elements from byte 0 in a buffer view of 36 bytes"));
  EXPECT_THAT(GltfMessage(Gltf("\"byteLength\": 36", "\"byteLength\": 2147483648")),
              HasSubstr("in a buffer of 36 bytes; expected bytes that are there"));
  EXPECT_THAT(
      GltfMessage(Gltf("\"byteLength\": 36, \"uri\"", "\"byteLength\": 2147483648, \"uri\"")),
      HasSubstr("cannot be read"));
  // A picture that lies outside of its buffer.
  const std::string outside = Gltf(
      "{\"buffer\": 0, \"byteLength\": 36}]",
      R"({"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 2000000000, "byteLength": 99}],
           "images": [{"bufferView": 1, "mimeType": "image/png"}])");
  EXPECT_THAT(GltfMessage(outside),
              HasSubstr("image 0: a buffer view of 99 bytes from byte 2000000000"));
}

TEST_F(Claims, PartsOfGltfThatShareTheirData) {
  std::string zeros(4 * 12 * 300'000 / 3, 'A');  // base64
  const std::string data = Gltf("AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA", zeros);
  std::string many;
  for (int i = 0; i < 100; ++i) many += R"({"attributes": {"POSITION": 0}}, )";
  std::string text = data;
  const auto change = [&](const std::string& what, const std::string& by) {
    for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
      text.replace(at, what.size(), by);
  };
  change("\"byteLength\": 36", "\"byteLength\": 3600000");
  change("\"count\": 3", "\"count\": 300000");
  const std::string one = text;
  change(R"([{"attributes")", "[" + many + R"({"attributes")");
  EXPECT_THAT(GltfMessage(text), HasSubstr("primitive 49 POSITION: data that are shared so often"));
  text = one;
  std::string nodes;
  for (int i = 0; i < 100; ++i) nodes += R"({"mesh": 0}, )";
  change(R"("nodes": [)", R"("nodes": [)" + nodes);
  EXPECT_THAT(GltfMessage(text), HasSubstr("node '#"));
  EXPECT_THAT(GltfMessage(text), HasSubstr("shared so often"));
}

TEST_F(Claims, OfPictures) {
  const std::string expected = "header: a picture of 2048 MiB in ";
  const std::string side = Bytes32(k2GBSide, true);
  EXPECT_THAT(Picture("a.png", "\x89PNG\r\n\x1a\n" + Bytes32(13, true) + "IHDR" + side + side +
                                   std::string("\x08\0\0\0\0", 5)),
              HasSubstr(expected));
  EXPECT_THAT(Picture("a.jpg", std::string("\xFF\xD8\xFF\xC0\0\x0B\x08\xB5\x05\xB5\x05\x01", 12)),
              HasSubstr(expected));
  const std::string box = std::string("dataWindow\0box2i\0", 17) + Bytes32(16) + Bytes32(0) +
                          Bytes32(0) + Bytes32(k2GBSide - 1) + Bytes32(k2GBSide - 1);
  EXPECT_THAT(Picture("a.exr", "\x76\x2F\x31\x01" + Bytes32(2) + box), HasSubstr(expected));
  EXPECT_THAT(Picture("a.pgm", "P5 46341 46341 255\n"), HasSubstr(expected));
  EXPECT_THAT(Picture("a.bmp", "BM" + Bytes32(1024) + Bytes32(0) + Bytes32(54) + Bytes32(40) +
                                   Bytes32(k2GBSide) + Bytes32(k2GBSide) +
                                   std::string("\1\0\x18\0", 4) + std::string(24, '\0')),
              HasSubstr("picture of "));
  EXPECT_THAT(Picture("a.psd", "8BPS"), HasSubstr("none of PNG, JPEG, EXR, TIFF, BMP, PNM"));
}

TEST_F(Claims, OfCameras) {
  std::string yaml = CamerasYaml({CameraModel()});
  yaml.replace(yaml.find("rows: 3\n         cols: 3"), 24, "rows: 46341\n         cols: 46341");
  const fs::path file = Write("cameras.yml", yaml);
  EXPECT_THAT(MessageOf([&] { ReadCameras(file); }),
              HasSubstr("camera_matrix/rows: found number 46341; expected a number from 1 to 9"));
}

TEST_F(Claims, OfDeepJson) {
  const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
  const fs::path file = Write(
      "detections.json",
      R"({"schema": "retrolux/detections-1", "pixel_origin": "center", "images": [{"file": "a",)"
      R"( "detections": [{"marker": )" +
          deep + "}]}]}");
  EXPECT_THAT(MessageOf([&] { ReadDetections(file, DefaultMarkerSet()); }),
              HasSubstr("JSON nested more than 64 deep"));
}

// --- ways out of the folder ---

constexpr const char* kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

class Escapes : public testing::Test {
 protected:
  Escapes() {
    Write("outside.ply", kPly);
    Write("scene/in/mesh.ply", kPly);
  }
  // What is said of a scene whose object is that file.
  static std::string Object(const std::string& name) {
    return Scene(R"("objects": [{"name": "o", "unit": "mm", "material": "mask", "file": ")" + name +
                 "\"}]");
  }
  static std::string Scene(const std::string& part) {
    const fs::path file =
        Write("scene/scene.json",
              R"({"schema": "retrolux/scene-1", "name": "s", "cameras": [{"name": "c",)"
              R"( "field_of_view_deg": [12, 9], "eye_mm": [0, 0, 900], "look_at_mm": [0, 0, 0],)"
              R"( "up": [1, 0, 0]}], )" +
                  part + "}");
    return MessageOf([&] { ReadSceneFile(file); });
  }
  static void Link(const std::string& to, const std::string& name) {
    fs::create_symlink(to, OwnFolder() / "scene" / name);
  }
};

TEST_F(Escapes, NamesOfASceneStayInItsFolder) {
  EXPECT_EQ(Object("in/mesh.ply"), "no error");
  EXPECT_EQ(Object("in/../in/mesh.ply"), "no error");
  for (const std::string name : {"../outside.ply", "in/../../outside.ply", "/etc/passwd"})
    EXPECT_THAT(Object(name), HasSubstr("a relative path that does not leave its folder"));
  Link("in/mesh.ply", "inside_link.ply");
  EXPECT_EQ(Object("inside_link.ply"), "no error");
  Link("../outside.ply", "link.ply");
  Link("..", "up");
  for (const std::string name : {"link.ply", "up/outside.ply"}) {
    EXPECT_THAT(Object(name), HasSubstr("/objects/0/file: found a link \"" + name +
                                        "\" that leaves the folder; expected a file below"));
  }
  EXPECT_THAT(Scene(R"("marker_set": "link.ply")"), HasSubstr("that leaves the folder"));
  EXPECT_THAT(
      Scene(R"("materials": {"m": {"type": "diffuse", "reflectance_texture": "link.ply"}})"),
      HasSubstr("that leaves the folder"));
  EXPECT_THAT(Scene(R"("ambient": {"spectrum": "../outside.ply"})"),
              HasSubstr("a relative path that does not leave its folder"));
  // The folder itself may be reached by a link.
  fs::create_symlink("scene", OwnFolder() / "linked");
  EXPECT_EQ(Object("in/mesh.ply"), "no error");
  EXPECT_EQ(MessageOf([] { ReadSceneFile(OwnFolder() / "linked/scene.json"); }), "no error");
}

TEST_F(Escapes, OnlyOrdinaryFilesAreRead) {
  fs::create_directory(OwnFolder() / "scene/folder.ply");
  ASSERT_EQ(::mkfifo((OwnFolder() / "scene/pipe.ply").c_str(), 0600), 0);
  for (const std::string name : {"folder.ply", "pipe.ply"}) {
    EXPECT_THAT(Object(name), HasSubstr("no ordinary file"));
    EXPECT_THAT(Scene("\"marker_set\": \"" + name + "\""), HasSubstr("no ordinary file"));
  }
  EXPECT_THAT(MessageOf([] { ReadTextFile("/dev/zero"); }),
              HasSubstr("/dev/zero: is no ordinary file; expected a file"));
  EXPECT_THAT(MessageOf([] { ReadSceneFile(OwnFolder() / "scene/pipe.ply"); }),
              HasSubstr("no ordinary file"));
}

TEST_F(Escapes, BuffersOfGltfStayInItsFolder) {
  Write("outside.bin", std::string(36, '\0'));
  const std::string text = Gltf("2.0", "2.0");
  const size_t begin = text.find("data:");
  const auto message = [&](const std::string& uri) {
    std::string changed = text;
    changed.replace(begin, text.find('"', begin) - begin, uri);
    const fs::path file = Write("scene/t.gltf", changed);
    return MessageOf([&] { GltfFile(file).Mesh(UpAxis::kZ); });
  };
  Link("../outside.bin", "link.bin");
  EXPECT_THAT(message("link.bin"), HasSubstr("a link \"link.bin\" that leaves the folder"));
  EXPECT_THAT(message("../outside.bin"), HasSubstr("that leaves the folder"));
  EXPECT_THAT(message("%2e%2e/outside.bin"), HasSubstr("t.gltf: "));
  EXPECT_THAT(message("/etc/passwd"), HasSubstr("cannot be read"));
}

TEST_F(Escapes, NamesOfAScenarioStayInItsFolder) {
  const auto message = [](const std::string& part) {
    const fs::path file = Write("scene/scenario.json", R"({"base": "1a", )" + part + "}");
    return MessageOf([&] { LoadScenario(file.string()); });
  };
  EXPECT_EQ(message(R"("name": "x")"), "no error");
  EXPECT_THAT(message(R"("masks": {"face": {"mesh": "../outside.ply"}})"),
              HasSubstr("/masks/face/mesh: a path \"../outside.ply\" that leaves the folder"));
  Write("outside.json", R"({"base": "1a"})");
  EXPECT_THAT(message(R"("base": "../outside.json")"), HasSubstr("/base"));
}

}  // namespace
}  // namespace retrolux
