// Places for markers: what cameras see, what a pair is worth, and the search.
#include "analysis/marker_layout.h"

#include <gtest/gtest.h>

#include "analysis/stereo_study.h"
#include "core/error.h"
#include "scenes/built_in.h"
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

// The front of the oval is seen by both, its back by none, and the side 40 degrees to the left of
// the middle is 55 degrees off the right camera.
TEST(SeePlaces, FollowsTheAngle) {
  const Scene scene = TwoCameras();
  const double angle = RadFromDeg(-40.0);
  const Vec3d side(std::cos(angle), std::sin(angle), 0.0);
  const std::vector<MarkerPlace> places = {
      {{100, 0, 0}, Vec3d::UnitX()}, {{-100, 0, 0}, -Vec3d::UnitX()}, {100.0 * side, side}};
  const SightTable table = SeePlaces(scene, {{"here", {}}}, places, 45.0, NoProgress());
  EXPECT_EQ(table.seen[0][0], (std::vector<uint8_t>{1, 0, 1}));
  EXPECT_EQ(table.seen[0][1], (std::vector<uint8_t>{1, 0, 0}));
}

TEST(FindLayout, SpreadsMarkersThatThePairSees) {
  const Scene scene = TwoCameras();
  const std::vector<Pose> poses = {{"here", {}}};
  LayoutOptions options;
  options.candidate_mm2 = 600.0;
  options.starts = 2;
  options.relative_sigma = {1.0, 1.0, 1.0, 5.0};
  const std::vector<MarkerPlace> places = CandidatePlaces(scene, options);
  const SightTable table = SeePlaces(scene, poses, places, 45.0, NoProgress());
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
  const std::vector<MarkerPlace> places = CandidatePlaces(scene, options);
  const SightTable table = SeePlaces(scene, {{"here", {}}}, places, 45.0, NoProgress());
  EXPECT_THROW(FindLayout(scene, table, places, options, NoProgress()), InputError);
}

}  // namespace
}  // namespace retrolux
