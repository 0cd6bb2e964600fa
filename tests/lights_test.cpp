// How well light is sampled: where on the diodes points fall, and how much a pixel scatters at 16
// samples.
#include <gtest/gtest.h>

#include <cmath>

#include "core/sampling.h"
#include "renderer/exposure.h"
#include "renderer/path_tracer.h"
#include "scenes/built_in.h"
#include "tests/statistics.h"

namespace retrolux {
namespace {

TEST(PowerHeuristic, SharesAddUpToOne) {
  for (const float p : {1e-6f, 0.3f, 20.0f, 1e9f, 1e22f}) {
    for (const float q : {1e-6f, 0.3f, 20.0f, 1e9f, 1e22f})
      EXPECT_NEAR(static_cast<double>(PowerHeuristic(p, q) + PowerHeuristic(q, p)), 1.0, 1e-6);
    EXPECT_EQ(PowerHeuristic(p, 0.0f), 1.0f);
    EXPECT_EQ(PowerHeuristic(0.0f, p), 0.0f);
  }
  EXPECT_FLOAT_EQ(PowerHeuristic(3.0f, 1.0f), 0.9f);  // 9 / (9 + 1)
}

TEST(Lights, PointsOnEachDiodeAreEven) {
  // Uniform on the 12-gon of a diode, for any diode that `pick` chooses: the centroid is its
  // centre, the mean square distance R^2 (2 + cos 30 degrees) / 6 with the polygon's R. And evenly
  // over its triangles: 12 cells, significance 1 % for all diodes.
  const Scene scene = OvalScene();
  const RayScene rays(scene);
  const Lights lights(scene, rays, RingChoice::kAll, "camera");
  const CameraSpec& camera = scene.cameras[0];
  constexpr int kPoints = 1 << 14;
  for (const int led : {0, 5, 23}) {
    const Vec3d centre = LedCentre(camera, led);
    const double r2 = (LedOutline(camera, led)[0] - centre).squaredNorm();
    Vec3d sum = Vec3d::Zero();
    double sum2 = 0.0;
    std::vector<double> counts(kLedCorners, 0.0);
    KeyedRng rng(41);
    for (int i = 0; i < kPoints; ++i) {
      const Vec2f u(rng.NextFloat(), rng.NextFloat());
      const auto sample =
          lights.Sample(0, Vec3f(100.0f, 0.0f, 0.0f), (static_cast<float>(led) + 0.5f) / 24.0f, u);
      ASSERT_TRUE(sample.has_value());
      const Vec3d offset = sample->position.cast<double>() - centre;
      sum += offset;
      sum2 += offset.squaredNorm();
      const Vec3d in_camera = camera.model.camera_from_world.rotation * offset;
      const double angle = std::atan2(in_camera.y(), in_camera.x()) / (2.0 * kPi);
      counts[static_cast<size_t>((angle - std::floor(angle)) * kLedCorners)] += 1.0;
    }
    EXPECT_NEAR((sum / kPoints).norm(), 0.0, 4.0 * std::sqrt(r2 / 4.0 / kPoints));
    EXPECT_NEAR(sum2 / kPoints / r2, (2.0 + std::cos(kPi / 6.0)) / 6.0, 0.01);
    EXPECT_GT(statistics::ChiSquarePValue(
                  counts, std::vector<double>(kLedCorners, 1.0 * kPoints / kLedCorners)),
              statistics::Sidak(0.01, 3));
  }
}

// Standard deviation over seeds of a pixel at 16 samples, over its mean; root mean square of 16
// pixels around where the camera of the oval sees `at`. The whole square of the marker is bright.
double RelativeDeviation(const Vec3d& at, bool marker) {
  const Scene scene = OvalScene();
  const CameraSpec& camera = scene.cameras[0];
  const RayScene rays(scene);
  const Lights lights(scene, rays, RingChoice::kOwn, camera.model.name);
  const CameraResponse response(camera, lights.Spectra(), ExposureSeconds(scene, camera));
  std::vector<PlacedMarker> markers;
  if (marker) {
    markers.push_back(PlaceMarker(scene, {"marker", 1, "mask", at}, 1));
    markers[0].dark = true;
    markers[0].shape = std::make_shared<const MarkerShape>();
  }
  const Vec2d px = *camera.model.Project(at);
  constexpr int kSeeds = 32, kPixels = 16;
  double relative2 = 0.0;
  for (int i = 0; i < kPixels; ++i) {
    double sum = 0.0, sum2 = 0.0;
    for (int seed = 0; seed < kSeeds; ++seed) {
      TraceOptions options;
      options.samples_per_pixel = 16;
      options.seed = static_cast<uint64_t>(seed);
      const PathTracer tracer(scene, rays, lights, response, markers, options);
      const PixelEstimate estimate =
          tracer.EstimatePixel(static_cast<int>(px.x()) + i % 4, static_cast<int>(px.y()) + i / 4);
      EXPECT_EQ(estimate.coverage.weight[0], marker ? 1.0f : 0.0f);
      const auto signal = static_cast<double>(estimate.electrons.sum());
      sum += signal;
      sum2 += signal * signal;
    }
    const double mean = sum / kSeeds;
    relative2 += (sum2 / kSeeds - mean * mean) * kSeeds / (kSeeds - 1.0) / (mean * mean);
  }
  return std::sqrt(relative2 / kPixels);
}

TEST(Lights, ARingIsNearlyNoiselessAtSixteenSamples) {
  // Shot noise of the 20,000 e- of a frontal marker is 0.7 %: the scatter of light sampling must
  // not add to it on the axis, hardly off it, and on the mask, which reflects evenly, be nothing.
  // The deviation of 512 numbers is known to 3 %; measured are 0.50, 0.76 and 0.05 %.
  EXPECT_LT(RelativeDeviation({100, 0, 0}, true), 0.007);
  EXPECT_LT(RelativeDeviation({91.65, 40, 0}, true), 0.009);
  EXPECT_LT(RelativeDeviation({91.65, 40, 0}, false), 0.001);
}

}  // namespace
}  // namespace retrolux
