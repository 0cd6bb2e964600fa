// The vault as a scene, and the pictures of its mask.
#include <gtest/gtest.h>

#include "analysis/mask_picture.h"
#include "analysis/vault_drawing.h"
#include "scenes/built_in.h"
#include "scenes/mask_mesh.h"
#include "scenes/mesh_shapes.h"
#include "scenes/vault.h"
#include "tests/message_of.h"

namespace retrolux {
namespace {

using Colour = std::array<uint8_t, 3>;

const Placement kThesis1a = {60.0, 31.67, 70.52};

// Upright, turned to the side, and leaning back.
MaskRotation LeaningBack(const Scenario& scenario) {
  for (const MaskRotation& rotation : MaskRotations(scenario.Mask("face"))) {
    if (rotation.x_deg == 15.0 && rotation.y_deg == 10.0 && rotation.z_deg == 40.0) return rotation;
  }
  ADD_FAILURE() << "no such orientation";
  return {};
}

TEST(VaultScene, HasTheCamerasOfThePlacement) {
  const Scenario scenario = LoadScenario("1a");
  const Scene scene = VaultScene(scenario, kThesis1a, "face", {});
  EXPECT_NO_THROW(CheckScene(scene, "vault"));
  const std::vector<Vec3d> centres = CameraCentres(scenario, kThesis1a);
  ASSERT_EQ(scene.cameras.size(), 9u);
  for (size_t i = 0; i < centres.size(); ++i) {
    const CameraSpec& camera = scene.Camera(fmt::format("camera-{}", i + 1));
    EXPECT_LT((camera.model.Centre() - centres[i]).norm(), 1e-6);
    EXPECT_TRUE(camera.filter && camera.ring);
    // The isocentre in the middle of the picture, z upwards in it.
    EXPECT_LT((*camera.model.Project(Vec3d::Zero()) - Vec2d(319.5, 239.5)).norm(), 1e-6);
    EXPECT_LT(camera.model.Project({0, 0, 50})->y(), 239.5);
  }
  // Camera 3 at azimuth 60 + 2 (360 - 120) / 8 = 120 degrees on the lower rig: 1600 sin 70.52 =
  // 1508.4 mm from the axis, 1600 cos 70.52 = 533.6 mm up.
  const Vec3d third = scene.Camera("camera-3").model.Centre();
  EXPECT_NEAR(third.x(), -754.2, 0.1);
  EXPECT_NEAR(third.y(), 1306.3, 0.1);
  EXPECT_NEAR(third.z(), 533.6, 0.1);
}

TEST(VaultScene, SnoutsStandBeforeTheTurnedMask) {
  const Scenario scenario = LoadScenario("1a");
  const MaskRotation rotation = LeaningBack(scenario);
  const Scene scene = VaultScene(scenario, kThesis1a, "face", rotation);
  const SceneObject& mask = scene.Object("mask");
  EXPECT_EQ(mask.material, "mask");
  std::vector<Vec3d> points;
  for (const Vec3f& position : mask.mesh.positions)
    points.push_back(mask.world_from_object * position.cast<double>());
  for (const Beam& beam : scenario.beams) {
    const double tip = PlaceNozzle(scenario.nozzle, beam, points).tip_distance_mm;
    double nearest = 1e300;
    for (const Vec3f& position : scene.Object("snout-" + beam.name).mesh.positions)
      nearest = std::min(nearest, position.cast<double>().dot(BeamDirection(beam)));
    EXPECT_NEAR(nearest, tip, 1e-3) << beam.name;
    EXPECT_GE(tip, scenario.nozzle.min_tip_distance_mm);
  }
}

TEST(VaultScene, FloorLiesBelowTheIsocentre) {
  const Scene scene = BuiltInScene("vault");
  EXPECT_NO_THROW(CheckScene(scene, "vault"));
  EXPECT_FALSE(scene.markers.empty());
  for (const Vec3f& position : scene.Object("floor").mesh.positions)
    EXPECT_FLOAT_EQ(position.z(), -1600.0f);
}

TEST(VaultScene, HasOneNozzleInARoomWithOneBeam) {
  const Scenario scenario = LoadScenario("3a");
  const Scene scene = VaultScene(scenario, kThesis1a, "body", {});
  EXPECT_NO_THROW(CheckScene(scene, "vault"));
  EXPECT_NO_THROW(scene.Object("nozzle-horizontal"));
  EXPECT_THROW(scene.Object("nozzle-skew"), InputError);
  EXPECT_NE(MessageOf([&] { VaultScene(scenario, kThesis1a, "hand", {}); }), "no error");
}

// --- pictures ---

class SpherePictures : public testing::Test {
 protected:
  static constexpr double kRadius = 100.0;
  const Mask mask_{"sphere", EllipsoidMesh(Vec3d::Constant(kRadius), 4), VisibilityRule::kRays,
                   20.0};
  const std::vector<OvalCategory> colours_ = {{"0", "#ff0000"}, {"1", "#00ff00"}, {"2", "#0000ff"}};

