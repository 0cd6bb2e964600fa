// Lenses: distortion, thin lens, stops, diffraction, stray light.
#include "renderer/lens.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <opencv2/calib3d.hpp>

#include "core/rng.h"
#include "renderer/lens_scatter.h"
#include "renderer/pixel_spread.h"
#include "renderer/sensor_fields.h"
#include "scenes/built_in.h"

namespace retrolux {
namespace {

// Of the order of machine-vision lenses, barrel and pincushion, with and without tangential terms,
// over the field of the thesis's camera (radius 0.133).
std::vector<Distortion> Lenses() {
  return {{-0.3, 0.0, 0.0, 0.0, 0.0},
          {0.25, -0.1, 0.0, 0.0, 0.05},
          {-0.4, 0.3, 1e-3, -2e-3, -0.2},
          {0.0, 0.0, -5e-3, 4e-3, 0.0}};
}

template <typename Visit>
void OverTheField(Visit visit) {
  for (double x = -0.3; x <= 0.3; x += 0.05) {
    for (double y = -0.3; y <= 0.3; y += 0.05) visit(Vec2d(x, y));
  }
}

TEST(Distortion, IsOpenCvs) {
  for (const Distortion& lens : Lenses()) {
    const std::array<double, 5> d = lens.Coefficients();
    OverTheField([&](const Vec2d& ideal) {
      const std::vector<cv::Point3d> points = {{ideal.x(), ideal.y(), 1.0}};
      std::vector<cv::Point2d> pixels;
      cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), cv::Matx33d::eye(),
                        std::vector<double>(d.begin(), d.end()), pixels);
      const Vec2d ours = lens.Apply(ideal);
      EXPECT_NEAR(ours.x(), pixels[0].x, 1e-14);
      EXPECT_NEAR(ours.y(), pixels[0].y, 1e-14);
    });
  }
}

TEST(Distortion, RemoveIsTheInverse) {
  for (const Distortion& lens : Lenses()) {
    OverTheField([&](const Vec2d& ideal) {
      const std::optional<Vec2d> back = lens.Remove(lens.Apply(ideal));
      ASSERT_TRUE(back);
      EXPECT_LT((*back - ideal).norm(), 1e-13);
    });
  }
}

TEST(Distortion, JacobianIsTheSlope) {
  constexpr double kStep = 1e-6;  // the second-order term of a central difference is below 1e-10
  for (const Distortion& lens : Lenses()) {
    OverTheField([&](const Vec2d& ideal) {
      const Eigen::Matrix2d jacobian = lens.Jacobian(ideal);
      for (int axis = 0; axis < 2; ++axis) {
        const Vec2d step = kStep * Vec2d::Unit(axis);
        const Vec2d slope = (lens.Apply(ideal + step) - lens.Apply(ideal - step)) / (2.0 * kStep);
        EXPECT_LT((jacobian.col(axis) - slope).norm(), 1e-9);
      }
    });
  }
}

// d(r + k1 r^3)/dr = 0 at r = sqrt(-1 / (3 k1)), where the picture ends at 2/3 of that radius.
TEST(Distortion, EndsWhereItTurnsBack) {
  const Distortion barrel(-0.3, 0.0, 0.0, 0.0, 0.0);
  const double turn = std::sqrt(1.0 / 0.9);
  EXPECT_NEAR(barrel.LargestRadius(), turn, 1e-12);
  EXPECT_TRUE(barrel.Remove({0.66 * turn, 0.0}));
  EXPECT_FALSE(barrel.Remove({0.67 * turn, 0.0}));
  EXPECT_EQ(Distortion(0.1, 0.1, 0.0, 0.0, 0.1).LargestRadius(),
            std::numeric_limits<double>::infinity());
  CameraModel camera = OvalScene().cameras[0].model;
  camera.distortion = barrel;
  const RigidTransform world_from_camera = camera.camera_from_world.Inverse();
  EXPECT_TRUE(camera.Project(world_from_camera * Vec3d(0.99 * turn, 0.0, 1.0)));
  EXPECT_FALSE(camera.Project(world_from_camera * Vec3d(1.01 * turn, 0.0, 1.0)));
}

