// Materials of glTF files: those of others against closed forms of the model that they are written
// in, ours back unchanged, and what would give a wrong picture refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/atomic_file.h"
#include "core/image_file.h"
#include "scenes/gltf.h"
#include "scenes/gltf_surface.h"
#include "scenes/scene_json.h"
#include "tests/bsdf_testing.h"
#include "tests/message_of.h"
#include "tests/own_folder.h"

namespace retrolux {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// One triangle, (0, 0, 0), (1, 0, 0), (0, 2, 0) m, in a node "n", with the materials given; its
// primitive has the first.
class GltfMaterial : public testing::Test {
 protected:
  GltfMaterial() {
    const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 2, 0};
    WriteTextFile(folder_ / "data.bin", {reinterpret_cast<const char*>(positions), 36});
    gltf_ = json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
      "nodes": [{"name": "n", "mesh": 0}],
      "meshes": [{"name": "m", "primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}],
      "buffers": [{"uri": "data.bin", "byteLength": 36}]})");
  }

  GltfFile File() const {
    WriteTextFile(folder_ / "t.gltf", gltf_.dump());
    return GltfFile(folder_ / "t.gltf");
  }
  Material Read(const json& material) {
    gltf_["materials"] = {material};
    return File().MeshMaterial();
  }
  Material ReadText(const std::string& text) { return Read(json::parse(text)); }
  // The error of that material, without the path of the folder.
  std::string Wrong(const std::string& text) {
    return WithoutFolder(MessageOf([&] { ReadText(text); }));
  }
  std::string WithoutFolder(std::string message) const {
    const std::string prefix = folder_.string() + "/";
    for (size_t at = message.find(prefix); at != std::string::npos; at = message.find(prefix))
      message.erase(at, prefix.size());
    return message;
  }

  const fs::path folder_ = OwnFolder();
  json gltf_;
};

// f cos(wi) at the first wavelength.
double FCos(const Material& material, const Vec3f& wo, const Vec3f& wi) {
  return static_cast<double>(material.bsdf->Evaluate(wo, wi, AnyWavelengths()).f_cos[0]);
}

Vec3f MirroredAboutNormal(const Vec3f& w) {
  return {-w.x(), -w.y(), w.z()};
}

// Fresnel's amplitudes with Snell's angle: independent of the formula in materials/microfacet.h.
double FresnelBySnell(double theta_rad, double ior) {
  const double inside = std::asin(std::sin(theta_rad) / ior);
  const double ci = std::cos(theta_rad), ct = std::cos(inside);
  const double s = (ci - ior * ct) / (ci + ior * ct), p = (ior * ci - ct) / (ior * ci + ct);
  return 0.5 * (s * s + p * p);
}

double Schlick(double theta_rad, double f0) {
  return f0 + (1.0 - f0) * std::pow(1.0 - std::cos(theta_rad), 5);
}

// F D G2 / (4 cos) where the half vector is the normal: D = 1 / (pi a^2), and for two directions of
// the same slope 1 / G2 = 1 + 2 Lambda = sqrt(1 + a^2 tan^2). This is f cos(wi) of a glint at its
// mirror direction; of the minimal retroreflective model at the direction of the source itself.
double PeakFCos(double fresnel, double width, double theta_rad) {
  const double tan2 = std::pow(std::tan(theta_rad), 2);
  return fresnel / (kPi * width * width) / std::sqrt(1.0 + width * width * tan2) /
         (4.0 * std::cos(theta_rad));
}

// --- materials of others ---

TEST_F(GltfMaterial, OfIndexOneIsLamberts) {
  // f = rho / pi with rho the luminance of the colour, 0.2126 R + 0.7152 G + 0.0722 B (BT.709):
  // 0.04252 + 0.35760 + 0.05776.
  const Material matte =
      ReadText(R"({"pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.5, 0.8, 1],
                   "metallicFactor": 0}, "extensions": {"KHR_materials_ior": {"ior": 1}}})");
  EXPECT_NEAR(FCos(matte, AtAngle(20.0), AtAngle(60.0, 80.0)), 0.45788 / kPi * 0.5, 1e-6);
}