  // From far away, so that a camera sees one half.
  static CameraModel CameraAt(const Vec3d& direction) {
    return CameraModel::FromFieldOfView("", 200, 200, 0.25, 0.25,
                                        LookAt(1e5 * direction, Vec3d::Zero(), Vec3d::UnitZ()));
  }
  std::vector<int> Counts(const std::vector<Vec3d>& directions) const {
    std::vector<SampleSet> sets;
    for (const Vec3d& direction : directions) sets.push_back(mask_.SeenBy(CameraAt(direction)));
    return CamerasPerTriangle(mask_.Samples(), mask_.Mesh().triangles.size(), sets);
  }
};

TEST_F(SpherePictures, ColoursCountTheCameras) {
  // Cameras along x and y, looked at from z: +x +y both, +x -y and -x +y one, -x -y none.
  const std::vector<int> counts = Counts({Vec3d::UnitX(), Vec3d::UnitY()});
  const CameraModel above = CameraModel::FromFieldOfView(
      "", 200, 200, 0.25, 0.25, LookAt({0, 0, 1e5}, Vec3d::Zero(), Vec3d::UnitY()));
  const RgbPicture picture = MaskPainter(mask_.Mesh()).Counts(counts, colours_, above);
  const auto channel_at = [&](const Vec3d& point) {
    const Vec2d px = *above.Project(point);
    const Colour colour =
        picture.At(static_cast<int>(std::lround(px.x())), static_cast<int>(std::lround(px.y())));
    const auto brightest = std::max_element(colour.begin(), colour.end());
    EXPECT_EQ(colour[0] + colour[1] + colour[2], *brightest) << "a mixed colour";
    return brightest - colour.begin();
  };
  EXPECT_EQ(channel_at({40, 40, 82}), 2);
  EXPECT_EQ(channel_at({40, -40, 82}), 1);
  EXPECT_EQ(channel_at({-40, 40, 82}), 1);
  EXPECT_EQ(channel_at({-40, -40, 82}), 0);
  EXPECT_EQ(picture.At(0, 0), picture.At(199, 199));  // background
}

TEST_F(SpherePictures, EveryViewpointHoldsTheMesh) {
  for (const Viewpoint& view : ViewpointsOf(mask_.Mesh(), 120, 90)) {
    for (const Vec3f& position : mask_.Mesh().positions) {
      const auto px = view.camera.Project(position.cast<double>());
      ASSERT_TRUE(px && view.camera.InFrame(*px)) << view.name;
    }
  }
}

TEST_F(SpherePictures, NozzlesHideTheMaskBehindThem) {
  const CameraModel camera = CameraModel::FromFieldOfView(
      "", 160, 120, 12.0, 9.0, LookAt({1600, 0, 0}, Vec3d::Zero(), Vec3d::UnitZ()));
  const MaskPainter painter(mask_.Mesh());
  const auto is_grey = [](const Colour& c) { return c[0] == c[1] && c[1] == c[2]; };
  const RgbPicture free = painter.Ids(camera, Mat3d::Identity(), {});
  EXPECT_FALSE(is_grey(free.At(80, 60)));
  // A rod across the line of sight at 800 mm, and the same one behind the mask.
  PlacedNozzle rod;
  rod.snout = {{800, -5, 0}, Vec3d::UnitY(), 10.0, 5.0, 5.0};
  rod.cylinder = {{0, 0, 5000}, Vec3d::UnitZ(), 10.0, 5.0, 5.0};
  EXPECT_TRUE(is_grey(painter.Ids(camera, Mat3d::Identity(), {rod}).At(80, 60)));
  rod.snout.base.x() = -800.0;
  EXPECT_EQ(painter.Ids(camera, Mat3d::Identity(), {rod}).rgb, free.rgb);
}

TEST(MaskPicture, OpenMeshesAreSeenFromTheirFront) {
  const Scenario scenario = LoadScenario("1a");
  const TriangleMesh face = MaskMesh(scenario.Mask("face"), scenario.file);
  const TriangleMesh body = MaskMesh(scenario.Mask("body"), scenario.file);
  EXPECT_GT(-ViewpointsOf(face, 80, 80)[1].camera.Forward().x(), 0.9);  // it looks along +x
  EXPECT_GT(-ViewpointsOf(body, 80, 80)[1].camera.Forward().z(), 0.9);  // it lies face up
}

TEST(VaultDrawing, DrawsEveryCameraTwice) {
  const Scenario scenario = LoadScenario("2");
  const VaultSetup setup{scenario, {50.0, 47.21, 70.52}, SetOf({0, 1, 4}), {}, {}};
  const PlotlyFigure figure = DrawVault(setup);
  size_t cameras = 0;
  for (const nlohmann::json& trace : figure.traces) {
    if (trace["mode"] == "markers+text") cameras += trace["x"].size();
  }
  EXPECT_EQ(cameras, 18u);
}

}  // namespace
}  // namespace retrolux
