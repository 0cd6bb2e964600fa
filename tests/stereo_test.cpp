// Triangulation, registration, names by position and tracking against exact projections, closed
// forms and Monte Carlo.
#include "classifier/stereo.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "classifier/camera_file.h"
#include "classifier/detections_json.h"
#include "classifier/projection.h"
#include "classifier/tracking.h"
#include "core/atomic_file.h"
#include "core/rng.h"
#include "tests/message_of.h"
#include "tests/own_folder.h"
#include "tests/statistics.h"

namespace retrolux {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// The thesis's camera with a strong lens distortion, 1600 mm from the origin at an azimuth.
CameraModel CameraAt(double azimuth_deg, const std::string& name = "camera") {
  const double a = RadFromDeg(azimuth_deg);
  const Vec3d eye = 1600.0 * Vec3d(std::cos(a), std::sin(a), 0.1);
  CameraModel camera = CameraModel::FromFieldOfView(name, 640, 480, 12.18, 9.15,
                                                    LookAt(eye, Vec3d::Zero(), Vec3d::UnitZ()));
  camera.distortion = Distortion(-0.3, 0.8, 0.002, -0.001, 0.1);
  return camera;
}

// Two independent standard normal numbers (Box and Muller).
Vec2d Normal2(KeyedRng& rng) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - rng.NextDouble()));
  const double angle = 2.0 * kPi * rng.NextDouble();
  return radius * Vec2d(std::cos(angle), std::sin(angle));
}

Vec3d Normal3(KeyedRng& rng) {
  const Vec2d a = Normal2(rng), b = Normal2(rng);
  return {a.x(), a.y(), b.x()};
}

Vec3d InCube(KeyedRng& rng, double half_mm) {
  return half_mm *
         Vec3d(2 * rng.NextDouble() - 1, 2 * rng.NextDouble() - 1, 2 * rng.NextDouble() - 1);
}

std::vector<Sighting> Seen(const std::vector<CameraModel>& cameras, const Vec3d& x,
                           double sigma_px = 0.05) {
  std::vector<Sighting> sightings;
  for (const CameraModel& camera : cameras)
    sightings.push_back({&camera, *camera.Project(x), sigma_px});
  return sightings;
}

TEST(Projection, SlopeIsThatOfProject) {
  const CameraModel camera = CameraAt(20.0);
  const Vec3d x(30.0, -40.0, 50.0);
  const auto projection = ProjectWithSlope(camera, x);
  ASSERT_TRUE(projection);
  constexpr double kStep_mm = 1e-3;  // central differences: error of third order, below 1e-9 px
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Vec3d step = kStep_mm * Vec3d::Unit(axis);
    const Vec2d slope = (*camera.Project(x + step) - *camera.Project(x - step)) / (2.0 * kStep_mm);
    EXPECT_LT((slope - projection->per_mm.col(axis)).norm(), 1e-7);
  }
}

// --- triangulation ---

TEST(Triangulation, ExactProjectionsGiveThePoint) {
  KeyedRng rng(1);
  for (const double psi_deg : {2.0, 15.0, 45.0, 90.0, 150.0}) {
    const std::vector<CameraModel> pair = {CameraAt(-0.5 * psi_deg), CameraAt(0.5 * psi_deg)};
    std::vector<CameraModel> four = pair;
    four.push_back(CameraAt(0.5 * psi_deg + 20.0));
    four.push_back(CameraAt(-0.5 * psi_deg - 30.0));
    for (int i = 0; i < 20; ++i) {
      const Vec3d x = InCube(rng, 90.0);
      for (const auto& cameras : {pair, four}) {
        const auto found = Triangulate(Seen(cameras, x), {});
        ASSERT_TRUE(found.point) << found.refusal;
        // The condition of the problem is 1 / sin(psi / 2): 57 at 2 degrees.
        EXPECT_LT((found.point->position - x).norm(), 1e-9) << psi_deg;
        EXPECT_LT(found.point->rms_px, 1e-9);
      }
    }
  }
}

