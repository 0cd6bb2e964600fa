// The figures of the studies of stereo and motion, on shots whose errors are made up.
#include "analysis/stereo_study.h"

#include <gtest/gtest.h>

#include "analysis/motion_profile.h"
#include "core/rng.h"

namespace retrolux {
namespace {

constexpr double kDistance_mm = 1600.0;

std::array<CameraModel, 2> Cameras(double psi_deg) {
  const std::array<CameraSpec, 2> pair = StereoPair(psi_deg, kDistance_mm);
  return {pair[0].model, pair[1].model};
}

double Normal(KeyedRng& rng) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - rng.NextDouble()));
  return radius * std::cos(2.0 * kPi * rng.NextDouble());
}

// Markers near the origin, each found `exposures` times with `sigma_px` of noise in u and v and
// `shift_px` in u, to the left in the left camera and to the right in the right one.
StereoShot MadeUp(double psi_deg, size_t exposures, double sigma_px, double shift_px,
                  uint64_t seed) {
  KeyedRng rng(seed);
  StereoShot shot;
  const auto cameras = Cameras(psi_deg);
  const Vec3d places[] = {{0, 30, 40},   {0, -30, 40}, {0, 30, -40},
                          {0, -30, -40}, {8, 0, 0},    {4, 20, 0}};
  for (int i = 0; i < 6; ++i) {
    MarkerInPair marker;
    marker.known = {fmt::format("marker-{}", i + 1), i + 1, places[i]};
    marker.at = places[i];
    for (size_t view = 0; view < 2; ++view) {
      MarkerInView& in_view = marker.views[view];
      in_view.projected_px = *cameras[view].Project(marker.at);
      in_view.outline_px = in_view.projected_px;
      in_view.radiometric_px =
          Vec2d(in_view.projected_px + Vec2d(view == 0 ? -shift_px : shift_px, 0.0));
      for (size_t k = 0; k < exposures; ++k) {
        const Vec2d noise(sigma_px * Normal(rng), sigma_px * Normal(rng));
        in_view.found.emplace_back(
            FoundMarker{*in_view.radiometric_px + noise, in_view.projected_px + noise});
      }
    }
    shot.markers.push_back(std::move(marker));
  }
  return shot;
}

// 6 markers x 200 exposures: the relative standard error of a standard deviation is 2 %; four of
// them (significance 6e-5 each, eight comparisons) and 1 % for markers that are not on the axis.
TEST(StereoStatistics, NoiseIsThatOfTwoRays) {
  for (const double psi_deg : {30.0, 100.0}) {
    const auto cameras = Cameras(psi_deg);
    const std::vector<StereoShot> shots = {MadeUp(psi_deg, 200, 0.1, 0.0, 3)};
    const SpatialError error = SpatialErrorOf(cameras, shots, MarkerPoint::kCentre);
    EXPECT_EQ(error.expected, 1200);
    EXPECT_EQ(error.found, 1200);
    EXPECT_NEAR(error.noise_px, 0.1, 0.1 * 0.04);  // of 4,800 numbers
    const Vec3d model = RaySigma_mm(0.1 * kDistance_mm / cameras[0].fx, psi_deg);
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(error.noise[axis] / model[axis], 1.0, 0.09) << psi_deg << " axis " << axis;
    EXPECT_NEAR(error.rms / model.norm(), 1.0, 0.09);
    EXPECT_LT(error.rms_low, error.rms);
    EXPECT_GT(error.rms_high, error.rms);
  }
}

// A shift of s px outwards in both pictures is one of s d / f mm across each ray, which moves the
// point by that over sin(psi / 2) away from the cameras (law of sines; to first order, 2 % for
// markers off the axis).
TEST(StereoStatistics, BudgetTellsTheStepOfTheLight) {
  constexpr double kPsi_deg = 45.0, kShift_px = 0.5;
  const auto cameras = Cameras(kPsi_deg);
  const std::vector<StereoShot> shots = {MadeUp(kPsi_deg, 3, 0.0, kShift_px, 5)};
  const std::vector<BudgetLine> lines = ErrorBudget(cameras, shots, std::nullopt);
  ASSERT_EQ(lines.size(), 8u);
  const double across_mm = kShift_px * kDistance_mm / cameras[0].fx;
  const double depth_mm = across_mm / std::sin(0.5 * RadFromDeg(kPsi_deg));
  EXPECT_NEAR(lines[0].rms_px, 0.0, 1e-12);
  EXPECT_NEAR(lines[1].rms_px, kShift_px, 1e-12);
  EXPECT_NEAR(std::abs(lines[1].bias_mm.x()), depth_mm, 0.02 * depth_mm);
  EXPECT_NEAR(lines[2].rms_mm, 0.0, 1e-9);
  EXPECT_NEAR(lines[3].rms_mm, 0.0, 1e-9);
  EXPECT_NEAR(lines[4].rms_mm, lines[1].rms_mm, 1e-9);
  EXPECT_NEAR(lines[7].rms_mm, 0.0, 1e-9);
  EXPECT_TRUE(ErrorBudget(cameras, shots, 0).empty());  // there is no standard marker
}

TEST(StereoStatistics, PosesNeedAllSixMarkers) {
  const auto cameras = Cameras(45.0);
  std::vector<StereoShot> shots = {MadeUp(45.0, 4, 0.0, 0.0, 7)};
  shots[0].markers[2].views[1].found[3].reset();
  const PoseErrors poses = PoseErrorsOf(cameras, shots, MarkerPoint::kCentre);
  EXPECT_EQ(poses.exposures, 4);
  EXPECT_EQ(poses.poses, 3);
  EXPECT_NEAR(poses.translation_rms_mm, 0.0, 1e-9);
  EXPECT_EQ(SpatialErrorOf(cameras, shots, MarkerPoint::kCentre).found, 23);
}

TEST(StereoShot, RoundTrip) {
  StereoShot shot = MadeUp(45.0, 2, 0.1, 0.2, 9);
  shot.misnamed = 3;
  shot.markers[1].views[0].found[1].reset();
  shot.markers[2].views[1].outline_px.reset();
  const nlohmann::json json = shot.ToJson();
  EXPECT_EQ(StereoShot::FromJson(json).ToJson(), json);
}

TEST(MotionProfile, IsWhatItSays) {
  const MotionProfile profile;
  EXPECT_EQ(profile.Displacement_mm(0.0), Vec3d::Zero());
  // Half a period: breathed in; the drift goes on.
  EXPECT_LT((profile.Displacement_mm(2.0) - profile.breath_mm - 2.0 * profile.drift_mm_s).norm(),
            1e-12);
  const RigidTransform cough = profile.At(3.25);
  EXPECT_NEAR(DegFromRad(Eigen::AngleAxisd(cough.rotation).angle()), profile.cough_nod_deg, 1e-9);
  EXPECT_EQ(profile.At(3.6).rotation, Mat3d::Identity());
}

// A drift of 0.5 mm/s alone passes 1 mm after 2 s.
TEST(MotionProfile, FirstCrossing) {
  MotionProfile profile;
  profile.breath_mm.setZero();
  profile.cough_mm.setZero();
  profile.drift_mm_s = Vec3d(0.0, 0.3, -0.4);
  EXPECT_NEAR(profile.FirstCrossing_s(1.0, 10.0), 2.0, 2e-4);
  EXPECT_LT(profile.FirstCrossing_s(1.0, 1.9), 0.0);
}

}  // namespace
}  // namespace retrolux