TEST_F(GltfMaterial, DielectricGlintsByItsIndex) {
  // A black dielectric has the glint only. Index 1.5 where the file gives none; roughness 0.5, so
  // that the width is 0.25.
  const char* text = R"({"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1],
      "metallicFactor": 0, "roughnessFactor": 0.5}%})";
  for (const auto& [extension, ior] :
       {std::pair<std::string, double>{"", 1.5},
        {R"(, "extensions": {"KHR_materials_ior": {"ior": 2.4}})", 2.4}}) {
    std::string whole = text;
    whole.replace(whole.find('%'), 1, extension);
    const Material black = ReadText(whole);
    for (const double theta_deg : {0.0, 30.0, 60.0}) {
      const double theta = RadFromDeg(theta_deg);
      const double expected = PeakFCos(FresnelBySnell(theta, ior), 0.25, theta);
      const Vec3f wo = AtAngle(theta_deg, 35.0);
      EXPECT_NEAR(FCos(black, wo, MirroredAboutNormal(wo)), expected, 1e-4 * expected)
          << ior << " at " << theta_deg;
    }
  }
}

TEST_F(GltfMaterial, MetalGlintsByItsColour) {
  // Schlick's curve from the colour's luminance; width 0.01. The light between such facets is some
  // 1e-7 of the peak.
  const Material metal =
      ReadText(R"({"pbrMetallicRoughness": {"baseColorFactor": [0.6, 0.6, 0.6, 1],
                   "roughnessFactor": 0.1}})");
  for (const double theta_deg : {0.0, 45.0, 75.0}) {
    const double theta = RadFromDeg(theta_deg);
    const double expected = PeakFCos(Schlick(theta, 0.6), 0.01, theta);
    const Vec3f wo = AtAngle(theta_deg, 35.0);
    EXPECT_NEAR(FCos(metal, wo, MirroredAboutNormal(wo)), expected, 2e-4 * expected) << theta_deg;
  }
}

TEST_F(GltfMaterial, MetallicMixesLinearly) {
  // f = (1 - m) f_dielectric + m f_metal (specification, appendix B), in any pair of directions.
  const auto read = [&](double metallic) {
    return Read({{"pbrMetallicRoughness",
                  {{"baseColorFactor", {0.4, 0.4, 0.4, 1.0}},
                   {"metallicFactor", metallic},
                   {"roughnessFactor", 0.6}}}});
  };
  const Material dielectric = read(0.0), metal = read(1.0), mixed = read(0.25);
  for (const double theta_deg : {5.0, 40.0, 70.0}) {
    const Vec3f wo = AtAngle(theta_deg, 35.0), wi = AtAngle(30.0, 190.0);
    const double expected = 0.75 * FCos(dielectric, wo, wi) + 0.25 * FCos(metal, wo, wi);
    EXPECT_NEAR(FCos(mixed, wo, wi), expected, 1e-5 * expected);
  }
}

TEST_F(GltfMaterial, RetroreflectionIsThePeakOfTheModelAtTheSource) {
  // Draft KHR_materials_retroreflection: (1 - r) f(v, l) + r f(v', l) with v' the view mirrored
  // about the normal. At l = v the back vector is the normal, which gives r times the closed form
  // of PeakFCos, Fresnel's term at the entrance angle; at the mirror direction 1 - r of it. The
  // other lobe is there below 1e-6 of it from 30 degrees on (width 0.01); at normal incidence both
  // coincide.
  struct Case {
    double metallic;
    double (*fresnel)(double theta_rad);
  };
  const Case cases[] = {{0.0, [](double theta) { return FresnelBySnell(theta, 1.5); }},
                        {1.0, [](double theta) { return Schlick(theta, 0.5); }}};
  for (const Case& c : cases) {
    for (const double r : {0.3, 1.0}) {
      // The dielectric is black, so that it has no body.
      const double grey = c.metallic > 0.0 ? 0.5 : 0.0;
      const Material material = Read(
          {{"pbrMetallicRoughness",
            {{"baseColorFactor", {grey, grey, grey, 1.0}},
             {"metallicFactor", c.metallic},
             {"roughnessFactor", 0.1}}},
           {"extensions", {{"KHR_materials_retroreflection", {{"retroreflectionFactor", r}}}}}});
      for (const double theta_deg : {0.0, 30.0, 60.0}) {
        SCOPED_TRACE(fmt::format("metallic {}, r {}, {} degrees", c.metallic, r, theta_deg));
        const double theta = RadFromDeg(theta_deg);
        const double peak = PeakFCos(c.fresnel(theta), 0.01, theta);
        const Vec3f w = AtAngle(theta_deg, 35.0);
        const double back = theta_deg > 0.0 ? r : 1.0, forward = theta_deg > 0.0 ? 1.0 - r : 1.0;
        EXPECT_NEAR(FCos(material, w, w), back * peak, 2e-4 * peak);
        EXPECT_NEAR(FCos(material, w, MirroredAboutNormal(w)), forward * peak, 2e-4 * peak);
      }
    }
  }
}

