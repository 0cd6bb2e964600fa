// The study of hot spots: its light against closed forms, its figures on made-up shots.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/cross_highlight.h"
#include "analysis/highlight_forecast.h"
#include "analysis/hotspot_limit.h"
#include "analysis/hotspot_setup.h"
#include "analysis/hotspot_verdict.h"
#include "analysis/stereo_bench.h"
#include "classifier/triangulation.h"
#include "core/atomic_file.h"
#include "message_of.h"
#include "own_folder.h"
#include "scenes/masks.h"
#include "scenes/mesh_shapes.h"
#include "scenes/scene_parts.h"

namespace retrolux {
namespace {

constexpr double kDistance_mm = 1600.0, kRadius_mm = 100.0;
constexpr HotspotSamples kSamples = {32, 64, 64, 1};

Scene PairScene(double psi_deg) {
  Scene scene;
  scene.name = "pair";
  for (CameraSpec& camera : StereoPair(psi_deg, kDistance_mm)) {
    // The middle of the picture, its pixels as large as the thesis's.
    camera.model.width = 240;
    camera.model.height = 180;
    camera.model.cx = 119.5;
    camera.model.cy = 89.5;
    scene.cameras.push_back(std::move(camera));
  }
  scene.UseMaterial("retro_bead");
  return scene;
}

// The sphere of 100 mm around the origin with a coat of that roughness.
Scene SphereScene(double psi_deg, double roughness) {
  Scene scene = PairScene(psi_deg);
  AddObject(scene, "mask", MakeMask("sphere"), "mask");
  SetCoatRoughness(scene, "mask", roughness);
  return scene;
}

// A flat target that faces the bisector, with a marker in its middle.
Scene PanelScene(double psi_deg, const std::string& material) {
  Scene scene = PairScene(psi_deg);
  AddObject(scene, "panel", RectangleMesh({0, -90, -90}, {0, 180, 0}, {0, 0, 180}), material);
  scene.markers.push_back({"standard", 0, "panel", Vec3d::Zero()});
  return scene;
}

// Mean electrons per W/(m2 sr) of the first camera in the light of its ring, from a point.
double ElectronsPerRadiance(const Scene& scene, const Vec3d& from, double exposure_s) {
  const CameraSpec& camera = scene.cameras.front();
  const CameraResponse response(camera, {LedSpectrum(camera.ring->Led())}, exposure_s);
  const double cosine = (from - camera.model.Centre()).normalized().dot(camera.model.Forward());
  return response.ExpectedElectrons(0, cosine, std::pow(cosine, 4));
}

Vec3d PositionOf(const IdBuffers& ids, size_t i) {
  return {static_cast<double>(ids.position[0].data[i]),
          static_cast<double>(ids.position[1].data[i]),
          static_cast<double>(ids.position[2].data[i])};
}

// The normal bisects the directions, and lamp and eye may change places.
TEST(SphereHighlight, MirrorsOneIntoTheOther) {
  const Vec3d centre(5, -3, 2), a(1600, 200, -100), b(900, -700, 300);
  const Vec3d at = SphereHighlight(centre, kRadius_mm, a, b);
  const Vec3d normal = (at - centre) / kRadius_mm;
  const Vec3d to_a = (a - at).normalized(), to_b = (b - at).normalized();
  EXPECT_NEAR(normal.norm(), 1.0, 1e-12);
  EXPECT_NEAR(normal.dot(to_a), normal.dot(to_b), 1e-12);
  EXPECT_NEAR(normal.dot(to_a.cross(to_b)), 0.0, 1e-12);
  EXPECT_LT((at - SphereHighlight(centre, kRadius_mm, b, a)).norm(), 1e-9);
  // Equally far: on the bisector. With itself: below the camera.
  const Vec3d c(1600 * std::cos(0.3), 1600 * std::sin(0.3), 0);
  const Vec3d d(c.x(), -c.y(), 0);
  EXPECT_LT((SphereHighlight(Vec3d::Zero(), kRadius_mm, c, d) - Vec3d(kRadius_mm, 0, 0)).norm(),
            1e-9);
  EXPECT_LT((SphereHighlight(Vec3d::Zero(), kRadius_mm, c, c) - kRadius_mm * c.normalized()).norm(),
            1e-9);
}

// Both cameras see the cross highlight at one point of the surface, so that it triangulates there;
// the rays to the own highlights go along the normals and meet in the centre of the sphere.
TEST(SphereHighlight, CrossTriangulatesOnTheSurfaceOwnInTheCentre) {
  const std::array<CameraSpec, 2> pair = StereoPair(12.0, kDistance_mm);
  const CameraModel &left = pair[0].model, &right = pair[1].model;
  const Vec3d centre(4, 7, -6);
  const auto highlight = [&](const CameraModel& a, const CameraModel& b) {
    return SphereHighlight(centre, kRadius_mm, a.Centre(), b.Centre());
  };
  const auto triangulate = [&](const Vec3d& in_left, const Vec3d& in_right) -> Vec3d {
    const std::array<Sighting, 2> sightings = {Sighting{&left, *left.Project(in_left)},
                                               Sighting{&right, *right.Project(in_right)}};
    return Triangulate(sightings, {}).point->position;
  };
  const Vec3d cross = highlight(left, right);
  EXPECT_LT((triangulate(cross, highlight(right, left)) - cross).norm(), 1e-6);
  EXPECT_LT((triangulate(highlight(left, left), highlight(right, right)) - centre).norm(), 1e-6);
}

// The same, rendered: middles of highlights in the light of each ring. Their facets' distribution
// is symmetric about the normal; 0.3 mm is half a pixel, for the pixels' and paths' noise. In depth
// 0.2 px in each picture is 0.6 mm.
TEST(Highlight, RenderedWhereTheHalfVectorSays) {
  constexpr double kPsi_deg = 20.0;
  Scene scene = SphereScene(kPsi_deg, 0.04);
  scene.markers.push_back({"standard", 0, "mask", Vec3d(60, 0, 80)});  // away from the highlights
  const HotspotStage stage(scene, 0, kSamples, 3);
  const Vec3d left = scene.cameras[0].model.Centre(), right = scene.cameras[1].model.Centre();
  for (const auto& [group, lamp] : {std::pair{0, left}, std::pair{1, right}}) {
    const Highlight seen =
        HighlightOf(stage.bare_glints[static_cast<size_t>(group)], stage.light.ids, stage.mask);
    const Vec3d expected = SphereHighlight(Vec3d::Zero(), kRadius_mm, left, lamp);
    EXPECT_LT((Vec3d(seen.at_mm.data()) - expected).norm(), 0.3) << group;
  }
  const HighlightDepths depths = DepthsOfHighlights(stage, stage.scene.cameras[1], kSamples, 3);
  ASSERT_TRUE(depths.known);
  EXPECT_NEAR(depths.cross_mm, 0.0, 1.0);
  EXPECT_NEAR(depths.own_mm, kRadius_mm, 1.0);
  EXPECT_NEAR(depths.apart_mm, 2.0 * kRadius_mm * std::sin(0.25 * RadFromDeg(kPsi_deg)), 0.5);
}

// The brightest pixel of a highlight: BSDF where the facets face the half vector, times the ring's
// irradiance there. The diodes lie 1.1 degrees off the ring's centre, their half vectors 0.57 off
// the normal: (1 + tan^2 / alpha^2)^-2 = 0.995 of the peak at roughness 0.2, which is put in; 1 %
// for a pixel's noise (0.2 %) and the largest of many.
TEST(Highlight, PeakIsThatOfTheCoat) {
  constexpr double kPsi_deg = 30.0, kRoughness = 0.2;
  Scene scene = SphereScene(kPsi_deg, kRoughness);
  scene.markers.push_back({"standard", 0, "mask", Vec3d(60, 0, 80)});
  const HotspotStage stage(scene, 0, kSamples, 5);
  const CameraSpec &camera = scene.cameras[0], &neighbour = scene.cameras[1];
  const Vec3d at =
      SphereHighlight(Vec3d::Zero(), kRadius_mm, camera.model.Centre(), neighbour.model.Centre());
  const Vec3d normal = at / kRadius_mm;
  const double off = std::atan(neighbour.ring->radius_mm / (kDistance_mm - kRadius_mm)) / 2.0;
  const double facets = std::pow(1.0 + std::pow(std::tan(off) / kRoughness, 2), -2);
  const double psi_there = Separation_deg(camera.model, neighbour.model, at);
  const double radiance = HighlightBrdf(1.47, kRoughness, psi_there) * facets *
                          RingIrradiance_w_m2(neighbour, at, normal);
  const double expected = radiance * ElectronsPerRadiance(scene, at, stage.light.exposure_s);
  const Highlight seen = HighlightOf(stage.bare_glints[1], stage.light.ids, stage.mask);
  EXPECT_NEAR(seen.peak_e / expected, 1.0, 0.01);
}

// Without tracing light: the place of the half vector, and the peak of the coat there (the closed
// form of the test before, but with the ring as a point). 1.5 mm: the forecast looks at every
// second pixel of 0.5 mm, and its grid need not hold the middle; over that the highlight falls by
// 0.1 %. The render's peak: 1 % of the ring's width, 1 % as above.
TEST(HighlightForecast, IsWhereTheHalfVectorSaysAndAsBrightAsRendered) {
  Scene scene = SphereScene(30.0, 0.2);
  scene.markers.push_back({"standard", 0, "mask", Vec3d(60, 0, 80)});
  const HotspotStage stage(scene, 0, kSamples, 5);
  const std::vector<HighlightForecast> forecasts =
      ForecastHighlights(stage.scene, stage.rays, stage.camera, stage.mask);
  ASSERT_EQ(forecasts.size(), 2u);
  for (size_t ring = 0; ring < 2; ++ring) {
    const Vec3d expected =
        SphereHighlight(Vec3d::Zero(), kRadius_mm, scene.cameras[0].model.Centre(),
                        scene.cameras[ring].model.Centre());
    const Highlight seen = HighlightOf(stage.bare_glints[ring], stage.light.ids, stage.mask);
    EXPECT_LT((Vec3d(forecasts[ring].at_mm.data()) - expected).norm(), 1.5) << ring;
    EXPECT_LT((Vec3d(forecasts[ring].at_mm.data()) - Vec3d(seen.at_mm.data())).norm(), 1.5) << ring;
    EXPECT_NEAR(forecasts[ring].peak_e / seen.peak_e, 1.0, 0.02) << ring;
  }
}

// A wall between the neighbour and the sphere: none of its light, all of the own.
TEST(HighlightForecast, KnowsShadows) {
  Scene scene = SphereScene(30.0, 0.2);
  const Vec3d lamp = scene.cameras[1].model.Centre();
  const Vec3d across = 300.0 * lamp.cross(Vec3d::UnitZ()).normalized();
  AddObject(scene, "wall",
            RectangleMesh(0.5 * lamp - 0.5 * across - Vec3d(0, 0, 150), across, {0, 0, 300}),
            "black");
  const RayScene rays(scene);
  const std::vector<HighlightForecast> forecasts =
      ForecastHighlights(scene, rays, scene.cameras[0], 0);
  EXPECT_GT(forecasts[0].peak_e, 10.0);
  EXPECT_EQ(forecasts[1].peak_e, 0.0);
}

// A marker that faces the bisector, lit by the neighbour: L = R_A(alpha) E_perp / cos(nu) (CIE),
// with R_A of the sheeting's two lobes (docs/physics.md, section 4) at the angle alpha between each
// diode and the camera, as seen from the marker; entrance angles stay below 5 degrees, where the
// weight is 1. (At 2 degrees the rings overlap, and their diodes hide each other.) 2 %: the lobe is
// narrower across the plane of incidence by cos(beta), 0.2 %, and paths' noise of a difference (all
// - plain).
TEST(RetroTail, MarkerSignalFromRa) {
  const auto ra = [](double alpha) {
    double sum = 0.0;
    for (const auto& [a, rho] : {std::pair{0.0043, 0.109}, std::pair{0.0255, 0.075}}) {
      const double bracket = 1.0 + std::pow(std::tan(0.5 * alpha) / a, 2);
      sum += rho / (4.0 * kPi * a * a) / (std::pow(std::cos(0.5 * alpha), 4) * bracket * bracket);
    }
    return sum;
  };
  for (const double psi_deg : {3.0, 5.0, 8.0}) {
    const Scene scene = PanelScene(psi_deg, "black");
    const HotspotStage stage(scene, 0, kSamples, 7);
    const CameraSpec &camera = scene.cameras[0], &neighbour = scene.cameras[1];
    const std::vector<RingLight> rings = RingsOf(stage.scene, stage.rays, stage.camera, stage.mask,
                                                 stage.light, stage.bare_glints, stage.markers);
    const Vec3d normal = Vec3d::UnitX(), to_camera = camera.model.Centre().normalized();
    double radiance = 0.0;
    for (int i = 0; i < neighbour.ring->count; ++i) {
      const Vec3d led = LedCentre(neighbour, i);
      const double cos_led = -led.normalized().dot(neighbour.model.Forward());
      const double e_perp = neighbour.ring->Intensity_w_sr() *
                            std::pow(cos_led, neighbour.ring->LambertExponent()) /
                            (1e-6 * led.squaredNorm());
      radiance += ra(std::acos(led.normalized().dot(to_camera))) * e_perp / normal.dot(to_camera);
    }
    const double expected =
        radiance * ElectronsPerRadiance(scene, Vec3d::Zero(), stage.light.exposure_s);
    EXPECT_NEAR(rings[1].lobe_e / expected, 1.0, 0.02) << psi_deg;
    EXPECT_NEAR(rings[1].separation_deg, psi_deg, 1e-9);
    EXPECT_EQ(rings[0].separation_deg, 0.0);
  }
}

// Both beams on a matt white panel: rho / pi times the irradiance of each ring at the points that
// the pixels show. 0.3 % for the diodes' discs and the paths.
TEST(Overlap, IrradianceOfTwoBeams) {
  const Scene scene = PanelScene(24.0, "white_paint");
  const HotspotStage stage(scene, 0, kSamples, 9);
  const std::vector<RingLight> rings = RingsOf(stage.scene, stage.rays, stage.camera, stage.mask,
                                               stage.light, stage.bare_glints, stage.markers);
  for (size_t ring = 0; ring < 2; ++ring) {
    double expected = 0.0;
    const std::vector<size_t>& around = stage.markers.front().around;
    for (const size_t i : around) {
      const Vec3d at = PositionOf(stage.light.ids, i);
      expected += 0.7 / kPi * RingIrradiance_w_m2(scene.cameras[ring], at, Vec3d::UnitX()) *
                  ElectronsPerRadiance(scene, at, stage.light.exposure_s) /
                  static_cast<double>(around.size());
    }
    EXPECT_NEAR(rings[ring].beam_e / expected, 1.0, 3e-3) << ring;
    EXPECT_EQ(rings[ring].gloss_e, 0.0);  // a matt wall has no coat
  }
}

// A sheet without its lobe is what the same sheet is with lobes that reflect nothing; the light of
// a coated body over its glints is in proportion to the body's reflectance.
TEST(Materials, AreTakenApartExactly) {
  const auto material = [](const std::string& name, const nlohmann::json& spec) {
    return ReadMaterial(name, JsonReader::FromText(spec.dump(), name));
  };
  Scene scene;
  scene.UseMaterial("retro_bead");
  scene.UseMaterial("mask");
  nlohmann::json no_lobes = scene.materials.at("retro_bead").spec;
  for (nlohmann::json& lobe : no_lobes.at("lobes")) lobe["albedo"] = 0.0;
  nlohmann::json darker = scene.materials.at("mask").spec;
  darker["reflectance"] = 0.4;
  const Material expected = material("none", no_lobes), half = material("half", darker);
  const Scene plain = WithPlainSheeting(scene), glints = WithGlintsOnly(scene);
  const Vec3f wo = Vec3f(0.1f, 0.2f, 0.9f).normalized(), wi = Vec3f(-0.2f, 0.1f, 0.8f).normalized();
  const Spectral nm = Spectral::Constant(880.0f);
  const auto value = [&](const Material& m) { return m.bsdf->Evaluate(wo, wi, nm).f_cos[0]; };
  EXPECT_FLOAT_EQ(value(plain.materials.at("retro_bead")), value(expected));
  EXPECT_LT(value(glints.materials.at("retro_bead")), value(expected));
  const float glint = value(glints.materials.at("mask"));
  EXPECT_GT(glint, 0.0f);
  EXPECT_NEAR(value(scene.materials.at("mask")) - glint, 2.0f * (value(half) - glint), 1e-6f);
  scene.materials["cloth"] =
      material("cloth", {{"type", "back_vector"}, {"of", {{"type", "diffuse"}}}});
  EXPECT_THROW(WithGlintsOnly(scene), InputError);
}

TEST(HotspotMix, RingsAddUp) {
  const Scene scene = PanelScene(10.0, "white_paint");
  const HotspotStage stage(scene, 0, {4, 4, 4, 1}, 11);
  const FloatPlane own = Mixed(stage.light, {"", 1.0, 0.0});
  const FloatPlane both = Mixed(stage.light, {"", 1.0, 1.0});
  const FloatPlane more = Mixed(stage.light, {"", 1.0, 4.0});
  for (size_t i = 0; i < own.data.size(); ++i) {
    EXPECT_NEAR(more.data[i] - own.data[i], 4.0f * (both.data[i] - own.data[i]),
                1e-5f * more.data[i]);
  }
}

// One of several neighbours by itself: they add up.
TEST(HotspotMix, NeighboursOneByOne) {
  HotspotLight light;
  light.groups = {"left", "right", "neighbour-2", kAmbientGroup};
  light.edges = Plane<uint8_t>(1, 1, 0);
  for (const float e : {1.0f, 10.0f, 100.0f, 1000.0f}) {
    light.all.emplace_back(1, 1);
    light.all.back().data[0] = e;
  }
  EXPECT_EQ(Mixed(light, {"", 1.0, 1.0}).data[0], 1111.0f);
  EXPECT_EQ(Mixed(light, {"", 1.0, 1.0, false, "right"}).data[0], 1011.0f);
  EXPECT_EQ(Mixed(light, {"", 1.0, 2.0, false, "neighbour-2"}).data[0], 1201.0f);
}

TEST(HotspotSetup, SaysWhatIsWrong) {
  HotspotSetup setup;
  EXPECT_NO_THROW(setup.Check());
  setup.mask = "hat";
  EXPECT_EQ(MessageOf([&] { setup.Check(); }), "mask: found 'hat'; expected oval or face");
  setup.mask = "oval";
  setup.cameras = 1;
  EXPECT_THROW(setup.Check(), InputError);
}

TEST(HotspotSetup, CamerasInARow) {
  HotspotSetup setup;
  setup.cameras = 4;
  const Scene scene = HotspotScene(setup, 9.0, 0, 1);
  ASSERT_EQ(scene.cameras.size(), 4u);
  for (size_t i = 1; i < 4; ++i) {
    EXPECT_NEAR(Separation_deg(scene.cameras[i - 1].model, scene.cameras[i].model), 9.0, 1e-9);
    EXPECT_NEAR(Separation_deg(scene.cameras[0].model, scene.cameras[i].model),
                9.0 * static_cast<double>(i), 1e-9);
  }
}

// Two markers, `exposures` of them, of a method that finds `found` of the first with a neighbour;
// without, all. The second is shifted by 0.3 px in every exposure.
HotspotShot MadeUpShot(int exposures, int found, double background_e) {
  HotspotShot shot;
  shot.markers = {1, 2};
  const auto n = static_cast<size_t>(exposures);
  for (const char* name : {"own", "both"}) {
    const bool own = std::string(name) == "own";
    MixResult mix{name, {}, {}};
    mix.levels.background_e = own ? 100.0 : background_e;
    mix.levels.background_noise_e = 10.0;
    MixDetections detections;
    detections.found = {std::vector<int>(n, 1), std::vector<int>(n, 1)};
    for (size_t k = static_cast<size_t>(found); !own && k < n; ++k) detections.found[0][k] = 0;
    detections.wrong_names.assign(n, own ? 0 : 1);
    detections.strays.assign(n, 0);
    detections.shifts.assign(2, {});
    detections.shifts[1] = {own ? 0.0 : 0.3, 0.0, exposures, {own ? 0.0 : 0.3, 0.0}, 0.01, 0.02};
    mix.methods = {{"edges", detections}, {"robust", detections}};
    shot.mixes.push_back(mix);
  }
  shot.rings.resize(2);
  shot.rings[1].separation_deg = 10.0;
  return shot;
}

const std::vector<HotspotMix> kOwnAndBoth = {{"own", 1.0, 0.0}, {"both", 1.0, 1.0}};

TEST(HotspotRow, CountsInPairs) {
  const HotspotRow row =
      RowOf(10.0, {MadeUpShot(8, 5, 140.0), MadeUpShot(8, 8, 160.0)}, kOwnAndBoth);
  const HotspotMethodRow& both = row.Mix("both").methods.at("robust");
  EXPECT_EQ(both.hits.of, 32);
  EXPECT_EQ(both.hits.count, 29);
  EXPECT_EQ(both.lost, 3);
  EXPECT_EQ(both.gained, 0);
  EXPECT_EQ(both.more_false, 16);
  EXPECT_DOUBLE_EQ(both.false_detections, 1.0);
  EXPECT_DOUBLE_EQ(row.Mix("both").mean.background_e, 150.0);
  EXPECT_DOUBLE_EQ(row.Mix("both").error.background_e, 10.0);  // |160 - 140| / 2
  // One marker of the two has places in both pictures; squares 0.09, less the noise of two pictures
  // in two components: 4 x 0.01^2 / 8.
  EXPECT_NEAR(both.noisy_shift_px, std::sqrt(0.09 - 5e-5), 1e-12);
  EXPECT_NEAR(both.centroid_shift_px, 0.3, 1e-12);
}

// The limit is where nothing changes any more, not where it first does not.
TEST(HotspotLimit, IsTheLastChange) {
  std::vector<HotspotRow> rows;
  for (const auto& [psi_deg, background_e] :
       {std::pair{5.0, 150.0}, std::pair{10.0, 120.0}, std::pair{15.0, 140.0},
        std::pair{20.0, 125.0}, std::pair{30.0, 101.0}})
    rows.push_back(RowOf(psi_deg, {MadeUpShot(8, 8, background_e)}, kOwnAndBoth));
  for (const HotspotLimit& limit : LimitsOf(rows, kOwnAndBoth[1])) {
    const std::string name = limit.criterion->name;
    if (name == "background") {  // 5, 2, 4, 2.5, 0.1 sigma
      EXPECT_EQ(limit.limit_deg, 20.0);
      EXPECT_EQ(LimitText(limit, rows), "20°");
    }
    if (name == "hits, robust") {
      EXPECT_EQ(LimitText(limit, rows), "unchanged from 5° on");
    }
    // Eight of eight pictures have one more: p = 2 / 2^8 > 0.0027.
    if (name == "false detections, edges") {
      EXPECT_TRUE(limit.never_changed);
    }
    if (name == "centroid, edges") {
      EXPECT_EQ(LimitText(limit, rows), "none up to 30°");
    }
  }
}

// Of what robust measures, with both rings on and nothing varied, the largest limit.
TEST(HotspotLimitFile, GivesTheLeastSeparation) {
  const std::filesystem::path file = OwnFolder() / "summary.json";
  const auto limit_of = [&](const nlohmann::json& corners_deg) {
    const auto entry = [](const char* series, const char* criterion, const nlohmann::json& deg,
                          bool never) {
      return nlohmann::json{{"series", series},
                            {"rings", "both"},
                            {"criterion", criterion},
                            {"limit_deg", deg},
                            {"never_changed", never}};
    };
    const nlohmann::json summary = {{"schema", "retrolux/hotspot-study-1"},
                                    {"limits",
                                     {entry("default", "background", nullptr, false),
                                      entry("default", "centroid, robust", 4.0, false),
                                      entry("default", "corners, robust", corners_deg, false),
                                      entry("default", "hits, robust", 2.0, true),
                                      entry("face", "hits, robust", 20.0, false)}}};
    WriteTextFile(file, summary.dump());
    return HotspotLimit_deg(file);
  };
  EXPECT_EQ(limit_of(5.0), 5.0);
  EXPECT_EQ(limit_of(3.0), 4.0);
  EXPECT_THAT(MessageOf([&] { limit_of(nullptr); }),
              testing::HasSubstr("/limits/2/limit_deg: found no limit of 'corners, robust'"));
}

TEST(HotspotShot, RoundTrip) {
  const HotspotShot shot = MadeUpShot(4, 2, 120.0);
  const nlohmann::json json = shot;
  EXPECT_EQ(nlohmann::json(json.get<HotspotShot>()), json);
}

}  // namespace
}  // namespace retrolux