TEST(Distortion, ProjectAndRayThroughAgree) {
  for (const Distortion& lens : Lenses()) {
    CameraModel camera = OvalScene().cameras[0].model;
    camera.distortion = lens;
    for (const Vec2d& px : {Vec2d(-0.5, -0.5), Vec2d(319.5, 239.5), Vec2d(600.25, 17.75)}) {
      const Ray ray = camera.RayThrough(px);
      const auto back = camera.Project(ray.origin + 1700.0 * ray.direction);
      ASSERT_TRUE(back);
      EXPECT_LT((*back - px).norm(), 1e-9);
    }
  }
}

CameraSpec ThinLensCamera() {
  CameraSpec camera = OvalScene().cameras[0];
  camera.lens.focal_length_mm = 29.448;
  camera.lens.f_number = 2.0;
  camera.lens.focus_distance_mm = 1600.0;
  return camera;
}

std::vector<Vec2f> UnitSquare(int n, uint64_t key) {
  std::vector<Vec2f> points;
  KeyedRng rng(key);
  for (int i = 0; i < n; ++i) points.emplace_back(rng.NextFloat(), rng.NextFloat());
  return points;
}

TEST(LensRays, PinholeFallsOffWithCos4) {
  const CameraSpec camera = OvalScene().cameras[0];
  const LensRays lens(camera);
  for (const Vec2d& px : {Vec2d(319.5, 239.5), Vec2d(0.0, 0.0), Vec2d(639.0, 100.0)}) {
    const auto ray = lens.Through(px, Vec2f::Zero());
    ASSERT_TRUE(ray);
    const Ray chief = camera.model.RayThrough(px);
    EXPECT_LT((ray->direction.cast<double>() - chief.direction).norm(), 1e-6);
    const double cosine = chief.direction.dot(camera.model.Forward());
    EXPECT_NEAR(ray->falloff, std::pow(cosine, 4), 1e-6);
    EXPECT_NEAR(ray->cos_field, cosine, 1e-6);
  }
}

// Focused at 1600 mm with f = 29.448 mm the sensor stands 30.000 mm behind the lens: the thesis's
// field of view. A point of the focal plane is sharp whatever way the light takes.
TEST(LensRays, RaysOfAPixelMeetInTheFocalPlane) {
  const CameraSpec camera = ThinLensCamera();
  EXPECT_NEAR(camera.lens.PrincipalDistance_mm(), 30.0, 1e-3);
  const LensRays lens(camera);
  const Vec2d px(523.0, 77.5);
  const Ray chief = camera.model.RayThrough(px);
  const Vec3d forward = camera.model.Forward();
  const Vec3d focus = chief.origin + chief.direction * (1600.0 / chief.direction.dot(forward));
  for (const Vec2f& u : UnitSquare(100, 1)) {
    const auto ray = lens.Through(px, u);
    ASSERT_TRUE(ray);
    const Vec3d origin = ray->origin.cast<double>(), direction = ray->direction.cast<double>();
    EXPECT_LE((origin - chief.origin).norm(), camera.lens.ApertureRadius_mm() + 1e-3);
    const double along = 1600.0 / direction.dot(forward);
    EXPECT_LT((origin + along * direction - focus).norm(), 2e-3);  // single precision at 1600 mm
  }
}

// Rays of a pixel cross the plane at depth d in a disc of radius a |d - s| / s, which the lens's
// centre sees as that many pixels: the same disc as the thin-lens formula's blur on the sensor,
// diameter (f^2 / N) |d - s| / (d (s - f)). Its radius in x is the largest of many.
TEST(LensRays, BlurIsTheThinLensFormulas) {
  const CameraSpec camera = ThinLensCamera();
  const LensRays lens(camera);
  const double pitch_mm = 30.0 / camera.model.fx;
  for (const double depth_mm : {1500.0, 1700.0, 1950.0}) {
    const double f = 29.448;
    const double blur_mm = f * f / 2.0 * std::abs(depth_mm - 1600.0) / (depth_mm * (1600.0 - f));
    EXPECT_NEAR(lens.BlurRadius_px(depth_mm), 0.5 * blur_mm / pitch_mm, 1e-4 * blur_mm / pitch_mm);
    double widest_px = 0.0;
    const Vec2d px = Vec2d(camera.model.cx, camera.model.cy);
    for (const Vec2f& u : UnitSquare(20000, 2)) {
      const auto ray = lens.Through(px, u);
      const double along = depth_mm / static_cast<double>(ray->cos_field);
      const Vec3d point = ray->origin.cast<double>() + along * ray->direction.cast<double>();
      widest_px = std::max(widest_px, (*camera.model.Project(point) - px).norm());
    }
    EXPECT_NEAR(widest_px, lens.BlurRadius_px(depth_mm), 0.01 * widest_px + 2e-3);
  }
}

