// Places for markers: what cameras see, what a pair is worth, and the search.
#include "analysis/marker_layout.h"

#include <gtest/gtest.h>

#include "analysis/stereo_study.h"
#include "core/error.h"
#include "scenes/built_in.h"
#include "scenes/masks.h"
#include "scenes/mesh_shapes.h"
#include "scenes/scene_parts.h"

namespace retrolux {
namespace {

// The oval with two cameras 30 degrees apart before it, in the plane z = 0.
Scene TwoCameras() {
  Scene scene = OvalScene();
  scene.cameras.clear();
  scene.markers.clear();
  for (const double deg : {-15.0, 15.0}) {
    const double angle = RadFromDeg(deg);
    scene.cameras.push_back(ThesisCamera(deg < 0 ? "left" : "right",
                                         {1600 * std::cos(angle), 1600 * std::sin(angle), 0},
                                         Vec3d::UnitZ()));
  }
  for (SceneObject& object : scene.objects) object.moves_with_pose = true;
  return scene;
}

// Four corners of a square about the target: d = 0 there, so TRE = FLE / sqrt(N) (Fitzpatrick),
// with the FLE of the two rays. Three points on a line fix no pose.
TEST(PairTre, IsFitzpatricksAtTheCentre) {
  const Scene scene = TwoCameras();
  const CameraModel& a = scene.cameras[0].model;
  const CameraModel& b = scene.cameras[1].model;
  EXPECT_NEAR(SeparationDeg(a, b, Vec3d::Zero()), 30.0, 1e-9);
  const double fle = RaySigma_mm(0.05 * 1600.0 / a.fx, 30.0).norm();
  std::vector<SharedMarker> square = {
      {{0, 40, 40}}, {{0, -40, 40}}, {{0, -40, -40}}, {{0, 40, -40}}};
  EXPECT_NEAR(PairTre_mm(square, a, b, Vec3d::Zero(), 0.05), fle / 2.0, 1e-9);
  const std::vector<SharedMarker> line = {{{0, 0, 0}}, {{0, 0, 10}}, {{0, 0, 20}}};
  EXPECT_TRUE(std::isinf(PairTre_mm(line, a, b, Vec3d::Zero(), 0.05)));
  const std::vector<SharedMarker> two = {{{0, 0, 0}}, {{0, 10, 10}}};
  EXPECT_TRUE(std::isinf(PairTre_mm(two, a, b, Vec3d::Zero(), 0.05)));
  // All three times as uncertain: so is the pose.
  for (SharedMarker& m : square) m.relative_sigma = 3.0;
  EXPECT_NEAR(PairTre_mm(square, a, b, Vec3d::Zero(), 0.05), 3.0 * fle / 2.0, 1e-9);
  // Two of them, at opposite corners, good again: the weighted centre stays at the target, where
  // 1 / TRE^2 is the sum of the weights, 2 + 2 / 9, over FLE^2.
  square[0].relative_sigma = square[2].relative_sigma = 1.0;
  EXPECT_NEAR(PairTre_mm(square, a, b, Vec3d::Zero(), 0.05), fle / std::sqrt(2.0 + 2.0 / 9.0),
              1e-9);
}

const Bsdf& Sheeting() {
  static const Material material = LibraryMaterial("retro_bead");
  return *material.bsdf;
}

// The front of the oval is seen by both, its back by none, and the side 40 degrees to the left of
// the middle is 55 degrees off the right camera. The normals 10 mm from a place are turned by up to
// asin(10 / 100) = 5.7 degrees: the front is 15 degrees off both cameras, 21 at its rim.
TEST(SeePlaces, FollowsTheAngle) {
  const Scene scene = TwoCameras();
  const double angle = RadFromDeg(-40.0);
  const Vec3d side(std::cos(angle), std::sin(angle), 0.0);
  const std::vector<MarkerPlace> places = {
      {{100, 0, 0}, Vec3d::UnitX()}, {{-100, 0, 0}, -Vec3d::UnitX()}, {100.0 * side, side}};
  const auto seen = [&](double max_incidence_deg) {
    return SeePlaces(scene, {{"here", {}}}, places, Sheeting(), {max_incidence_deg, 1e3},
                     NoProgress())
        .seen[0];
  };
  EXPECT_EQ(seen(45.0)[0], (std::vector<uint8_t>{1, 0, 1}));
  EXPECT_EQ(seen(45.0)[1], (std::vector<uint8_t>{1, 0, 0}));
  EXPECT_EQ(seen(22.5)[1], (std::vector<uint8_t>{1, 0, 0}));
  EXPECT_EQ(seen(20.0)[1], (std::vector<uint8_t>{0, 0, 0}));
}

// A matt surface (Lambert's) is as bright as the cosine of the light's incidence, here also the
// camera's. On the oval's equator, a circle of 100 mm, the points 10 mm to both sides of a place
// are turned by asin(0.1): one is the brightest of the nine, the other the dimmest.
TEST(SeePlaces, FollowsTheFallOfTheLight) {
  const Scene scene = TwoCameras();
  const Material matt = LibraryMaterial("white_paint");
  const double angle = RadFromDeg(-30.0), turn = std::asin(0.1);
  const auto normal = [](double a) -> Vec3d { return {std::cos(a), std::sin(a), 0.0}; };
  const auto cosine = [&](double a) {
    return normal(a).dot((scene.cameras[1].model.Centre() - 100.0 * normal(a)).normalized());
  };
  const double fall = cosine(angle + turn) / cosine(angle - turn);
  EXPECT_GT(fall, 1.1);
  const std::vector<MarkerPlace> place = {{100.0 * normal(angle), normal(angle)}};
  const auto seen = [&](double max_fall) {
    return SeePlaces(scene, {{"here", {}}}, place, *matt.bsdf, {85.0, max_fall}, NoProgress())
        .seen[0][1][0];
  };
  EXPECT_FALSE(seen(0.998 * fall));
  EXPECT_TRUE(seen(1.002 * fall));
}

// A flat panel has no fall; a place nearer than 10 mm to where it ends is none.
TEST(SeePlaces, WantsMaskAllAround) {
  Scene scene = TwoCameras();
  for (SceneObject& object : scene.objects)
    object.mesh = RectangleMesh({100, -50, -50}, {0, 100, 0}, {0, 0, 100});
  const std::vector<MarkerPlace> places = {{{100, 0, 0}, Vec3d::UnitX()},
                                           {{100, 39, 0}, Vec3d::UnitX()},
                                           {{100, 41, 0}, Vec3d::UnitX()}};
  const SightTable table =
      SeePlaces(scene, {{"here", {}}}, places, Sheeting(), {45.0, 1.05}, NoProgress());
  EXPECT_EQ(table.seen[0][0], (std::vector<uint8_t>{1, 1, 0}));
}

// Rendered in the CT room at this place on the face's forehead (57 poses), `robust` named the notch
// in none of 55 pictures of the front-left camera that showed it whole, 38 to 41 degrees off, where
// the forehead turns by up to 12 degrees within the marker; and in all 56 of the front-middle one.
TEST(SeePlaces, LeavesOutWhatWasNotNamed) {
  Scene scene = CtRoom();
  for (SceneObject& object : scene.objects) {
    if (object.name == "mask") object.mesh = FaceMask();
  }
  const Vec3d forehead(104.3, -9.9, 64.3);
  std::vector<MarkerPlace> places = CandidatePlaces(scene, 300.0, 1);
  const auto nearest =
      std::min_element(places.begin(), places.end(), [&](const auto& a, const auto& b) {
        return (a.at - forehead).norm() < (b.at - forehead).norm();
      });
  ASSERT_LT((nearest->at - forehead).norm(), 0.1);
  const SightTable table =
      SeePlaces(scene, {{"reference", {}}}, {*nearest}, Sheeting(), SightLimits(), NoProgress());
  const auto seen = [&](const std::string& name) {
    for (size_t c = 0; c < scene.cameras.size(); ++c) {
      if (scene.cameras[c].model.name == name) return table.seen[0][c][0] != 0;
    }
    throw std::logic_error("no camera " + name);
  };
  EXPECT_FALSE(seen("front-left"));
  EXPECT_TRUE(seen("front-middle"));
}

TEST(FindLayout, SpreadsMarkersThatThePairSees) {
  const Scene scene = TwoCameras();
  const std::vector<Pose> poses = {{"here", {}}};
  LayoutOptions options;
  options.candidate_mm2 = 600.0;
  options.starts = 2;
  options.relative_sigma = {1.0, 1.0, 1.0, 5.0};
  const std::vector<MarkerPlace> places =
      CandidatePlaces(scene, options.candidate_mm2, options.seed);
  const SightTable table = SeePlaces(scene, poses, places, Sheeting(), options.sight, NoProgress());
  const MarkerLayout layout = FindLayout(scene, table, places, options, NoProgress());
  EXPECT_EQ(layout.least_common, 4);
  std::vector<SharedMarker> points;
  for (const size_t place : layout.places) {
    EXPECT_TRUE(table.seen[0][0][place] && table.seen[0][1][place]);
    for (const SharedMarker& other : points)
      EXPECT_GE((other.at - places[place].at).norm(), options.clearance_mm);
    points.push_back({places[place].at, options.relative_sigma[points.size()]});
  }
  EXPECT_NEAR(layout.worst_tre_mm,
              PairTre_mm(points, scene.cameras[0].model, scene.cameras[1].model, Vec3d::Zero(),
                         options.point_sigma_px),
              1e-12);
  // No exchange of one place makes it better: that is where the search ends.
  for (size_t i = 0; i < points.size(); ++i) {
    for (size_t place = 0; place < places.size(); ++place) {
      if (!table.seen[0][0][place] || !table.seen[0][1][place]) continue;
      std::vector<SharedMarker> other = points;
      other[i].at = places[place].at;
      bool apart = true;
      for (size_t k = 0; k < other.size(); ++k)
        apart &= k == i || (other[k].at - other[i].at).norm() >= options.clearance_mm;
      if (!apart) continue;
      EXPECT_GE(PairTre_mm(other, scene.cameras[0].model, scene.cameras[1].model, Vec3d::Zero(),
                           options.point_sigma_px),
                layout.worst_tre_mm - 1e-12);
    }
  }
}

TEST(FindLayout, SaysIfThereIsNone) {
  Scene scene = TwoCameras();
  scene.cameras.pop_back();  // no pair
  LayoutOptions options;
  options.candidate_mm2 = 2000.0;
  options.starts = 1;
  const std::vector<MarkerPlace> places =
      CandidatePlaces(scene, options.candidate_mm2, options.seed);
  const SightTable table =
      SeePlaces(scene, {{"here", {}}}, places, Sheeting(), options.sight, NoProgress());
  EXPECT_THROW(FindLayout(scene, table, places, options, NoProgress()), InputError);
}

}  // namespace
}  // namespace retrolux