// The squared Mahalanobis distance of estimates from the truth is chi-square with 3 degrees of
// freedom if the covariance is right. 4000 draws in 20 cells of equal probability; the p-value of
// their counts below 1e-3 would fail. Cameras at 25 degrees: errors differ by 4.5 over the axes, so
// that a wrong axis shows.
TEST(Triangulation, CovarianceIsThatOfTheErrors) {
  const std::vector<CameraModel> cameras = {CameraAt(0.0), CameraAt(25.0)};
  const Vec3d x(20.0, -30.0, 40.0);
  TriangulationOptions options;
  options.max_residual_px = 5.0;  // 25 sigma: nothing is cut off
  KeyedRng rng(7);
  constexpr int kDraws = 4000, kCells = 20;
  std::vector<double> counts(kCells), expected(kCells, 1.0 * kDraws / kCells);
  for (int i = 0; i < kDraws; ++i) {
    std::vector<Sighting> sightings = Seen(cameras, x);
    sightings[0].sigma_px = 0.05;
    sightings[1].sigma_px = 0.2;
    for (Sighting& s : sightings) s.px += s.sigma_px * Normal2(rng);
    const auto found = Triangulate(sightings, options);
    ASSERT_TRUE(found.point);
    const Vec3d off = found.point->position - x;
    const double distance2 = off.dot(found.point->covariance.inverse() * off);
    const double upper = statistics::UpperGamma(1.5, 0.5 * distance2);
    ++counts[std::min<size_t>(kCells - 1, static_cast<size_t>(upper * kCells))];
  }
  EXPECT_GT(statistics::ChiSquarePValue(counts, expected), 1e-3);
}

// Rays of two cameras with 1 sigma e (mm at the point) across each: the error along the bisector is
// e / (sqrt(2) sin(psi / 2)), across it in their plane e / (sqrt(2) cos(psi / 2)), off the plane
// e / sqrt(2) (docs/stereo.md). Undistorted cameras, a point in the middle: pixels per mm f / d.
TEST(Triangulation, CovarianceFollowsTheAngle) {
  for (const double psi_deg : {15.0, 45.0, 90.0, 150.0}) {
    std::vector<CameraModel> cameras;
    for (const double side : {-0.5, 0.5}) {
      const double a = RadFromDeg(side * psi_deg);
      const Vec3d eye = 1600.0 * Vec3d(std::cos(a), std::sin(a), 0.0);
      cameras.push_back(CameraModel::FromFieldOfView("camera", 640, 480, 12.18, 9.15,
                                                     LookAt(eye, Vec3d::Zero(), Vec3d::UnitZ())));
      cameras.back().fy = cameras.back().fx;
    }
    constexpr double kSigma_px = 0.1;
    const auto found = Triangulate(Seen(cameras, Vec3d::Zero(), kSigma_px), {});
    ASSERT_TRUE(found.point);
    const double e_mm = kSigma_px * 1600.0 / cameras[0].fx;
    const double half = RadFromDeg(0.5 * psi_deg);
    const Vec3d sigma = found.point->covariance.diagonal().cwiseSqrt();
    EXPECT_NEAR(sigma.x(), e_mm / (std::sqrt(2.0) * std::sin(half)), 1e-9);
    EXPECT_NEAR(sigma.y(), e_mm / (std::sqrt(2.0) * std::cos(half)), 1e-9);
    EXPECT_NEAR(sigma.z(), e_mm / std::sqrt(2.0), 1e-9);
  }
}