TEST_F(GltfMaterial, DefaultsAreThoseOfTheSpecification) {
  // A material that says nothing is a white, rough metal (glTF 2.0, section 3.9.2).
  EXPECT_EQ(Read(json::object()).spec,
            json::parse(R"({"type": "conductor", "reflectance": 1.0, "roughness": 1.0})"));
  // Smoother facets than ours get the least width that we have.
  EXPECT_EQ(ReadText(R"({"pbrMetallicRoughness": {"roughnessFactor": 0}})").spec["roughness"],
            0.001);
}

// --- ours, as others see it ---

TEST(GltfSurface, ComesBackFromOurMaterials) {
  // SpecOf and NearestGltfSurface are inverse to each other wherever every parameter has an effect.
  // 1e-6: spectra hold single precision.
  KeyedRng rng(11);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(rng.NextFloat());
  };
  for (int i = 0; i < 200; ++i) {
    const GltfSurface surface = {between(0.01, 1.0), between(0.01, 0.99), between(0.05, 1.0),
                                 between(1.02, 4.0), between(0.0, 1.0)};
    const GltfSurface back = NearestGltfSurface(SpecOf(surface));
    EXPECT_NEAR(back.reflectance, surface.reflectance, 1e-6);
    EXPECT_NEAR(back.metallic, surface.metallic, 1e-6);
    EXPECT_NEAR(back.roughness, surface.roughness, 1e-6);
    EXPECT_NEAR(back.ior, surface.ior, 1e-6);
    EXPECT_NEAR(back.retroreflection, surface.retroreflection, 1e-6);
  }
}

TEST(GltfSurface, KnowsTheDefaultsOfOurMaterials) {
  // A description without parameters stands for the same surface by way of glTF.
  for (const char* text :
       {R"({"type": "absorber"})", R"({"type": "coated_diffuse"})",
        R"({"type": "conductor", "reflectance": 0.7})", R"({"type": "diffuse"})"}) {
    SCOPED_TRACE(text);
    const BsdfPtr bsdf = FromJson(text);
    const BsdfPtr there_and_back = FromJson(SpecOf(NearestGltfSurface(json::parse(text))).dump());
    for (const double theta_deg : {0.0, 30.0, 75.0}) {
      const Vec3f wo = AtAngle(theta_deg), wi = AtAngle(40.0, 170.0);
      const auto expected = static_cast<double>(bsdf->Evaluate(wo, wi, AnyWavelengths()).f_cos[1]);
      EXPECT_NEAR(static_cast<double>(there_and_back->Evaluate(wo, wi, AnyWavelengths()).f_cos[1]),
                  expected, 1e-5 * expected);
    }
  }
}

TEST(GltfSurface, MetalByItsIndexReflectsWhatFresnelSays) {
  // At normal incidence ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2): 75.49 / 86.69 for n 2.8, k 8.5.
  const GltfSurface metal =
      NearestGltfSurface(json::parse(R"({"type": "conductor", "n": 2.8, "k": 8.5})"));
  EXPECT_NEAR(metal.reflectance, 75.49 / 86.69, 1e-6);
  EXPECT_EQ(metal.metallic, 1.0);
}

TEST(GltfSurface, SheetingKeepsItsPeakAndItsAlbedo) {
  // The default sheeting: R_A(0) = sum of rho / (4 pi a^2) = 478.3 by the lobes (the peak of
  // tests/materials_test.cpp) and 0.27 / pi by the body; it reflects 0.109 + 0.075 + 0.27 at normal
  // incidence. 1e-3 for the light between the facets, four standard errors for the mean.
  const BsdfPtr seen =
      FromJson(SpecOf(NearestGltfSurface(LibraryMaterial("retro_bead").spec)).dump());
  const Vec3f up = Vec3f::UnitZ();
  EXPECT_NEAR(CoefficientOfRetroReflection(*seen, up, up), 478.3 + 0.27 / kPi, 0.5);
  const Albedo albedo = DirectionalAlbedoOf(*seen, 0.0, 300, 12);
  EXPECT_NEAR(albedo.mean, 0.454, 1e-3 + 4.0 * albedo.standard_error);
}