// On the axis E = pi L a^2 / (a^2 + s'^2): a disc of radiance L and radius a at the distance s'.
// Over pi L a^2 / s'^2, which is what the fall-off multiplies: s'^2 / (a^2 + s'^2).
TEST(LensRays, IrradianceOnTheAxisIsThatOfADisc) {
  CameraSpec camera = ThinLensCamera();
  camera.lens.f_number = 1.0;  // 5.7 % less than the paraxial value
  const LensRays lens(camera);
  constexpr int kSide = 512;
  double sum = 0.0;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const Vec2f u((static_cast<float>(i) + 0.5f) / kSide, (static_cast<float>(j) + 0.5f) / kSide);
      sum += static_cast<double>(lens.Through({camera.model.cx, camera.model.cy}, u)->falloff);
    }
  }
  const double a = 29.448 / 2.0, s = camera.lens.PrincipalDistance_mm();
  EXPECT_NEAR(sum / (kSide * kSide), s * s / (a * a + s * s), 1e-5);
}

// Two equal discs a radius apart share (2/3 - sqrt(3) / (2 pi)) of their area.
TEST(LensRays, OverlapOfDiscs) {
  EXPECT_NEAR(DiscOverlap(2.0, 2.0, 2.0), 2.0 / 3.0 - std::sqrt(3.0) / (2.0 * kPi), 1e-12);
  EXPECT_EQ(DiscOverlap(1.0, 3.0, 2.0), 1.0);
  EXPECT_EQ(DiscOverlap(1.0, 3.0, 4.0), 0.0);
  EXPECT_NEAR(DiscOverlap(1.0, 1e6, 1e6), 0.5, 1e-6);  // a straight edge through the middle
}

// The pinhole's share of the aperture that a stop leaves open is the share of the rays that pass a
// thin lens focused far away; 5 standard deviations of a binomial count.
TEST(LensRays, StopCutsObliqueLight) {
  CameraSpec camera = OvalScene().cameras[0];
  camera.lens.f_number = 2.8;
  camera.lens.stop_radius_mm = 6.0;
  camera.lens.stop_distance_mm = 25.0;
  CameraSpec thin = camera;
  thin.lens.focus_distance_mm = 1e8;
  const LensRays pinhole(camera), with_aperture(thin);
  CameraSpec open_camera = camera;
  open_camera.lens.stop_radius_mm = 0.0;
  const LensRays open(open_camera);
  constexpr int kRays = 20000;
  for (const double column : {319.5, 500.0, 639.0}) {
    const Vec2d px(column, 239.5);
    const double share = static_cast<double>(pinhole.Through(px, Vec2f::Zero())->falloff) /
                         static_cast<double>(open.Through(px, Vec2f::Zero())->falloff);
    int passed = 0;
    for (const Vec2f& u : UnitSquare(kRays, 3)) passed += with_aperture.Through(px, u).has_value();
    const double sigma = std::sqrt(share * (1.0 - share) / kRays);
    EXPECT_NEAR(static_cast<double>(passed) / kRays, share, 5.0 * sigma + 1e-12);
    EXPECT_EQ(share<1.0, column> 400.0);
  }
}