TEST(Triangulation, OneWrongViewOfThreeIsLeftOut) {
  const std::vector<CameraModel> cameras = {CameraAt(-30.0), CameraAt(10.0), CameraAt(50.0)};
  const Vec3d x(10.0, 20.0, -30.0);
  for (size_t wrong = 0; wrong < 3; ++wrong) {
    std::vector<Sighting> sightings = Seen(cameras, x);
    sightings[wrong].px += Vec2d(4.0, 7.0);
    const auto found = Triangulate(sightings, {});
    ASSERT_TRUE(found.point) << found.refusal;
    for (size_t i = 0; i < 3; ++i) EXPECT_EQ(found.point->used[i], i != wrong);
    EXPECT_LT((found.point->position - x).norm(), 1e-9);
    EXPECT_LT((found.point->residuals_px[wrong] - Vec2d(4.0, 7.0)).norm(), 1e-6);
  }
}

TEST(Triangulation, TwoWrongViewsOfFiveAreLeftOut) {
  std::vector<CameraModel> cameras;
  for (const double azimuth_deg : {-60.0, -25.0, 0.0, 30.0, 70.0})
    cameras.push_back(CameraAt(azimuth_deg));
  const Vec3d x(10.0, 20.0, -30.0);
  std::vector<Sighting> sightings = Seen(cameras, x);
  sightings[1].px += Vec2d(6.0, -8.0);
  sightings[4].px += Vec2d(-5.0, 9.0);
  const auto found = Triangulate(sightings, {});
  ASSERT_TRUE(found.point) << found.refusal;
  EXPECT_THAT(found.point->used, ElementsAre(true, false, true, true, false));
  EXPECT_LT((found.point->position - x).norm(), 1e-9);
}

// All cameras at one height: an error along the common epipolar line leaves every pair consistent,
// so which of three views is wrong cannot be told, and no point is made up.
TEST(Triangulation, RefusesWhatCannotBeTold) {
  std::vector<CameraModel> cameras;
  for (const double azimuth_deg : {-30.0, 0.0, 30.0}) {
    const double a = RadFromDeg(azimuth_deg);
    cameras.push_back(CameraModel::FromFieldOfView(
        "camera", 640, 480, 12.18, 9.15,
        LookAt(1600.0 * Vec3d(std::cos(a), std::sin(a), 0.0), Vec3d::Zero(), Vec3d::UnitZ())));
  }
  std::vector<Sighting> sightings = Seen(cameras, Vec3d::Zero());
  sightings[0].px.x() += 10.0;
  const auto along = Triangulate(sightings, {});
  EXPECT_FALSE(along.point);
  EXPECT_THAT(along.refusal, HasSubstr("3 groups of 2 of 3 views agree"));
  sightings = Seen({cameras[0], cameras[1]}, Vec3d::Zero());
  const auto across = [&] {
    std::vector<Sighting> two = Seen(cameras, Vec3d::Zero());
    two.pop_back();
    two[0].px.y() += 10.0;
    return Triangulate(two, {});
  }();
  EXPECT_FALSE(across.point);
  EXPECT_THAT(across.refusal, HasSubstr("no two of 2 views agree within 1.5 px"));
}

TEST(Triangulation, SaysWhyItCannot) {
  const CameraModel camera = CameraAt(0.0, "front"), near = CameraAt(0.5, "beside");
  const Vec3d x(10.0, 0.0, 0.0);
  const std::vector<Sighting> one = {{&camera, *camera.Project(x)}};
  EXPECT_THAT(MessageOf([&] { Triangulate(one, {}); }),
              HasSubstr("seen by 1 cameras; expected at least two"));
  const std::vector<Sighting> parallel = {{&camera, *camera.Project(x)}, {&near, *near.Project(x)}};
  EXPECT_THAT(
      MessageOf([&] { Triangulate(parallel, {}); }),
      testing::AllOf(HasSubstr("parallel to within 0.5"), HasSubstr("expected at least 1")));
}

// --- registration ---