TEST(GltfSurface, ReflectsNoMoreThanGltfAllows) {
  // 0.73 + 0.27 in single precision is above 1.
  const GltfSurface white = NearestGltfSurface(json::parse(
      R"({"type": "retroreflector", "ior": 1, "lobes": [{"roughness": 0.1, "albedo": 0.73}]})"));
  EXPECT_EQ(white.reflectance, 1.0);
}

TEST(GltfSurface, SheetingByItsTableIsHalfAsBrightWhereTheTableIs) {
  // EN ISO 20471 at 5 degrees entrance angle: 330 at 0.2, 250 at 0.33, 25 at 1 degree, ln R_A
  // linear between them, so that 165 is reached at 0.33 + 0.67 ln(250 / 165) / ln 10 = 0.4509
  // degrees. The peak is taken as 330; the body adds 0.27 / pi.
  const BsdfPtr seen =
      FromJson(SpecOf(NearestGltfSurface(LibraryMaterial("retro_bead_table").spec)).dump());
  const Vec3f up = Vec3f::UnitZ();
  EXPECT_NEAR(CoefficientOfRetroReflection(*seen, up, up), 330.0 + 0.27 / kPi, 0.5);
  EXPECT_NEAR(CoefficientOfRetroReflection(*seen, up, AtAngle(0.4509)), 165.0 + 0.27 / kPi, 0.5);
}

// --- ours, back again ---

// The materials of the library, and kinds that it does not hold.
std::vector<Material> MaterialsToWrite() {
  std::vector<Material> materials;
  for (const std::string& name : LibraryMaterialNames()) materials.push_back(LibraryMaterial(name));
  const char* others[] = {
      R"({"type": "diffuse", "reflectance": "materials/data/qe_nir_cmos.csv"})",
      R"({"type": "conductor", "n": 2, "k": 8.100000000000001, "comment": "a \"b\" c"})",
      R"({"type": "back_vector", "of": {"type": "conductor", "reflectance": 0.1}})",
      R"({"type": "blend", "share": 0.3333333333333333, "one": {"type": "absorber"},
          "zero": {"type": "rough_diffuse", "reflectance": 1, "roughness": 1.0}})"};
  for (const char* text : others) {
    materials.push_back(ReadMaterial(fmt::format("other {}", materials.size()),
                                     JsonReader::FromText(text, "m.json")));
  }
  return materials;
}

Scene SceneOf(const std::vector<Material>& materials) {
  Scene scene;
  scene.name = "samples";
  TriangleMesh triangle;
  triangle.positions = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}};
  triangle.triangles = {{0, 1, 2}};
  for (const Material& material : materials) {
    scene.materials[material.name] = material;
    scene.objects.push_back({"on " + material.name, triangle, {}, material.name});
  }
  return scene;
}

TEST_F(GltfMaterial, OursComeBackUnchanged) {
  const std::vector<Material> materials = MaterialsToWrite();
  WriteGlb(SceneOf(materials), UpAxis::kX, folder_ / "samples.glb");
  const GltfFile file(folder_ / "samples.glb");
  for (const Material& material : materials) {
    SCOPED_TRACE(material.name);
    const Material back = file.NodeMaterial("on " + material.name);
    EXPECT_EQ(back.name, material.name);
    EXPECT_EQ(back.spec.dump(), material.spec.dump());
    const Vec3f wo = AtAngle(30.0, 10.0), wi = AtAngle(31.0, 12.0);
    EXPECT_EQ(FCos(back, wo, wi), FCos(material, wo, wi));
  }
}

TEST_F(GltfMaterial, OursAreStandardForOthers) {
  // What a viewer reads: without our extras the file still has the surfaces of NearestGltfSurface,
  // and names the extensions that it uses, none of them as required.
  const std::vector<Material> materials = MaterialsToWrite();
  WriteGlb(SceneOf(materials), UpAxis::kX, folder_ / "samples.glb");
  const std::string bytes = ReadTextFile(folder_ / "samples.glb");
  uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, 4);
  const json gltf = json::parse(bytes.substr(20, length));
  EXPECT_EQ(gltf["extensionsUsed"], (json{"KHR_materials_ior", "KHR_materials_retroreflection"}));
  EXPECT_FALSE(gltf.contains("extensionsRequired"));
  ASSERT_EQ(gltf["materials"].size(), materials.size());
  for (size_t i = 0; i < materials.size(); ++i) {
    SCOPED_TRACE(materials[i].name);
    json foreign = gltf["materials"][i];
    EXPECT_EQ(foreign["extras"]["retrolux"], materials[i].spec);
    foreign.erase("extras");
    EXPECT_EQ(Read(foreign).spec, SpecOf(NearestGltfSurface(materials[i].spec)));
  }
}