// A wall of radiance 1 sends through the lens, from within a cone of tan = R, the flux
// int_0^R 2 pi r / (1 + r^2)^2 dr = pi R^2 / (1 + R^2), wherever a distortion puts it. Midpoint
// rule on quarter pixels; what it errs lies on the cone's edge: of 2 pi R / h cells there each is
// off by 0.3 of its area or so at random, 2e-5 of the sum.
TEST(LensRays, DistortionLosesNoLight) {
  constexpr double kRadius = 0.07, kCell_px = 0.25;
  for (const Distortion& distortion : Lenses()) {
    CameraSpec camera = OvalScene().cameras[0];
    camera.model.distortion = distortion;
    const LensRays lens(camera);
    double flux = 0.0;
    for (double v = -0.5; v < 479.5; v += kCell_px) {
      for (double u = -0.5; u < 639.5; u += kCell_px) {
        const Vec2d px(u + 0.5 * kCell_px, v + 0.5 * kCell_px);
        if (camera.model.PlanePoint(px)->norm() < kRadius)
          flux += static_cast<double>(lens.Through(px, Vec2f::Zero())->falloff);
      }
    }
    flux *= kCell_px * kCell_px / (camera.model.fx * camera.model.fy);
    const double expected = kPi * kRadius * kRadius / (1.0 + kRadius * kRadius);
    EXPECT_NEAR(flux / expected, 1.0, 1e-4);
  }
}

// Born and Wolf, table 8.2: 83.8, 91.0 and 93.8 % within the first three dark rings.
TEST(Airy, EncircledEnergy) {
  EXPECT_NEAR(AiryEncircledEnergy(3.8317), 0.838, 5e-4);
  EXPECT_NEAR(AiryEncircledEnergy(7.0156), 0.910, 5e-4);
  EXPECT_NEAR(AiryEncircledEnergy(10.1735), 0.938, 5e-4);
}

CameraSpec DiffractingCamera() {
  CameraSpec camera = OvalScene().cameras[0];
  camera.lens.f_number = 8.0;
  camera.lens.diffraction = true;
  return camera;
}

// Radius of the first dark ring: 1.22 lambda N. Within it 0.8378 of the energy, over what the core
// holds; 5 standard deviations.
TEST(Airy, SamplesOfTheCore) {
  const CameraSpec camera = DiffractingCamera();
  const AiryDisc airy(camera, 880.0);
  const double ring_px = 1.21967 * 880e-6 * 8.0 / (30.0 / camera.model.fx);
  constexpr int kSamples = 100000;
  int inside = 0;
  Vec2d mean = Vec2d::Zero();
  for (const Vec2f& u : UnitSquare(kSamples, 4)) {
    const Vec2d px = airy.SampleCore(u);
    inside += px.norm() < ring_px;
    mean += px / kSamples;
    EXPECT_LE(px.norm(), airy.CoreRadius_px() * 1.0001);
  }
  const double share = AiryEncircledEnergy(3.83171) / (1.0 - AiryDisc::TailShare());
  EXPECT_NEAR(static_cast<double>(inside) / kSamples, share,
              5.0 * std::sqrt(share * (1.0 - share) / kSamples));
  EXPECT_LT(mean.norm(), 5.0 * airy.CoreRadius_px() / std::sqrt(kSamples));
}

// The kernel's energy within a square of half side h lies between what circles of radius h and
// sqrt(2) h hold, all in units of the tail (and of what lies within v = 200).
TEST(Airy, TailFallsOffAsItShould) {
  const CameraSpec camera = DiffractingCamera();
  const FloatPlane kernel = AiryDisc(camera, 880.0).TailKernel();
  const double v_per_px = kPi / (880e-6 * 8.0) * 30.0 / camera.model.fx;
  EXPECT_NEAR(std::accumulate(kernel.data.begin(), kernel.data.end(), 0.0), 1.0, 1e-5);
  const int middle_x = kernel.width / 2, middle_y = kernel.height / 2;
  const double core = 1.0 - AiryDisc::TailShare();
  const double all = AiryEncircledEnergy(200.0) - core;
  for (const int half : {6, 12, 24}) {
    double inside = 0.0;
    for (int y = -half; y <= half; ++y) {
      for (int x = -half; x <= half; ++x)
        inside += static_cast<double>(kernel(middle_x + x, middle_y + y));
    }
    const double side = half + 0.5;
    EXPECT_GT(inside, (AiryEncircledEnergy(v_per_px * side) - core) / all);
    EXPECT_LT(inside, (AiryEncircledEnergy(v_per_px * std::sqrt(2.0) * side) - core) / all);
  }
}

