// What a surface has below its mesh: holes and textures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/atomic_file.h"
#include "core/image_file.h"
#include "core/rng.h"
#include "renderer/path_tracer.h"
#include "renderer/ray_scene.h"
#include "scenes/built_in.h"
#include "scenes/mesh_shapes.h"
#include "scenes/scene_json.h"
#include "scenes/scene_parts.h"
#include "tests/message_of.h"
#include "tests/own_folder.h"

namespace retrolux {
namespace {

// Four standard deviations of a share that n independent points estimate: 6e-5 to be exceeded.
double FourSigma(double share, int n) {
  return 4.0 * std::sqrt(share * (1.0 - share) / n);
}

double Unit(KeyedRng& rng) {
  return static_cast<double>(rng.NextFloat());
}

// --- perforation ---

TEST(HolePattern, OpensThePrintedShareOfASphere) {
  // The map onto the flat sheet scales holes and cells alike, so everywhere the share
  // (pi / (2 sqrt 3)) (d / p)^2 of the surface is open: 0.3543 for 3 mm every 4.8 mm.
  Perforation sheet;
  sheet.thickness_mm = 0.0;
  sheet.axis = {0.3, -1.0, 0.2};
  sheet.centre = {10, 20, 30};
  EXPECT_NEAR(sheet.OpenShare(), 0.35426, 1e-5);
  const HolePattern pattern(sheet);
  KeyedRng rng(5);
  constexpr int kPoints = 200000;
  int open = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double z = 2.0 * Unit(rng) - 1.0, phi = 2.0 * kPi * Unit(rng);
    const double across = std::sqrt(1.0 - z * z);
    const Vec3d n(across * std::cos(phi), across * std::sin(phi), z);
    if (pattern.LetsPass(sheet.centre + 100.0 * n, -n, n)) ++open;
  }
  EXPECT_NEAR(static_cast<double>(open) / kPoints, sheet.OpenShare(),
              FourSigma(sheet.OpenShare(), kPoints));
}

TEST(HolePattern, ThickSheetsShadeObliqueRays) {
  // Seen at the angle a, the far end of a hole is shifted by t tan a: what is left open is the lens
  // that two circles of diameter d have in common, (2 / pi) (acos q - q sqrt(1 - q^2)) of one, with
  // q = t tan(a) / d. A piece of 100 mm so far from the centre (100 m) that it is flat.
  const Perforation sheet;
  Perforation flat = sheet;
  flat.centre = {-1e5, 0, 0};
  const HolePattern pattern(flat);
  const Vec3d normal = Vec3d::UnitX();
  constexpr int kPoints = 200000;
  for (const double deg : {0.0, 20.0, 40.0, 60.0}) {
    KeyedRng rng(6);
    const Vec3d direction(-std::cos(RadFromDeg(deg)), 0.6 * std::sin(RadFromDeg(deg)),
                          0.8 * std::sin(RadFromDeg(deg)));
    int open = 0;
    for (int i = 0; i < kPoints; ++i) {
      const Vec3d x(0, 100.0 * Unit(rng), 100.0 * Unit(rng));
      const bool passes = pattern.LetsPass(x, direction, normal);
      ASSERT_EQ(passes, pattern.LetsPass(x, -direction, normal)) << "not reciprocal";
      open += passes ? 1 : 0;
    }
    const double q = std::min(1.0, 2.4 * std::tan(RadFromDeg(deg)) / 3.0);
    const double expected =
        sheet.OpenShare() * 2.0 / kPi * (std::acos(q) - q * std::sqrt(1.0 - q * q));
    EXPECT_NEAR(static_cast<double>(open) / kPoints, expected, FourSigma(expected, kPoints) + 1e-9)
        << deg;
  }
}

// A perforated plate of 200 mm in the plane x = 0, seen from +x, with a marker in the middle.
Scene PerforatedPlate(bool dark) {
  Scene scene;
  scene.name = "plate";
  AddObject(scene, "plate", RectangleMesh({0, -100, -100}, {0, 200, 0}, {0, 0, 200}), "mask");
  scene.objects[0].perforation = Perforation{};
  scene.objects[0].perforation->centre = {-1e5, 0, 0};
  scene.markers.push_back({"marker", 4, "plate", Vec3d::Zero()});
  scene.markers[0].dark = dark;
  scene.UseMaterial("retro_bead");
  scene.cameras.push_back(ThesisCamera("camera", {1600, 0, 0}, Vec3d::UnitZ()));
  return scene;
}

TEST(Perforation, RaysPassTheHolesButNotUnderMarkers) {
  // Single rays, packets and shadow rays say the same; of those beside the marker the printed share
  // passes, of those that meet it none.
  for (const bool dark : {false, true}) {
    const Scene scene = PerforatedPlate(dark);
    const RayScene rays(scene);
    const PlacedMarker marker = PlaceMarkers(scene)[0];
    KeyedRng rng(7);
    const Vec3f origin(1600, 0, 0);
    std::vector<Vec3f> directions;
    for (int i = 0; i < 100000; ++i) {
      const Vec3f target(0, 60.0f * rng.NextFloat() - 30.0f, 60.0f * rng.NextFloat() - 30.0f);
      directions.push_back((target - origin) / 1600.0f);
    }
    std::vector<RayScene::PacketHit> packets(directions.size());
    rays.IntersectPacket(origin, directions, packets);
    int beside = 0, passed = 0, covered = 0;
    for (size_t i = 0; i < directions.size(); ++i) {
      const Vec3f target = origin + 1600.0f * directions[i];
      const bool hit = rays.Intersect(origin, directions[i].normalized()).has_value();
      ASSERT_EQ(hit, packets[i].body != RayScene::PacketHit::kNone);
      ASSERT_EQ(hit, rays.Occluded(origin, Vec3f(origin + 2.0f * (target - origin))));
      const auto place = marker.Locate(target.cast<double>(), Vec3d::UnitX());
      if (place && (dark || marker.IsBright(*place))) {
        ASSERT_TRUE(hit);
        ++covered;
      } else {
        ++beside;
        passed += hit ? 0 : 1;
      }
    }
    EXPECT_GT(covered, dark ? 6000 : 2500);
    // The rays are up to 1.5 degrees oblique, which closes 2.6 % of the holes at most.
    const double share = scene.objects[0].perforation->OpenShare();
    const double measured = static_cast<double>(passed) / beside;
    EXPECT_LT(measured, share + FourSigma(share, beside));
    EXPECT_GT(measured, 0.974 * share - FourSigma(share, beside));
  }
}

// --- textures ---

// 2 x 1 pixels: black and white.
std::string BlackAndWhite() {
  return EncodeGreyPng({[] {
                          Plane<uint16_t> dn(2, 1);
                          dn.data = {0, 255};
                          return dn;
                        }(),
                        8});
}

TEST(Texture, InterpolatesAndRepeats) {
  // Pixel centres at u = 1/4 and 3/4; half way between them a half; at the border between the last
  // pixel and the first again.
  const Texture texture("t.png", BlackAndWhite());
  EXPECT_NEAR(static_cast<double>(texture.At({0.25f, 0.5f})), 0.0, 1e-6);
  EXPECT_NEAR(static_cast<double>(texture.At({0.75f, 0.1f})), 1.0, 1e-6);
  EXPECT_NEAR(static_cast<double>(texture.At({0.5f, 0.9f})), 0.5, 1e-6);
  EXPECT_NEAR(static_cast<double>(texture.At({0.0f, 0.5f})), 0.5, 1e-6);
  EXPECT_NEAR(static_cast<double>(texture.At({-1.25f, 7.5f})), 1.0, 1e-6);
  EXPECT_NEAR(static_cast<double>(texture.At({1.65f, 0.5f})), 0.8, 1e-6);
}

TEST(Texture, IntegersAreSrgbFloatsAreLinear) {
  // sRGB 188 is ((188/255 + 0.055) / 1.055)^2.4 = 0.50289.
  Plane<uint16_t> dn(1, 1);
  dn.data = {188};
  EXPECT_NEAR(static_cast<double>(Texture("t.png", EncodeGreyPng({dn, 8})).At({0, 0})), 0.50289,
              1e-5);
  FloatPlane plane(1, 1, 0.25f);
  const auto file = OwnFolder() / "t.exr";
  WriteExr(file, {{{"Y", plane}}, {}});
  EXPECT_EQ(Texture(file, ReadTextFile(file)).At({0, 0}), 0.25f);
  EXPECT_THAT(MessageOf([] { Texture("t.png", "no picture"); }), testing::HasSubstr("t.png"));
}

// A square of 200 mm, one material, texture from black at -y to white at +y, in an even light of 1
// W/(m2 sr).
Scene TexturedPlate(const std::string& material, const std::filesystem::path& folder) {
  WriteTextFile(folder / "bw.png", BlackAndWhite());
  Scene scene;
  scene.name = "plate";
  scene.materials["t"] = ReadMaterial("t", JsonReader::FromText(material, folder / "scene.json"));
  TriangleMesh mesh = RectangleMesh({0, -100, -100}, {0, 200, 0}, {0, 0, 200});
  for (const Vec3f& p : mesh.positions)
    mesh.uvs.emplace_back(0.25f + 0.0025f * (p.y() + 100.0f), 0.5f);
  scene.objects.push_back({"plate", mesh, {}, "t"});
  scene.cameras.push_back(ThesisCamera("camera", {1600, 0, 0}, Vec3d::UnitZ()));
  scene.cameras[0].ring.reset();
  scene.ambient.environment_w_m2_sr = 1.0;
  scene.exposure.time_s = 1e-3;
  scene.UseMaterial("retro_bead");
  return scene;
}

// Mean band radiance towards +x of the place (0, y, 0), and its standard error.
std::pair<double, double> RadianceAt(const Scene& scene, float y) {
  const RayScene rays(scene);
  const Lights lights(scene, rays, RingChoice::kAll, "camera");
  const CameraResponse response(scene.cameras[0], lights.Spectra(), 1e-3);
  const std::vector<PlacedMarker> no_markers;
  const PathTracer tracer(scene, rays, lights, response, no_markers, {});
  constexpr int kSamples = 4096;
  double sum = 0.0, sum2 = 0.0;
  for (uint32_t s = 0; s < kSamples; ++s) {
    PixelSampler sampler(Mix64(11), s);
    const Spectral nm = response.SampleWavelengths(sampler.Next1D(), 1.0f);
    const auto value = static_cast<double>(
        tracer.TracePath({500, y, 0}, -Vec3f::UnitX(), nm, sampler).radiance.sum());
    sum += value;
    sum2 += value * value;
  }
  const double mean = sum / kSamples;
  return {mean, std::sqrt(std::max(0.0, sum2 / kSamples - mean * mean) / kSamples)};
}

TEST(Texture, ScalesTheReflectance) {
  // A flat plate in even light of radiance L sends back rho t L where it is diffuse; a coated one
  // what its coat reflects without body, plus t times what the body adds.
  const std::string diffuse =
      R"({"type": "diffuse", "reflectance": 0.6, "reflectance_texture": "bw.png"})";
  const Scene scene = TexturedPlate(diffuse, OwnFolder());
  const double even = RadianceAt(scene, 100.0f).first / 0.6;  // band share of the light's spectrum
  for (const float y : {-100.0f, -50.0f, 0.0f, 80.0f}) {
    const auto [mean, error] = RadianceAt(scene, y);
    const double share = (static_cast<double>(y) + 100.0) / 200.0;
    EXPECT_NEAR(mean, 0.6 * share * even, 4.0 * error + 1e-5 * even) << y;
  }
  const Scene coated = TexturedPlate(
      R"({"type": "coated_diffuse", "reflectance": 0.7, "reflectance_texture": "bw.png"})",
      OwnFolder());
  const auto [black, black_error] = RadianceAt(coated, -100.0f);
  const auto [white, white_error] = RadianceAt(coated, 100.0f);
  const auto [grey, grey_error] = RadianceAt(coated, -60.0f);
  EXPECT_GT(black, 0.03 * even);  // the coat's own
  EXPECT_NEAR(grey, black + 0.2 * (white - black),
              4.0 * (grey_error + black_error + 0.2 * white_error));
}

TEST(Texture, WrongUsesAreRefused) {
  const auto folder = OwnFolder();
  const auto read = [&](const std::string& text) {
    return MessageOf([&] { ReadMaterial("t", JsonReader::FromText(text, folder / "scene.json")); });
  };
  WriteTextFile(folder / "bw.png", BlackAndWhite());
  EXPECT_THAT(read(R"({"type": "absorber", "reflectance_texture": "bw.png"})"),
              testing::HasSubstr("a texture on 'absorber'"));
  EXPECT_THAT(read(R"({"type": "diffuse", "reflectance_texture": "none.png"})"),
              testing::HasSubstr("none.png"));
  EXPECT_THAT(read(R"({"type": "diffuse", "reflectance_texture": "../bw.png"})"),
              testing::HasSubstr("does not leave its folder"));
  Scene scene = TexturedPlate(R"({"type": "diffuse", "reflectance_texture": "bw.png"})", folder);
  scene.objects[0].mesh.uvs.clear();
  EXPECT_THAT(MessageOf([&] { CheckScene(scene, "scene.json"); }),
              testing::HasSubstr("a mesh with texture coordinates"));
}

TEST(SceneFile, TexturesAndHolesReadBackEqual) {
  const auto folder = OwnFolder() / "exported";
  Scene scene =
      TexturedPlate(R"({"type": "diffuse", "reflectance_texture": "bw.png"})", OwnFolder());
  scene.objects[0].perforation = Perforation{2.0, 5.3, 1.0, {0, 0, 1}, {1, 2, 3}};
  ExportScene(scene, folder);
  const Scene read = LoadScene(folder.string());
  EXPECT_EQ(SceneHash(scene), SceneHash(read));
  EXPECT_EQ(read.objects[0].mesh.uvs, scene.objects[0].mesh.uvs);
  ASSERT_TRUE(read.objects[0].perforation.has_value());
  EXPECT_EQ(read.objects[0].perforation->axis, Vec3d(0, 0, 1));
  ASSERT_NE(read.materials.at("t").texture, nullptr);
  EXPECT_EQ(read.materials.at("t").texture->Bytes(), BlackAndWhite());
  Scene other = scene;
  other.objects[0].perforation->pitch_mm = 5.4;
  EXPECT_NE(SceneHash(other), SceneHash(scene));
}

}  // namespace
}  // namespace retrolux