TEST_F(GltfMaterial, OurExtrasComeFirst) {
  const Material ours = ReadText(R"({"name": "x", "alphaMode": "MASK",
      "extras": {"retrolux": {"type": "diffuse", "reflectance": 0.25}}})");
  EXPECT_EQ(ours.spec, json::parse(R"({"type": "diffuse", "reflectance": 0.25})"));
  EXPECT_EQ(Wrong(R"({"extras": {"retrolux": {"type": "diffuse", "reflectance": 2}}})"),
            "t.gltf: /materials/0/extras/retrolux/reflectance: found number 2; expected a number "
            "from 0 to 1");
}

// --- scenes ---

TEST_F(GltfMaterial, ObjectsTakeTheirFilesMaterial) {
  gltf_["materials"] = json::parse(R"([{"name": "paint", "pbrMetallicRoughness":
      {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0}}])");
  File();
  json scene = json::parse(R"({"schema": "retrolux/scene-1", "name": "small",
      "objects": [{"name": "a", "file": "t.gltf"}, {"name": "b", "file": "t.gltf", "node": "n"},
                  {"name": "c", "file": "t.gltf", "material": "mask"}],
      "cameras": [{"name": "c", "eye_mm": [0, 0, 900], "look_at_mm": [0, 0, 0], "up": [1, 0, 0],
                   "field_of_view_deg": [12, 9]}]})");
  const auto read = [&] {
    WriteTextFile(folder_ / "scene.json", scene.dump());
    return ReadSceneFile(folder_ / "scene.json");
  };
  const Scene taken = read();
  EXPECT_EQ(taken.objects[0].material, "t.gltf:paint");
  EXPECT_EQ(taken.objects[1].material, "t.gltf:paint");
  EXPECT_EQ(taken.objects[2].material, "mask");
  EXPECT_EQ(taken.materials.at("t.gltf:paint").spec["reflectance"], 0.5);
  // Written out it is a scene like any other.
  ExportScene(taken, folder_ / "out");
  EXPECT_EQ(SceneHash(LoadScene((folder_ / "out").string())), SceneHash(taken));

  gltf_["meshes"][0]["primitives"].push_back(gltf_["meshes"][0]["primitives"][0]);
  gltf_["meshes"][0]["primitives"][1]["material"] = 1;
  gltf_["materials"].push_back({{"name", "metal"}});
  File();
  EXPECT_EQ(WithoutFolder(MessageOf(read)),
            "t.gltf: several materials; expected one material for all its triangles, or the key "
            "'material' in the scene");
  scene["objects"].erase(0);
  EXPECT_EQ(WithoutFolder(MessageOf(read)),
            "t.gltf: node 'n': several materials; expected one material for all its triangles, or "
            "the key 'material' in the scene");
}

TEST_F(GltfMaterial, MissingAndDoubledOnesAreRefused) {
  const auto wrong = [&] { return WithoutFolder(MessageOf([&] { File().MeshMaterial(); })); };
  gltf_["meshes"][0]["primitives"][0].erase("material");
  EXPECT_EQ(wrong(),
            "t.gltf: triangles without a material; expected one material for all its triangles, or "
            "the key 'material' in the scene");
  gltf_["meshes"][0]["primitives"][0]["material"] = 2;
  gltf_["materials"] = json::parse(R"([{"name": "x"}, {"name": "x"}])");
  EXPECT_EQ(wrong(),
            "t.gltf: mesh 'm' primitive 0 material: the index 2 into 2 elements; expected an index "
            "of one of them");
  gltf_["meshes"][0]["primitives"][0]["material"] = 1;
  EXPECT_EQ(wrong(),
            "t.gltf: material 'x': two materials of that name; expected names of their own");
  gltf_["materials"] = json::parse("[{}, {}]");
  EXPECT_EQ(File().MeshMaterial().name, "#1");
}

