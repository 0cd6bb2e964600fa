// Masks: the shapes that come with the program, meshes and clouds that users bring, what is found
// wrong with them, and surfaces through points.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <limits>

#include "core/atomic_file.h"
#include "core/error.h"
#include "renderer/ray_scene.h"
#include "scenes/built_in.h"
#include "scenes/gltf.h"
#include "scenes/masks.h"
#include "scenes/mesh_check.h"
#include "scenes/mesh_distance.h"
#include "scenes/mesh_import.h"
#include "scenes/mesh_reconstruct.h"
#include "scenes/mesh_shapes.h"
#include "scenes/mesh_weld.h"
#include "scenes/point_cloud.h"
#include "scenes/scene_json.h"
#include "tests/message_of.h"

namespace retrolux {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class MaskFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              fmt::format("mask_tests-{}-{}", ::getpid(),
                          ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path Write(const std::string& name, const std::string& text) const {
    WriteTextFile(folder_ / name, text);
    return folder_ / name;
  }

  fs::path folder_;
};

// --- files of a mesh, as other programs write them; coordinates are multiplied by `scale`

std::string PlyText(const TriangleMesh& mesh, float scale = 1.0f) {
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty "
      "float "
      "z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.positions.size(), mesh.triangles.size());
  for (const Vec3f& p : mesh.positions)
    text += fmt::format("{} {} {}\n", scale * p.x(), scale * p.y(), scale * p.z());
  for (const auto& t : mesh.triangles) text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  return text;
}

std::string ObjText(const TriangleMesh& mesh, float scale = 1.0f) {
  std::string text = "mtllib none.mtl\no mask\n";
  for (const Vec3f& p : mesh.positions)
    text += fmt::format("v {} {} {}\n", scale * p.x(), scale * p.y(), scale * p.z());
  for (const Vec3f& n : mesh.normals) text += fmt::format("vn {} {} {}\n", n.x(), n.y(), n.z());
  for (const auto& t : mesh.triangles) {
    text += "f";
    for (const uint32_t i : t)
      text += mesh.normals.empty() ? fmt::format(" {}", i + 1) : fmt::format(" {0}//{0}", i + 1);
    text += "\n";
  }
  return text;
}

// Binary: an 80-byte head, the number of facets, and for each its normal, corners and 2 bytes.
std::string StlBytes(const TriangleMesh& mesh, float scale = 1.0f) {
  std::string bytes(80, ' ');
  const auto append = [&](const void* data, size_t size) {
    bytes.append(static_cast<const char*>(data), size);
  };
  const auto count = static_cast<uint32_t>(mesh.triangles.size());
  append(&count, sizeof count);
  for (const auto& t : mesh.triangles) {
    const Vec3f zero = Vec3f::Zero();
    append(zero.data(), 12);
    for (const uint32_t i : t) {
      const Vec3f p = scale * mesh.positions[i];
      append(p.data(), 12);
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

void WriteMeshGlb(const TriangleMesh& mesh, const fs::path& file) {
  Scene scene;
  scene.name = "mask";
  scene.UseMaterial("mask");
  scene.objects.push_back({"mask", mesh, {}, "mask", false});
  WriteGlb(scene, UpAxis::kZ, file);
}

std::array<Vec3d, 3> Corners(const TriangleMesh& mesh, const std::array<uint32_t, 3>& t) {
  return {mesh.positions[t[0]].cast<double>(), mesh.positions[t[1]].cast<double>(),
          mesh.positions[t[2]].cast<double>()};
}

Vec3d TwiceArea(const std::array<Vec3d, 3>& p) {
  return (p[1] - p[0]).cross(p[2] - p[0]);
}

// --------------------------------------------------------------------------------- the shapes

TEST(FaceMask, HasTheThesisAreaAndVertices) {
  const TriangleMesh face = FaceMask();
  EXPECT_EQ(face.positions.size(), 2542u);
  EXPECT_EQ(face.normals.size(), 2542u);
  EXPECT_EQ(face.triangles.size(), 2u * 61 * 40);
  EXPECT_NEAR(face.Area(), 76459.0, 0.01);  // coordinates are floats
}

// Area of half an ellipsoid by Thomsen's formula, within 1.061 %; the flat triangles lie inside it.
TEST(FaceMask, WithoutReliefIsHalfAnEllipsoid) {
  FaceShape plain;
  plain.relief = 0.0;
  const TriangleMesh shell = FaceMask(plain);
  const MeshFindings findings = CheckMesh(shell);
  const double a = findings.max_corner.x(), b = findings.max_corner.y(),
               c = findings.max_corner.z();
  for (const Vec3f& p : shell.positions) {
    const Vec3d scaled = p.cast<double>().cwiseQuotient(Vec3d(a, b, c));
    EXPECT_NEAR(scaled.norm(), 1.0, 2e-3);  // the extreme vertices need not be the axes' ends
  }
  const double p = 1.6075;
  const double mean = (std::pow(a * b, p) + std::pow(b * c, p) + std::pow(c * a, p)) / 3.0;
  EXPECT_NEAR(shell.Area() / (2.0 * kPi * std::pow(mean, 1.0 / p)), 1.0, 0.015);
}

void ExpectWellMadeShell(const TriangleMesh& mesh) {
  double smallest = std::numeric_limits<double>::infinity(), largest = 0.0, sharpest_deg = 180.0;
  for (const auto& t : mesh.triangles) {
    const std::array<Vec3d, 3> p = Corners(mesh, t);
    const double area = 0.5 * TwiceArea(p).norm();
    smallest = std::min(smallest, area);
    largest = std::max(largest, area);
    for (size_t i = 0; i < 3; ++i) {
      const Vec3d u = p[(i + 1) % 3] - p[i], v = p[(i + 2) % 3] - p[i];
      sharpest_deg = std::min(sharpest_deg, DegFromRad(std::atan2(u.cross(v).norm(), u.dot(v))));
      EXPECT_GT(TwiceArea(p).normalized().dot(mesh.normals[t[i]].cast<double>()), 0.5);
    }
  }
  EXPECT_LT(largest / smallest, 10.0);
  EXPECT_GT(sharpest_deg, 10.0);
  const MeshFindings findings = CheckMesh(mesh);
  EXPECT_EQ(findings.holes, 1u);
  EXPECT_THAT(Warnings(findings), IsEmpty());
}

TEST(FaceMask, IsAWellMadeOutwardShell) {
  ExpectWellMadeShell(FaceMask());
}

TEST(BodyMask, IsAWellMadeOutwardShell) {
  const TriangleMesh body = BodyMask();
  ExpectWellMadeShell(body);
  EXPECT_NEAR(static_cast<double>(body.positions.size()), 2500.0, 50.0);
  const MeshFindings findings = CheckMesh(body);
  const Vec3d size = findings.max_corner - findings.min_corner;
  EXPECT_NEAR(size.x(), 450.0, 1.0);
  EXPECT_NEAR(size.y(), 360.0, 20.0);
  EXPECT_NEAR(size.z(), 110.0, 10.0);
}

void ExpectMirrorSymmetry(const TriangleMesh& mesh) {
  const TriangleMesh welded = WeldedExactly(mesh);
  TriangleMesh both = mesh;
  TriangleMesh mirrored = mesh;
  for (Vec3f& p : mirrored.positions) p.y() = -p.y();
  for (Vec3f& n : mirrored.normals) n.y() = -n.y();
  both.Append(mirrored);
  // Each mirrored vertex, normal included, is one of the mesh, bit for bit.
  EXPECT_EQ(WeldedExactly(both).positions.size(), welded.positions.size());
}

TEST(FaceMask, IsItsOwnMirrorImage) {
  ExpectMirrorSymmetry(FaceMask());
}

TEST(BodyMask, IsItsOwnMirrorImage) {
  ExpectMirrorSymmetry(BodyMask());
}

// Of the area that faces a camera at 1600 mm, the share that the face itself hides. A triangle is
// hidden if its centre is.
double HiddenShare(const TriangleMesh& mesh, double polar_deg, double azimuth_deg) {
  Scene scene;
  scene.objects.push_back({"mask", mesh, {}, "mask", false});
  const RayScene rays(scene);
  const double polar = RadFromDeg(polar_deg), azimuth = RadFromDeg(azimuth_deg);
  const Vec3d eye = 1600.0 * Vec3d(std::sin(polar) * std::cos(azimuth),
                                   std::sin(polar) * std::sin(azimuth), std::cos(polar));
  double facing = 0.0, hidden = 0.0;
  for (const auto& t : mesh.triangles) {
    const std::array<Vec3d, 3> p = Corners(mesh, t);
    const Vec3d cross = TwiceArea(p), centre = (p[0] + p[1] + p[2]) / 3.0;
    if (cross.dot(eye - centre) <= 0.0) continue;
    facing += cross.norm();
    const Vec3d above = centre + 0.01 * cross.normalized();
    if (rays.Occluded(eye.cast<float>(), above.cast<float>())) hidden += cross.norm();
  }
  return hidden / facing;
}

// The largest share over azimuths of the lower end of the rigs' polar angles, where it is largest.
double LargestHiddenShare(const FaceShape& shape) {
  constexpr double kSmallestPolar_deg = 31.67;
  const TriangleMesh face = FaceMask(shape);
  double largest = 0.0;
  for (int azimuth_deg = 0; azimuth_deg <= 180; azimuth_deg += 10)
    largest = std::max(largest, HiddenShare(face, kSmallestPolar_deg, azimuth_deg));
  return largest;
}

TEST(FaceMask, HidesPartsOfItselfFromRigCameras) {
  FaceShape shape;
  EXPECT_GT(LargestHiddenShare(shape), 0.05);
  shape.relief = 1.0;
  EXPECT_GT(LargestHiddenShare(shape), 0.06);
  shape.relief = 0.0;
  EXPECT_LT(LargestHiddenShare(shape), 0.002);  // centres of facets at the limb
}

TEST(Masks, AreFoundByName) {
  EXPECT_THAT(MaskNames(), ::testing::ElementsAre("face", "body", "oval", "sphere"));
  for (const std::string& name : MaskNames()) EXPECT_GT(MakeMask(name).Area(), 5e4) << name;
  EXPECT_EQ(MessageOf([] { MakeMask("fase"); }), "no mask 'fase'; expected 'face'");
  EXPECT_EQ(MessageOf([] { MakeMask("hand-made"); }),
            "no mask 'hand-made'; expected one of face, body, oval, sphere");
}

// --------------------------------------------------------------------------------- import

TEST_F(MaskFiles, AllFormatsGiveTheMeshBack) {
  const TriangleMesh face = FaceMask();
  WriteMeshGlb(face, folder_ / "face.glb");
  const TriangleMesh glb = ImportMesh(folder_ / "face.glb", LengthUnit::kMetre);
  const TriangleMesh ply = ImportMesh(Write("face.ply", PlyText(face)), LengthUnit::kMillimetre);
  const TriangleMesh obj = ImportMesh(Write("face.OBJ", ObjText(face)), LengthUnit::kMillimetre);
  const TriangleMesh stl = ImportMesh(Write("face.stl", StlBytes(face)), LengthUnit::kMillimetre);
  for (const TriangleMesh* mesh : {&glb, &ply, &obj, &stl}) {
    EXPECT_EQ(mesh->positions.size(), face.positions.size());
    EXPECT_EQ(mesh->triangles.size(), face.triangles.size());
    EXPECT_NEAR(mesh->Area(), face.Area(), 0.1);
    const MeshFindings findings = CheckMesh(*mesh);
    EXPECT_EQ(findings.holes, 1u);
    EXPECT_THAT(Warnings(findings), IsEmpty());
    EXPECT_NEAR(findings.max_corner.x(), CheckMesh(face).max_corner.x(), 1e-3);
  }
  EXPECT_EQ(glb.normals.size(), face.normals.size());
  EXPECT_EQ(obj.normals.size(), face.normals.size());
  EXPECT_TRUE(ply.normals.empty());
  EXPECT_TRUE(stl.normals.empty());
}

TEST_F(MaskFiles, UnitsScale) {
  const TriangleMesh face = FaceMask();
  const double area = face.Area();
  const fs::path cm = Write("cm.ply", PlyText(face, 0.1f)),
                 m = Write("m.stl", StlBytes(face, 1e-3f));
  EXPECT_NEAR(ImportMesh(cm, LengthUnit::kCentimetre).Area(), area, 0.1);
  EXPECT_NEAR(ImportMesh(m, LengthUnit::kMetre).Area(), area, 0.1);
  EXPECT_NEAR(ImportMesh(cm, LengthUnit::kMillimetre).Area(), 0.01 * area, 0.1);
  EXPECT_EQ(ParseLengthUnit("cm"), LengthUnit::kCentimetre);
  EXPECT_EQ(MessageOf([] { ParseLengthUnit("inch"); }), "unit 'inch'; expected one of mm, cm, m");
}

TEST_F(MaskFiles, GltfIsInMetres) {
  WriteMeshGlb(FaceMask(), folder_ / "face.glb");
  EXPECT_THAT(MessageOf([&] { ImportMesh(folder_ / "face.glb", LengthUnit::kMillimetre); }),
              HasSubstr("glTF is in metres by definition"));
}

// Both byte orders, doubles, normals, elements and properties that are skipped, a quadrilateral.
TEST_F(MaskFiles, BinaryPly) {
  for (const bool big : {false, true}) {
    std::string bytes = fmt::format(
        "ply\nformat binary_{}_endian 1.0\ncomment c\nelement camera 1\nproperty list uchar float "
        "k\n"
        "element vertex 4\nproperty double x\nproperty double y\nproperty double z\nproperty uchar "
        "red\nproperty float nx\nproperty float ny\nproperty float nz\nelement face 1\nproperty "
        "list "
        "uchar uint vertex_indices\nend_header\n",
        big ? "big" : "little");
    const auto append = [&]<typename T>(T value) {
      std::array<char, sizeof(T)> raw;
      std::memcpy(raw.data(), &value, sizeof(T));
      if (big) std::reverse(raw.begin(), raw.end());
      bytes.append(raw.data(), raw.size());
    };
    append(uint8_t{2}), append(1.0f), append(2.0f);
    for (const Vec2d& p : {Vec2d(0, 0), Vec2d(200, 0), Vec2d(200, 100), Vec2d(0, 100)}) {
      append(p.x()), append(p.y()), append(7.0), append(uint8_t{255});
      append(0.0f), append(0.0f), append(2.0f);
    }
    append(uint8_t{4});
    for (uint32_t i = 0; i < 4; ++i) append(i);
    const TriangleMesh mesh = ImportMesh(Write("quad.ply", bytes), LengthUnit::kMillimetre);
    EXPECT_NEAR(mesh.Area(), 20000.0, 1e-6);
    EXPECT_EQ(mesh.positions[2], Vec3f(200, 100, 7));
    EXPECT_EQ(mesh.normals[2], Vec3f(0, 0, 1));
    const fs::path cut = Write("cut.ply", bytes.substr(0, bytes.size() - 1));
    EXPECT_THAT(MessageOf([&] { ImportMesh(cut, LengthUnit::kMillimetre); }),
                HasSubstr("face 0: the end of the file"));
  }
}

TEST_F(MaskFiles, PolygonsBecomeTriangles) {
  const fs::path file =
      Write("quad.obj", "v 0 0 0\nv 200 0 0\nv 200 100 0\nv 0 100 0\nf 1 2 3 4\n");
  const TriangleMesh mesh = ImportMesh(file, LengthUnit::kMillimetre);
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_NEAR(mesh.Area(), 20000.0, 1e-6);
}

TEST_F(MaskFiles, WhatIsNoMeshIsRefused) {
  const auto import = [&](const std::string& name, const std::string& text) {
    const fs::path file = Write(name, text);
    return MessageOf([&] { ImportMesh(file, LengthUnit::kMillimetre); });
  };
  EXPECT_THAT(import("a.step", "x"),
              HasSubstr("the extension '.step'; expected .glb, .gltf, .ply"));
  EXPECT_THAT(import("text.ply", "no picture"),
              HasSubstr("text.ply: line 1: 'the end of the file'; expected"));
  EXPECT_THAT(import("empty.stl", ""), HasSubstr("empty.stl: cannot be read"));
  EXPECT_THAT(import("cut.stl", StlBytes(FaceMask()).substr(0, 5000)), HasSubstr("cannot be read"));
  EXPECT_THAT(import("cut.ply", PlyText(FaceMask()).substr(0, 5000)), HasSubstr("cut.ply: vertex"));
  EXPECT_THAT(import("index.ply",
                     "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty "
                     "float y\nproperty float z\nelement face 1\nproperty list uchar int "
                     "vertex_index\nend_header\n0 0 0\n3 0 1 2\n"),
              HasSubstr("vertex 2; expected one below 1"));
  EXPECT_THAT(import("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), HasSubstr("no triangles"));
  EXPECT_THAT(import("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"),
              HasSubstr("without area"));
  TriangleMesh broken = FaceMask();
  broken.positions[7].z() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(import("nan.stl", StlBytes(broken)), HasSubstr("finite coordinates"));
  EXPECT_THAT(MessageOf([&] { ImportMesh(folder_ / "gone.ply", LengthUnit::kMillimetre); }),
              HasSubstr("gone.ply: cannot be read"));
  EXPECT_THAT(MessageOf([&] { ImportMesh(folder_, LengthUnit::kMillimetre); }),
              HasSubstr("expected"));
}

TEST_F(MaskFiles, SceneObjectsMayBePly) {
  const TriangleMesh face = FaceMask();
  Write("face.ply", PlyText(face, 0.1f));
  const auto scene_with = [](const std::string& object) {
    return R"({"schema": "retrolux/scene-1", "name": "s", "objects": [{"name": "mask", )" + object +
           R"(, "material": "mask"}], "cameras": [{"name": "c", "size": [64, 48],)"
           R"( "field_of_view_deg": [12, 9], "eye_mm": [1600, 0, 0], "look_at_mm": [0, 0, 0],)"
           R"( "up": [0, 0, 1]}]})";
  };
  const fs::path good = Write("good.json", scene_with(R"("file": "face.ply", "unit": "cm")"));
  EXPECT_NEAR(ReadSceneFile(good).Object("mask").mesh.Area(), face.Area(), 0.1);
  const fs::path no_unit = Write("no_unit.json", scene_with(R"("file": "face.ply")"));
  EXPECT_THAT(MessageOf([&] { ReadSceneFile(no_unit); }), HasSubstr("unit"));
}

TEST(Weld, SmoothNormalsOfASphereAreRadial) {
  TriangleMesh sphere = EllipsoidMesh(Vec3d::Constant(100.0), 3);
  sphere.normals.clear();
  for (const TriangleMesh smooth = WithSmoothNormals(sphere); const Vec3f& p : smooth.positions) {
    const auto i = static_cast<size_t>(&p - smooth.positions.data());
    EXPECT_GT(smooth.normals[i].dot(p.normalized()), 0.9999f);
  }
}

// --------------------------------------------------------------------------------- checks

TEST(CheckMesh, ASphereIsClosedAndFaultless) {
  const MeshFindings findings = CheckMesh(EllipsoidMesh(Vec3d::Constant(100.0), 3));
  EXPECT_EQ(findings.holes, 0u);
  EXPECT_EQ(findings.boundary_edges, 0u);
  EXPECT_EQ(findings.pieces, 1u);
  EXPECT_THAT(Warnings(findings), IsEmpty());
}

TEST(CheckMesh, CountsHolesAndTheirEdges) {
  TriangleMesh face = FaceMask();
  const size_t rim = CheckMesh(face).boundary_edges;
  EXPECT_EQ(rim, 2u * (61 + 40));
  face.triangles.erase(face.triangles.begin() + 2500);
  face.triangles.erase(face.triangles.begin() + 1000);
  const MeshFindings findings = CheckMesh(face);
  EXPECT_EQ(findings.holes, 3u);
  EXPECT_EQ(findings.boundary_edges, rim + 6);
  EXPECT_THAT(Warnings(findings), Contains(HasSubstr("3 holes")));
}

TEST(CheckMesh, FindsShellsThatAreInsideOut) {
  for (const std::string& name : MaskNames()) {
    TriangleMesh mesh = MakeMask(name);
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    const MeshFindings findings = CheckMesh(mesh);
    EXPECT_EQ(findings.inside_out_pieces, 1u) << name;
    EXPECT_EQ(findings.opposed_normals, mesh.triangles.size()) << name;
    EXPECT_THAT(Warnings(findings), Contains(HasSubstr("inside out"))) << name;
  }
}

// Wherever the mesh lies: the rule must not depend on the origin.
TEST(CheckMesh, InsideOutDoesNotDependOnTheOrigin) {
  TriangleMesh face = FaceMask();
  for (Vec3f& p : face.positions) p += Vec3f(-3000, 2000, 500);
  EXPECT_EQ(CheckMesh(face).inside_out_pieces, 0u);
  for (auto& t : face.triangles) std::swap(t[1], t[2]);
  EXPECT_EQ(CheckMesh(face).inside_out_pieces, 1u);
}

TEST(CheckMesh, AFlatSheetHasNoOutside) {
  TriangleMesh sheet = RectangleMesh({0, 0, 0}, {200, 0, 0}, {0, 100, 0});
  EXPECT_EQ(CheckMesh(sheet).inside_out_pieces, 0u);
  for (auto& t : sheet.triangles) std::swap(t[1], t[2]);
  EXPECT_EQ(CheckMesh(sheet).inside_out_pieces, 0u);
}

TEST(CheckMesh, FindsOneFlippedTriangle) {
  TriangleMesh face = FaceMask();
  std::swap(face.triangles[2000][1], face.triangles[2000][2]);
  const MeshFindings findings = CheckMesh(face);
  EXPECT_EQ(findings.inconsistent_edges, 3u);
  EXPECT_EQ(findings.opposed_normals, 1u);
  EXPECT_THAT(Warnings(findings), Contains(HasSubstr("wound against each other")));
}

TEST(CheckMesh, FindsDuplicatesPiecesInnerWallsAndSlivers) {
  TriangleMesh mesh = BoxMesh({0, 0, 0}, {100, 100, 100});  // four corners of its own for each side
  EXPECT_EQ(CheckMesh(mesh).duplicate_vertices, 16u);
  EXPECT_EQ(CheckMesh(WeldedExactly(mesh)).duplicate_vertices, 0u);
  mesh = WeldedExactly(mesh);
  mesh.Append(BoxMesh({300, 0, 0}, {400, 100, 100}));
  EXPECT_EQ(CheckMesh(mesh).pieces, 2u);
  mesh.triangles.push_back({mesh.triangles[0][0], mesh.triangles[0][1], mesh.triangles[6][0]});
  EXPECT_GT(CheckMesh(mesh).non_manifold_edges, 0u);
  mesh.triangles.push_back({0, 1, 1});
  EXPECT_EQ(CheckMesh(mesh).degenerate_triangles, 1u);
}

TEST(CheckMesh, AbsurdSizesSuggestTheUnit) {
  TriangleMesh face = FaceMask();
  for (Vec3f& p : face.positions) p *= 0.1f;
  EXPECT_THAT(Warnings(CheckMesh(face)), Contains(HasSubstr("10 times as long")));
  for (Vec3f& p : face.positions) p *= 0.01f;
  EXPECT_THAT(Warnings(CheckMesh(face)), Contains(HasSubstr("1000 times as long")));
  for (Vec3f& p : face.positions) p *= 1e6f;
  EXPECT_THAT(Warnings(CheckMesh(face)), Contains(HasSubstr("1000 times shorter")));
}

// --------------------------------------------------------------------------------- clouds

TEST_F(MaskFiles, CloudsComeBackAsWritten) {
  const std::vector<Vec3f> points = SampleSurface(FaceMask(), 500, 0.3, 1);
  WritePointCloud(points, folder_ / "cloud.ply");
  WritePointCloud(points, folder_ / "cloud.xyz");
  for (const char* name : {"cloud.ply", "cloud.xyz"}) {
    const std::vector<Vec3f> read = ReadPointCloud(folder_ / name, LengthUnit::kMillimetre);
    ASSERT_EQ(read.size(), points.size()) << name;
    for (size_t i = 0; i < read.size(); ++i) EXPECT_LT((read[i] - points[i]).norm(), 1e-4f);
  }
  std::string obj;
  for (const Vec3f& p : points) obj += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
  EXPECT_EQ(ReadPointCloud(Write("cloud.obj", obj), LengthUnit::kMillimetre).size(), points.size());
}

TEST_F(MaskFiles, TextCloudsMayHaveNormalsAndComments) {
  const fs::path file = Write("c.txt", "# head\n\n1, 2, 3\n4;5;6 # end\r\n7\t8\t9 0 0 1\n");
  const std::vector<Vec3f> points = ReadPointCloud(file, LengthUnit::kCentimetre);
  ASSERT_EQ(points.size(), 3u);
  EXPECT_EQ(points[2], Vec3f(70, 80, 90));
  const auto read = [&](const std::string& text) {
    const fs::path bad = Write("bad.xyz", text);
    return MessageOf([&] { ReadPointCloud(bad, LengthUnit::kMillimetre); });
  };
  EXPECT_THAT(read("1 2 3\n1 2\n"), HasSubstr("bad.xyz: line 2: '1 2'; expected x y z"));
  EXPECT_THAT(read("1 2 nan\n"), HasSubstr("line 1"));
  EXPECT_THAT(read("1 2 3x\n"), HasSubstr("line 1"));
  EXPECT_THAT(read("# nothing\n"), HasSubstr("no points"));
}

TEST(SampleSurface, IsEvenByAreaAndNoisyAsAsked) {
  const TriangleMesh sphere = EllipsoidMesh(Vec3d::Constant(100.0), 5);
  const std::vector<Vec3f> points = SampleSurface(sphere, 20000, 0.3, 7);
  Vec3d mean = Vec3d::Zero();
  double radial = 0.0;
  for (const Vec3f& p : points) {
    mean += p.cast<double>() / 20000.0;
    radial += std::pow(p.cast<double>().norm() - 100.0, 2) / 20000.0;
  }
  EXPECT_LT(mean.norm(), 2.0);  // sigma of an axis is 100 / sqrt(3 * 20000) = 0.41 mm
  // One in sqrt(2 * 20000) = 0.5 %; the flat triangles are up to 0.03 mm inside.
  EXPECT_NEAR(std::sqrt(radial), 0.3, 0.008);
}

// --------------------------------------------------------------------------------- reconstruction

TEST(DistanceBetween, ConcentricSpheres) {
  const TriangleMesh inner = EllipsoidMesh(Vec3d::Constant(99.0), 4);
  const TriangleMesh outer = EllipsoidMesh(Vec3d::Constant(100.0), 5);
  const DistanceSummary distance = DistanceBetween(inner, outer);
  EXPECT_EQ(distance.samples, inner.positions.size() + inner.triangles.size());
  EXPECT_NEAR(distance.mean_mm, 1.0, 0.1);  // centres of triangles lie up to 0.12 mm inside
  EXPECT_LE(distance.mean_mm, distance.rms_mm);
  EXPECT_LE(distance.rms_mm, distance.max_mm);
}

// docs/masks.md tells the figures; here they have some air.
TEST(Reconstruct, FaceFromNoisyPoints) {
  const TriangleMesh face = FaceMask();
  const Reconstruction result = ReconstructSurface(SampleSurface(face, 20000, 0.3, 1));
  const DistanceSummary to_face = DistanceBetween(result.mesh, face);
  const DistanceSummary from_face = DistanceBetween(face, result.mesh);
  const auto report = [](const char* name, const DistanceSummary& d) {
    fmt::print("{}: mean {:.3f}, RMS {:.3f}, 95 % {:.3f}, max {:.3f} mm\n", name, d.mean_mm,
               d.rms_mm, d.percentile95_mm, d.max_mm);
  };
  report("reconstruction to face", to_face);
  report("face to reconstruction", from_face);
  fmt::print("area ratio {:.4f}\n", result.mesh.Area() / face.Area());
  EXPECT_LT(to_face.rms_mm, 0.12);  // of points with 0.3 mm noise
  EXPECT_LT(to_face.percentile95_mm, 0.25);
  EXPECT_LT(to_face.max_mm, 1.2);
  EXPECT_LT(from_face.rms_mm, 0.25);  // with the rim, which lies up to a spacing beyond the points
  EXPECT_LT(from_face.max_mm, 3.5);
  EXPECT_NEAR(result.mesh.Area() / face.Area(), 0.993, 0.01);
  const MeshFindings findings = CheckMesh(result.mesh);
  EXPECT_EQ(findings.pieces, 1u);
  EXPECT_EQ(findings.holes, 1u);
  EXPECT_EQ(findings.inside_out_pieces, 0u);
  EXPECT_EQ(findings.inconsistent_edges, 0u);
  EXPECT_EQ(findings.opposed_normals, 0u);
}

TEST(Reconstruct, DoesNotDependOnTheOrderOfThePoints) {
  std::vector<Vec3f> points = SampleSurface(FaceMask(), 3000, 0.1, 2);
  const TriangleMesh first = ReconstructSurface(points).mesh;
  std::reverse(points.begin(), points.end());
  const TriangleMesh second = ReconstructSurface(points).mesh;
  EXPECT_EQ(first.positions, second.positions);
  EXPECT_EQ(first.triangles, second.triangles);
}

TEST(Reconstruct, ExactPointsStayWhereTheyAre) {
  const TriangleMesh sphere = EllipsoidMesh(Vec3d::Constant(100.0), 4);
  ReconstructOptions exact;
  exact.smoothing_iterations = 0;
  const TriangleMesh mesh = ReconstructSurface(sphere.positions, exact).mesh;
  EXPECT_EQ(mesh.positions.size(), sphere.positions.size());
  EXPECT_EQ(CheckMesh(mesh).holes, 0u);
  EXPECT_NEAR(mesh.Area() / sphere.Area(), 1.0, 1e-3);
}

TEST(Reconstruct, RefusesWhatIsNoCloudOfASurface) {
  EXPECT_THAT(MessageOf([] { ReconstructSurface(std::vector<Vec3f>(50, Vec3f(1, 2, 3))); }),
              HasSubstr("a cloud of 1 different points; expected at least 12"));
  std::vector<Vec3f> line;
  for (int i = 0; i < 50; ++i) line.emplace_back(static_cast<float>(i), 0.0f, 0.0f);
  EXPECT_THAT(MessageOf([&] { ReconstructSurface(line); }), HasSubstr("lie in a plane"));
  ReconstructOptions options;
  options.max_edge_mm = -1.0;
  EXPECT_THAT(MessageOf([&] { options.Check(); }), HasSubstr("--max-edge-mm -1"));
}

}  // namespace
}  // namespace retrolux
