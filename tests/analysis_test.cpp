#include <gtest/gtest.h>

#include "analysis/marker_coverage.h"
#include "analysis/marker_study_gain.h"
#include "scenes/built_in.h"

namespace retrolux {
namespace {

TEST(MarkerGrid, CellsCoverTheFaceHalf) {
  // Prolate spheroid with a = 100, c = 140: S = 2 pi a^2 (1 + c / (a e) asin e), e = sqrt(1 -
  // a^2/c^2); half of it.
  const double e = std::sqrt(1.0 - 100.0 * 100.0 / (140.0 * 140.0));
  const double half = kPi * 1e4 * (1.0 + 1.4 / e * std::asin(e));
  EXPECT_NEAR(marker_grid::FaceHalfArea_mm2(), half, 1e-3 * half * 1e-3);
  EXPECT_NEAR(half, 80133.0, 1.0);  // the thesis's figure
}

TEST(MarkerGrid, PointsLieOnTheOval) {
  for (int row = 0; row < marker_grid::kRows; ++row) {
    for (int col = 0; col < marker_grid::kColumns; ++col) {
      const Vec3d p = marker_grid::Point({row, col});
      EXPECT_NEAR(p.head<2>().squaredNorm() / 1e4 + p.z() * p.z() / (140.0 * 140.0), 1.0, 1e-12);
      EXPECT_GT(p.y(), 0.0);
      EXPECT_EQ(marker_grid::Point({row, col, true}).y(), -p.y());
    }
  }
  // Neighbours are 10 mm apart along z and 11.2 mm around at the widest place.
  EXPECT_NEAR((marker_grid::Point({14, 0}) - marker_grid::Point({14, 1})).norm(), 11.2, 0.1);
}

// A study without pictures: what the sets make of given hits.
MarkerStudy StudyWith(const std::vector<PictureResult>& results) {
  MarkerStudy study;
  study.options.markers = {2};
  study.poses = {{"reference", {}}, {"start", {}}, {"end", {}}};
  study.cameras = {"front-middle", "front-left", "front-right",
                   "back-middle",  "back-left",  "back-right"};
  study.results = results;
  return study;
}

PictureResult HitAt(int pose, int camera, int row, int col) {
  PictureResult result;
  result.marker = 2;
  result.pose = pose;
  result.camera = camera;
  result.position = {row, col};
  result.outcome = Outcome::kHit;
  return result;
}

TEST(StudyCoverage, SetsAsTheyAreDefined) {
  std::vector<PictureResult> hits;
  // Cell (3, 4): one front and one back camera in reference: satisfies, but neither front nor back.
  hits.push_back(HitAt(0, 0, 3, 4));
  hits.push_back(HitAt(0, 3, 3, 4));
  // Cell (5, 6): front pair in reference and start, back pair in reference and end: expanded, not
  // all.
  for (const int pose : {0, 1}) {
    hits.push_back(HitAt(pose, 0, 5, 6));
    hits.push_back(HitAt(pose, 2, 5, 6));
  }
  for (const int pose : {0, 2}) {
    hits.push_back(HitAt(pose, 4, 5, 6));
    hits.push_back(HitAt(pose, 5, 5, 6));
  }
  const MarkerStudy study = StudyWith(hits);
  const StudyCoverage coverage(study);
  const double area3 = 2.0 * marker_grid::CellArea_mm2(3),
               area5 = 2.0 * marker_grid::CellArea_mm2(5);
  EXPECT_NEAR(coverage.Set("satisfies", 2, "reference")->area_mm2, area3 + area5, 1e-9);
  EXPECT_NEAR(coverage.Set("front", 2, "reference")->area_mm2, area5, 1e-9);
  EXPECT_NEAR(coverage.Set("both", 2, "reference")->area_mm2, area5, 1e-9);
  EXPECT_NEAR(coverage.Set("front", 2, "start")->area_mm2, area5, 1e-9);
  EXPECT_EQ(coverage.Set("both", 2, "start")->area_mm2, 0.0);
  EXPECT_EQ(coverage.Set("all", 2, "")->area_mm2, 0.0);
  EXPECT_NEAR(coverage.Set("expanded", 2, "")->area_mm2, area5, 1e-9);
  EXPECT_EQ(coverage.CamerasHit(2, 0, 5, 6), 4);
}

TEST(StudyCoverage, SymmetryComparesMirroredCameras) {
  MarkerStudy study = StudyWith({HitAt(0, 1, 3, 4)});  // front-left
  PictureResult mirrored = HitAt(0, 2, 3, 4);          // front-right sees the mirrored position
  mirrored.position.mirrored = true;
  study.mirrored = {mirrored};
  EXPECT_EQ(CheckSymmetry(study).pictures, 1);
  EXPECT_EQ(CheckSymmetry(study).agree, 1);
  study.mirrored[0].outcome = Outcome::kNotDetected;
  EXPECT_EQ(CheckSymmetry(study).agree, 0);
}

TEST(ScanPoses, Every5mmFromEndToEnd) {
  const std::vector<Pose> poses = ScanPoses(CtRoom(), 5.0);
  ASSERT_EQ(poses.size(), 57u);
  EXPECT_EQ(poses.front().translation.z(), 140.0);
  EXPECT_EQ(poses[28].name, "z+0");
  EXPECT_EQ(poses.back().name, "z-140");
}

// Cell (3, 4): two cameras by the method, one of them by edges too: won. Cell (5, 6): two by edges,
// one of them by the method too: lost. One more that both see alike.
TEST(MethodGain, CountsWhatIsWonAndLost) {
  const auto seen = [](int camera, int row, int col, bool method, bool edges) {
    PictureResult r = HitAt(0, camera, row, col);
    if (!method) r.outcome = Outcome::kNotDetected;
    r.edges_hit = edges;
    return r;
  };
  MarkerStudy study =
      StudyWith({seen(0, 3, 4, true, true), seen(1, 3, 4, true, false), seen(0, 5, 6, true, true),
                 seen(1, 5, 6, false, true), seen(0, 7, 8, true, true), seen(1, 7, 8, true, true)});
  const StudyCoverage coverage(study);
  EXPECT_FALSE(GainOverEdges(study, coverage).has_value());
  study.options.method = kRobustMethod;
  const auto gain = GainOverEdges(study, coverage);
  ASSERT_TRUE(gain.has_value());
  EXPECT_EQ(gain->both, 4);
  EXPECT_EQ(gain->only_method, 1);
  EXPECT_EQ(gain->only_edges, 1);
  const SetGain& satisfies = gain->sets.front();
  EXPECT_EQ(satisfies.set.name, "satisfies");
  EXPECT_EQ(satisfies.won, 1);
  EXPECT_EQ(satisfies.lost, 1);
  const double cell_pct = 200.0 / marker_grid::FaceHalfArea_mm2();
  EXPECT_NEAR(satisfies.set.percent - satisfies.edges_pct,
              cell_pct * (marker_grid::CellArea_mm2(3) - marker_grid::CellArea_mm2(5)), 1e-9);
}

TEST(MarkerStudy, WrongScenesAreRefused) {
  MarkerStudyOptions options;
  const Scene oval = OvalScene();
  try {
    RunMarkerStudy(oval, options, testing::TempDir(), NoProgress());
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "scene 'oval': camera 'camera'; expected names that begin with 'front' or 'back'");
  }
}

}  // namespace
}  // namespace retrolux