RigidTransform SomePose() {
  return {Eigen::AngleAxisd(2.1, Vec3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix(),
          Vec3d(100.0, -200.0, 300.0)};
}

std::vector<PointPair> SomePairs(size_t count, const RigidTransform& pose) {
  KeyedRng rng(3);
  std::vector<PointPair> pairs;
  for (size_t i = 0; i < count; ++i) {
    const Vec3d x = InCube(rng, 80.0);
    pairs.push_back({x, pose * x});
  }
  return pairs;
}

TEST(Registration, ExactPointsGiveThePose) {
  for (const size_t count : {3u, 4u, 6u, 20u}) {
    std::vector<PointPair> pairs = SomePairs(count, SomePose());
    for (size_t i = 0; i < count; ++i) pairs[i].weight = 1.0 + static_cast<double>(i);
    const Registration found = RegisterPoints(pairs);
    EXPECT_LT((found.b_from_a.rotation - SomePose().rotation).norm(), 1e-12);
    EXPECT_LT((found.b_from_a.translation - SomePose().translation).norm(), 1e-10);
    EXPECT_LT(found.fre_mm, 1e-10);
  }
}

// Points in a plane can be mirrored without a trace; never do it.
TEST(Registration, NeverMirrors) {
  std::vector<PointPair> pairs = SomePairs(5, {});
  for (PointPair& pair : pairs) pair.in_b = Vec3d(pair.in_a.x(), pair.in_a.y(), -pair.in_a.z());
  EXPECT_NEAR(RegisterPoints(pairs).b_from_a.rotation.determinant(), 1.0, 1e-12);
  for (PointPair& pair : pairs) {
    pair.in_a.z() = 0.0;
    pair.in_b = SomePose() * pair.in_a;
  }
  EXPECT_LT((RegisterPoints(pairs).b_from_a.rotation - SomePose().rotation).norm(), 1e-12);
}

// A weight of k counts like k points at the same place.
TEST(Registration, WeightsCountPoints) {
  std::vector<PointPair> weighted = SomePairs(5, SomePose());
  KeyedRng rng(5);
  for (PointPair& pair : weighted) pair.in_b += Normal3(rng);
  weighted[2].weight = 3.0;
  std::vector<PointPair> repeated = weighted;
  repeated[2].weight = 1.0;
  repeated.insert(repeated.end(), 2, repeated[2]);
  const Registration a = RegisterPoints(weighted), b = RegisterPoints(repeated);
  EXPECT_LT((a.b_from_a.rotation - b.b_from_a.rotation).norm(), 1e-12);
  EXPECT_NEAR(a.fre_mm, b.fre_mm, 1e-12);
}

// Sibson (1979): E[FRE^2] = (1 - 2 / N) FLE^2; Fitzpatrick, West, Maurer (1998): E[TRE^2]. Both
// hold to first order in FLE over the points' spread, here 1e-3, so that what is left out is below
// 1e-5 of them. 4000 registrations; mean of squares within 4 of its standard errors (significance
// 6e-5 each, 16 comparisons: 1e-3 together). Once with weights and errors that go with their
// inverse.
TEST(Registration, FreAndTreAsTheFormulasSay) {
  constexpr double kSigma_mm = 0.05;  // of each axis
  const double fle_mm = std::sqrt(3.0) * kSigma_mm;
  KeyedRng rng(11);
  for (const auto& [count, weighted] :
       {std::pair(3u, false), {4u, false}, {6u, false}, {6u, true}}) {
    std::vector<PointPair> exact = SomePairs(count, SomePose());
    // Their mean is 1, so that FLE is that of a point of mean weight.
    for (size_t i = 0; weighted && i < count; ++i) exact[i].weight = i % 2 == 0 ? 0.25 : 1.75;
    const std::vector<Vec3d> targets = {Vec3d::Zero(), Vec3d(0, 0, 200), Vec3d(150, -50, 30)};
    std::vector<double> fre2;
    std::vector<std::vector<double>> tre2(targets.size());
    for (int i = 0; i < 4000; ++i) {
      std::vector<PointPair> pairs = exact;
      for (PointPair& pair : pairs) pair.in_b += kSigma_mm / std::sqrt(pair.weight) * Normal3(rng);
      const Registration found = RegisterPoints(pairs);
      fre2.push_back(found.fre_mm * found.fre_mm);
      for (size_t t = 0; t < targets.size(); ++t)
        tre2[t].push_back((found.b_from_a * targets[t] - SomePose() * targets[t]).squaredNorm());
    }
    const auto fre = statistics::MomentsOf(fre2);
    EXPECT_NEAR(fre.mean, std::pow(ExpectedFre_mm(fle_mm, count), 2), 4.0 * fre.StandardError());
    for (size_t t = 0; t < targets.size(); ++t) {
      const auto tre = statistics::MomentsOf(tre2[t]);
      EXPECT_NEAR(tre.mean, std::pow(ExpectedTre_mm(exact, fle_mm, targets[t]), 2),
                  4.0 * tre.StandardError())
          << count << " points, target " << t;
    }
  }
}

TEST(Registration, SaysWhyItCannot) {
  std::vector<PointPair> pairs = SomePairs(2, {});
  EXPECT_THAT(MessageOf([&] { RegisterPoints(pairs); }),
              HasSubstr("2 points to register; expected three"));
  pairs.clear();
  for (int i = 0; i < 5; ++i) {
    const Vec3d x = Vec3d(1.0, 2.0, 3.0) + 20.0 * i * Vec3d(0.6, 0.0, 0.8);
    pairs.push_back({x, x});
  }
  EXPECT_THAT(MessageOf([&] { RegisterPoints(pairs); }), HasSubstr("lie on a line"));
  pairs = SomePairs(4, {});
  pairs[1].weight = 0.0;
  EXPECT_THAT(MessageOf([&] { RegisterPoints(pairs); }), HasSubstr("weight 0; expected above 0"));
}

TEST(MaskPose, AMisnamedMarkerIsLeftOut) {
  std::vector<PointPair> pairs = SomePairs(6, SomePose());
  std::swap(pairs[1].in_b, pairs[4].in_b);
  const PoseEstimate found = EstimatePose(pairs, 1.0);
  ASSERT_TRUE(found.pose) << found.refusal;
  EXPECT_THAT(found.pose->used, ElementsAre(true, false, true, true, false, true));
  EXPECT_LT((found.pose->world_from_mask.translation - SomePose().translation).norm(), 1e-9);
  std::swap(pairs[0].in_b, pairs[2].in_b);
  std::swap(pairs[3].in_b, pairs[5].in_b);
  const PoseEstimate none = EstimatePose(pairs, 1.0);
  EXPECT_FALSE(none.pose);
  EXPECT_THAT(none.refusal, HasSubstr("no three of 6 markers"));
}

// --- names by position ---

Detection Found(const Vec2d& px, std::optional<int> marker = std::nullopt) {
  Detection detection;
  detection.marker = marker;
  detection.centroid_px = px;
  return detection;
}

// Four identifiable markers and three standard ones on a mask of 200 mm; `stray_mm` beside the
// second standard one lies something else.
struct Mask {
  Constellation constellation = {
      {"one", 1, Vec3d(90, -45, -55)},  {"two", 2, Vec3d(90, 45, -55)},
      {"three", 3, Vec3d(90, -45, 55)}, {"four", 4, Vec3d(95, 45, 55)},
      {"left", 0, Vec3d(98, 20, 0)},    {"middle", 0, Vec3d(100, 0, 0)},
      {"right", 0, Vec3d(98, -20, 0)},
  };
  RigidTransform world_from_mask = {
      Eigen::AngleAxisd(0.1, Vec3d(1, 2, 3).normalized()).toRotationMatrix(), Vec3d(5, -8, 12)};
  std::vector<CameraView> views;

  explicit Mask(std::optional<double> stray_mm = std::nullopt) {
    for (const double azimuth_deg : {-25.0, 20.0}) {
      CameraView view{CameraAt(azimuth_deg, fmt::format("at {}", azimuth_deg)), {}};
      const auto see = [&](const Vec3d& x, std::optional<int> name) {
        view.detections.push_back(Found(*view.camera.Project(world_from_mask * x), name));
      };
      for (const KnownMarker& marker : constellation)
        see(marker.at, marker.number == 0 ? std::nullopt : std::optional(marker.number));
      if (stray_mm) see(constellation[5].at + Vec3d(0.0, 0.0, *stray_mm), std::nullopt);
      views.push_back(std::move(view));
    }
  }
};

TEST(PositionNames, StandardMarkersGetTheirNames) {
  const Mask mask;
  const StereoResult result = Reconstruct(mask.views, mask.constellation, {});
  ASSERT_TRUE(result.pose);
  EXPECT_TRUE(result.ambiguous.empty());
  ASSERT_EQ(result.markers.size(), 7u);
  for (size_t m = 0; m < 7; ++m) {
    const StereoMarker& marker = result.markers[m];
    ASSERT_TRUE(marker.point) << marker.name << ": " << marker.refusal;
    EXPECT_LT((marker.point->position - mask.world_from_mask * mask.constellation[m].at).norm(),
              1e-9);
    for (const StereoSighting& s : marker.sightings) EXPECT_EQ(s.by_position, m >= 4);
  }
  EXPECT_LT((result.pose->world_from_mask.rotation - mask.world_from_mask.rotation).norm(), 1e-11);
}

// 1 mm is 1.9 px; the gate is 3.72 x 0.4 = 1.5 px where the pose is exact.
TEST(PositionNames, AnAmbiguousNeighbourIsRefused) {
  const Mask mask(0.6);
  const StereoResult result = Reconstruct(mask.views, mask.constellation, {});
  const StereoMarker& middle = result.markers[5];
  EXPECT_FALSE(middle.point);
  EXPECT_EQ(middle.refusal, "not seen");
  EXPECT_THAT(result.ambiguous, ElementsAre(std::pair<size_t, std::string>(0, "middle"),
                                            std::pair<size_t, std::string>(1, "middle")));
  EXPECT_TRUE(result.markers[4].point);
  EXPECT_TRUE(result.markers[6].point);
  const Mask apart(1.2);
  EXPECT_TRUE(Reconstruct(apart.views, apart.constellation, {}).markers[5].point);
}

// A disc of radius 5 mm has 276 px2 here if it faces the camera.
TEST(PositionNames, WhatIsTooLargeIsNotTheMarker) {
  Mask mask;
  for (CameraView& view : mask.views) view.detections[5].area_px = 250.0;
  EXPECT_TRUE(Reconstruct(mask.views, mask.constellation, {}).markers[5].point);
  for (CameraView& view : mask.views) view.detections[5].area_px = 1000.0;
  EXPECT_EQ(Reconstruct(mask.views, mask.constellation, {}).markers[5].refusal, "not seen");
}

// A number that a picture holds twice identifies nothing; the constellation tells which is which.
TEST(PositionNames, ANumberTwiceIsNoName) {
  Mask mask;
  for (CameraView& view : mask.views)
    view.detections[5].marker = 1;  // the standard one in the middle
  mask.constellation.push_back({"five", 5, Vec3d(95, 0, 50)});
  for (CameraView& view : mask.views) {
    const Vec3d x = mask.world_from_mask * mask.constellation.back().at;
    view.detections.push_back(Found(*view.camera.Project(x), 5));
  }
  const StereoResult result = Reconstruct(mask.views, mask.constellation, {});
  ASSERT_TRUE(result.markers[0].point);
  EXPECT_TRUE(result.markers[0].sightings[0].by_position);
  EXPECT_FALSE(result.markers[5].point);  // what lies there says that it is marker 1
}

TEST(PositionNames, WithoutAConstellationNumbersAreMarkers) {
  const Mask mask;
  const StereoResult result = Reconstruct(mask.views, {}, {});
  ASSERT_EQ(result.markers.size(), 4u);
  EXPECT_EQ(result.markers[0].name, "marker-1");
  EXPECT_FALSE(result.pose);
  EXPECT_THAT(result.pose_refusal, HasSubstr("0 points to register"));
}

// --- tracking ---

using State = MarkerTracker::State;

// Marker 2 moves by (3, -1) px a frame and is accelerated; 7 stands 9 px beside it.
TEST(Tracking, FollowsWithoutANameOnceIdentified) {
  MarkerTracker tracker({{"two", 2}}, {});
  Vec2d px(100.0, 100.0), step(3.0, -1.0);
  for (int frame = 0; frame < 20; ++frame) {
    const auto name = frame == 0 ? std::optional(2) : std::nullopt;
    const auto& track = tracker.Next({Found({300.0, 300.0}), Found(px, name)}).front();
    ASSERT_EQ(track.state, State::kTracked) << frame;
    EXPECT_EQ(*track.detection, 1u);
    EXPECT_EQ(track.identified, frame == 0);
    px += step;
    step += Vec2d(0.2, 0.1);
  }
}

TEST(Tracking, NeverBeginsWithoutAName) {
  MarkerTracker tracker({{"two", 2}}, {});
  EXPECT_EQ(tracker.Next({Found({100.0, 100.0})}).front().state, State::kUnseen);
  EXPECT_EQ(tracker.Next({Found({100.0, 100.0}, 3)}).front().state, State::kUnseen);
  EXPECT_EQ(tracker.Next({Found({100.0, 100.0}, 2)}).front().state, State::kTracked);
  // What carries another name is not it.
  EXPECT_EQ(tracker.Next({Found({100.0, 100.0}, 3)}).front().state, State::kMissed);
}

TEST(Tracking, LosesAndReacquires) {
  MarkerTracker tracker({{"two", 2}}, {});
  tracker.Next({Found({100.0, 100.0}, 2)});
  tracker.Next({Found({102.0, 100.0}, 2)});
  // Hidden for three frames: found again where it is expected, without a name.
  for (int i = 0; i < 3; ++i) EXPECT_EQ(tracker.Next({}).front().state, State::kMissed);
  const auto& back = tracker.Next({Found({110.0, 100.0})}).front();
  EXPECT_EQ(back.state, State::kTracked);
  EXPECT_EQ(back.reacquired, 0);
  // Hidden for longer: lost, and what lies there without a name is not taken for it.
  for (int i = 0; i < 5; ++i) EXPECT_EQ(tracker.Next({}).front().state, State::kMissed);
  EXPECT_EQ(tracker.Next({}).front().state, State::kLost);
  EXPECT_EQ(tracker.Next({Found({110.0, 100.0})}).front().state, State::kLost);
  const auto& again = tracker.Next({Found({110.0, 100.0}), Found({180.0, 90.0}, 2)}).front();
  EXPECT_EQ(again.state, State::kTracked);
  EXPECT_EQ(*again.detection, 1u);
  EXPECT_EQ(again.reacquired, 1);
}

TEST(Tracking, RefusesAmbiguity) {
  MarkerTracker tracker({{"two", 2}}, {});
  tracker.Next({Found({100.0, 100.0}, 2)});
  // Two without names within the gate: neither. One of them named: that one.
  EXPECT_EQ(tracker.Next({Found({99.0, 100.0}), Found({101.0, 100.0})}).front().state,
            State::kMissed);
  EXPECT_EQ(*tracker.Next({Found({99.0, 100.0}), Found({101.0, 100.0}, 2)}).front().detection, 1u);
}

// What hides the marker lies just where it is expected, but has not its size.
TEST(Tracking, APlateBeforeTheMarkerIsNotTheMarker) {
  MarkerTracker tracker({{"two", 2}}, {});
  const auto pattern = [](double area_px, std::optional<int> name) {
    Detection detection = Found({100.0, 100.0}, name);
    detection.area_px = area_px;
    return detection;
  };
  tracker.Next({pattern(450.0, 2)});
  EXPECT_EQ(tracker.Next({pattern(420.0, std::nullopt)}).front().state, State::kTracked);
  EXPECT_EQ(tracker.Next({pattern(2500.0, std::nullopt)}).front().state, State::kMissed);
  EXPECT_EQ(tracker.Next({pattern(430.0, std::nullopt)}).front().state, State::kTracked);
}

// --- files ---

TEST(CameraFile, ReadsWhatRenderWrites) {
  const std::vector<CameraModel> cameras = {CameraAt(-20.0, "left"), CameraAt(25.0, "right")};
  const auto file = OwnFolder() / "cameras.yml";
  WriteTextFile(file, CamerasYaml(cameras));
  const std::vector<CameraModel> read = ReadCameras(file);
  ASSERT_EQ(read.size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read[i].name, cameras[i].name);
    EXPECT_EQ(read[i].width, cameras[i].width);
    EXPECT_EQ(read[i].distortion, cameras[i].distortion);
    const Vec3d x(10.0, 20.0, 30.0);
    EXPECT_EQ(*read[i].Project(x), *cameras[i].Project(x));
  }
}