TEST_F(GltfMaterial, WhatWouldGiveAnotherPictureIsRefused) {
  EXPECT_EQ(Wrong(R"({"alphaMode": "MASK"})"),
            "t.gltf: /materials/0/alphaMode: found MASK; expected OPAQUE, for holes and glass are "
            "not read");
  EXPECT_EQ(Wrong(R"({"extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.5}}})"),
            "t.gltf: /materials/0/extensions/KHR_materials_transmission/transmissionFactor: found "
            "0.5; expected 0, for the extension is not read");
  EXPECT_EQ(Wrong(R"({"extensions": {"KHR_materials_specular": {"specularFactor": 0}}})"),
            "t.gltf: /materials/0/extensions/KHR_materials_specular/specularFactor: found 0; "
            "expected 1, for the extension is not read");
  EXPECT_EQ(Wrong(R"({"extensions": {"KHR_materials_ior": {"ior": 0}}})"),
            "t.gltf: /materials/0/extensions/KHR_materials_ior/ior: found number 0; expected a "
            "number from 1 to 4");
  EXPECT_EQ(Wrong(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})"),
            "t.gltf: /materials/0/pbrMetallicRoughness/baseColorTexture/index: found 0; expected a "
            "texture with an image");
  EXPECT_EQ(Wrong(R"({"pbrMetallicRoughness": {"baseColorFactor": [0.5, 1.5, 0, 1]}})"),
            "t.gltf: /materials/0/pbrMetallicRoughness/baseColorFactor: found 1.5; expected "
            "numbers from 0 to 1");
  EXPECT_EQ(Wrong(R"({"extensions": {"KHR_materials_retroreflection":
                      {"retroreflectionTexture": {"index": 0}}}})"),
            "t.gltf: /materials/0/extensions/KHR_materials_retroreflection/retroreflectionTexture: "
            "found a texture; expected factors alone, for it is not read");
  // Without effect, or of no weight for a camera that counts electrons in one band.
  EXPECT_EQ(Wrong(R"({"alphaMode": "OPAQUE", "emissiveFactor": [1, 1, 1], "doubleSided": true,
                      "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0}}})"),
            "no error");
}

// --- textures ---

// 2 x 1 pixels: black and white.
std::string BlackAndWhite() {
  Plane<uint16_t> dn(2, 1);
  dn.data = {0, 255};
  return EncodeGreyPng({dn, 8});
}

TEST_F(GltfMaterial, BaseColorTextureScalesTheReflectance) {
  WriteTextFile(folder_ / "bw.png", BlackAndWhite());
  gltf_["images"] = {{{"uri", "bw.png"}}};
  gltf_["textures"] = {{{"source", 0}}};
  const Material material = ReadText(R"({"pbrMetallicRoughness": {"metallicFactor": 0,
      "baseColorFactor": [0.5, 0.5, 0.5, 1], "baseColorTexture": {"index": 0}}})");
  ASSERT_NE(material.texture, nullptr);
  EXPECT_EQ(material.texture->Bytes(), BlackAndWhite());
  EXPECT_EQ(material.spec.at("reflectance"), 0.5);
  EXPECT_NE(material.dark, nullptr);
  EXPECT_THAT(Wrong(R"({"pbrMetallicRoughness": {"metallicFactor": 0.5,
                  "baseColorTexture": {"index": 0}}})"),
              testing::HasSubstr("a texture on 'blend'"));
  EXPECT_THAT(Wrong(R"({"pbrMetallicRoughness": {"metallicFactor": 0,
                  "baseColorTexture": {"index": 0, "texCoord": 1}}})"),
              testing::HasSubstr("another set of coordinates"));
}

TEST_F(GltfMaterial, TexturedSceneNeedsNoMaterialsBesideItsGlb) {
  // A textured triangle out and in again, by the file's own material: our description of it names
  // the picture beside the file, viewers find it inside.
  WriteTextFile(folder_ / "bw.png", BlackAndWhite());
  Scene scene;
  scene.name = "triangle";
  scene.materials["t"] = ReadMaterial(
      "t", JsonReader::FromText(R"({"type": "diffuse", "reflectance_texture": "bw.png"})",
                                folder_ / "scene.json"));
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 1, 2}}, {{0, 0}, {1, 0}, {0, 1}}};
  scene.objects.push_back({"plate", mesh, {}, "t"});
  scene.cameras.emplace_back();
  scene.cameras[0].model = CameraModel::FromFieldOfView("c", 8, 6, 10.0, 8.0, {});
  scene.UseMaterial(scene.exposure.marker_material);
  ExportScene(scene, folder_ / "out");
  const GltfFile read(folder_ / "out" / "triangle.glb");
  const Material material = read.MeshMaterial();
  ASSERT_NE(material.texture, nullptr);
  EXPECT_EQ(material.texture->Bytes(), BlackAndWhite());
  EXPECT_EQ(read.Mesh(UpAxis::kX).uvs, mesh.uvs);
}

}  // namespace
}  // namespace retrolux