// Variances along an axis: of the square 1/12, of the Gaussian sigma^2 less what the cut at 4 sigma
// takes: 1 - q / (1 - q) 4^2 / 2 with q = exp(-8) = 3.4e-4 of the whole outside. 5 standard errors
// of a variance (kurtosis 3 at most): sigma^2 sqrt(2 / n).
TEST(PixelSpread, SquareAndDiffusionAddTheirVariances) {
  CameraSpec camera = OvalScene().cameras[0];
  camera.sensor.charge_diffusion_um = 8.0;
  const PixelSpread spread(camera, 880.0);
  const double sigma_px = 8e-3 / 30.0 * camera.model.fx;
  EXPECT_NEAR(spread.Radius_px(), 4.0 * sigma_px, 1e-3);
  constexpr int kSamples = 1 << 16;
  Vec2d sum = Vec2d::Zero(), sum2 = Vec2d::Zero();
  for (uint32_t i = 0; i < kSamples; ++i) {
    PixelSampler sampler(Mix64(3), i);
    const Vec2d px = spread.Sample(sampler);
    sum += px;
    sum2 += px.cwiseProduct(px);
  }
  const double q = std::exp(-8.0);
  const double expected = 1.0 / 12.0 + sigma_px * sigma_px * (1.0 - 8.0 * q / (1.0 - q));
  for (int axis = 0; axis < 2; ++axis) {
    EXPECT_NEAR(sum[axis] / kSamples, 0.0, 5.0 * std::sqrt(expected / kSamples));
    EXPECT_NEAR(sum2[axis] / kSamples, expected, 5.0 * expected * std::sqrt(2.0 / kSamples));
  }
  camera.sensor.charge_diffusion_um = 0.0;
  EXPECT_EQ(PixelSpread(camera, 880.0).Radius_px(), 0.0);
}

// A signal that grows by one electron a row, as photosites record it whose line j lies half a row
// above row j: the sum of two lines is twice the signal of the row between them.
TEST(PixelSpread, RowsOfAnInterlacedPictureLieWhereTheySay) {
  CameraSpec camera = OvalScene().cameras[0];
  camera.sensor.scan = Scan::kInterlaced;
  const PixelSpread spread(camera, 880.0);
  constexpr int kSamples = 4096, kRows = 8;
  double offset = 0.0;
  for (uint32_t i = 0; i < kSamples; ++i) {
    PixelSampler sampler(Mix64(5), i);
    offset += spread.Sample(sampler).y() / kSamples;
  }
  Plane<double> lines(1, kRows);
  for (int y = 0; y < kRows; ++y) lines(0, y) = 100.0 + y + offset;
  const Plane<double> picture = WeaveFields(lines, lines);
  for (int y = 0; y + 1 < kRows; ++y) EXPECT_NEAR(picture(0, y), 2.0 * (100.0 + y), 1e-3);
}

TEST(LensScatter, ConservesWhatItSpreads) {
  CameraSpec camera = DiffractingCamera();
  camera.lens.veiling_glare = 0.02;
  const LensScatter scatter(camera, 880.0);
  FloatPlane even(200, 160, 3.0f);
  scatter.Apply(even);
  for (const float value : even.data) EXPECT_NEAR(value, 3.0f, 1e-5f);
  FloatPlane spot(200, 160);
  spot(100, 80) = 1e4f;
  scatter.Apply(spot);
  EXPECT_NEAR(std::accumulate(spot.data.begin(), spot.data.end(), 0.0), 1e4, 1.0);
  EXPECT_NEAR(spot(100, 80), 0.98 * 1e4 * (1.0 - AiryDisc::TailShare()), 1.0);
  EXPECT_NEAR(spot(2, 2), 0.02 * 1e4 / (200.0 * 160.0), 1e-4);  // the veil alone
  // A veil and nothing else (ISO 9358): a black field in a white one shows g times the mean.
  camera.lens.diffraction = false;
  FloatPlane field(100, 100, 1.0f);
  for (int y = 40; y < 60; ++y) {
    for (int x = 40; x < 60; ++x) field(x, y) = 0.0f;
  }
  LensScatter(camera, 880.0).Apply(field);
  EXPECT_NEAR(field(50, 50), 0.02 * 0.96, 1e-6);
}

}  // namespace
}  // namespace retrolux