TEST(CameraFile, SaysWhatIsWrong) {
  const auto file = OwnFolder() / "bad.yml";
  const std::string good = CamerasYaml({CameraAt(0.0)});
  const auto message = [&](const std::string& what, const std::string& by) {
    std::string text = good;
    text.replace(text.find(what), what.size(), by);
    WriteTextFile(file, text);
    return MessageOf([&] { ReadCameras(file); });
  };
  EXPECT_THAT(message("image_width: 640", "image_width: 0"),
              HasSubstr("/cameras/0/image_width: found number 0; expected a number from 1"));
  EXPECT_THAT(message("cols: 5", "cols: 2"), HasSubstr("bad.yml"));
  EXPECT_THAT(message("cameras:", "cams:"), HasSubstr("cameras: none"));
  EXPECT_THAT(message("R: ", "Q: "), HasSubstr("/cameras/0: found no key 'R'; expected 'R'"));
  EXPECT_THAT(message("%YAML", "{"), HasSubstr("bad.yml: "));
  EXPECT_THAT(MessageOf([] { ReadCameras("nowhere.yml"); }), HasSubstr("no such file"));
}

TEST(ConstellationFile, RoundTrip) {
  Mask mask;
  mask.constellation[4].normal = Vec3d(0.6, 0.0, 0.8);
  const auto file = OwnFolder() / "constellation.json";
  WriteTextFile(file, ConstellationJson(mask.constellation).dump());
  const Constellation read = ReadConstellation(file, DefaultMarkerSet());
  ASSERT_EQ(read.size(), mask.constellation.size());
  for (size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].name, mask.constellation[i].name);
    EXPECT_EQ(read[i].number, mask.constellation[i].number);
    EXPECT_EQ(read[i].at, mask.constellation[i].at);
    EXPECT_EQ(read[i].normal, mask.constellation[i].normal);
  }
}

TEST(ConstellationFile, SaysWhatIsWrong) {
  const auto file = OwnFolder() / "wrong.json";
  const auto message = [&](const std::string& markers) {
    WriteTextFile(file, R"({"schema": "retrolux/constellation-1", "markers": )" + markers + "}");
    return MessageOf([&] { ReadConstellation(file, DefaultMarkerSet()); });
  };
  EXPECT_THAT(message(R"([{"name": "a", "marker": 9, "at_mm": [0, 0, 0]}])"),
              HasSubstr("found 9; expected 1, 2, 3, 4, 5, 6 or \"standard\""));
  EXPECT_THAT(message(R"([{"name": "a", "marker": 1, "at_mm": [0, 0]}])"),
              HasSubstr("/markers/0/at_mm"));
  EXPECT_THAT(message(R"([{"name": "a", "marker": 1, "at_mm": [0, 0, 0]},
                          {"name": "a", "marker": 2, "at_mm": [9, 0, 0]}])"),
              HasSubstr("the name 'a' again"));
}

}  // namespace
}  // namespace retrolux
