// A composed picture must be the full render of the same scene, but for the light that the marker
// throws elsewhere.
#include "analysis/composed_picture.h"

#include <gtest/gtest.h>

#include "analysis/marker_grid.h"
#include "renderer/exposure.h"
#include "scenes/built_in.h"
#include "tests/statistics.h"

namespace retrolux {
namespace {

// A small picture of the room: the same cameras with 160 x 120 pixels.
struct Room {
  Scene scene;
  RayScene rays;
  PlacedMarker marker;
  MarkerSurface surface;

  Room()
      : scene(SmallRoom()),
        rays(scene),
        marker(PlaceMarker(scene, {"marker", 2, "mask", marker_grid::Point({16, 2})}, 1)),
        surface(SampleMarkerSurface(rays, marker)) {}

  static Scene SmallRoom() {
    Scene scene = CtRoom();
    for (CameraSpec& camera : scene.cameras) camera.model = camera.model.Resized(160, 120);
    return scene;
  }

  Film Full(const CameraSpec& camera, const TraceOptions& options) const {
    const Lights lights(scene, rays, RingChoice::kAll, camera.model.name);
    const CameraResponse response(camera, lights.Spectra(), ExposureSeconds(scene, camera));
    const std::vector<PlacedMarker> markers = {marker};
    const PathTracer tracer(scene, rays, lights, response, markers, options);
    return RenderFilm(tracer, camera.model, lights.GroupNames(), NoProgress());
  }
};

TraceOptions Options(uint64_t seed) {
  TraceOptions options;
  options.samples_per_pixel = 64;
  options.own_ray_share = kStrongGroups;
  options.seed = seed;
  return options;
}

// 0 on the pixels that are traced for the marker, 1 up to 8 px around them, 2 elsewhere.
Plane<uint8_t> Regions(const Room& room, const CameraSpec& camera) {
  const std::vector<Eigen::Vector2i> pixels = PixelsThatCanShow(room.surface, camera.model);
  Plane<uint8_t> region(160, 120, 2);
  for (const Eigen::Vector2i& px : pixels) {
    for (int y = px.y() - 8; y <= px.y() + 8; ++y) {
      for (int x = px.x() - 8; x <= px.x() + 8; ++x) {
        if (region.Contains(x, y)) region(x, y) = 1;
      }
    }
  }
  for (const Eigen::Vector2i& px : pixels) region(px.x(), px.y()) = 0;
  return region;
}

TEST(ComposedPicture, SameSeedGivesTheSameBitsWhereTheMarkerIsTraced) {
  const Room room;
  const CameraSpec& camera = room.scene.cameras[0];
  const ComposedCamera composed(room.scene, room.rays, camera, RingChoice::kAll, Options(1),
                                NoProgress());
  const FloatPlane signal = composed.Signal(room.marker, room.surface);
  const Film full = room.Full(camera, Options(1));
  const std::vector<Eigen::Vector2i> pixels = PixelsThatCanShow(room.surface, camera.model);
  ASSERT_GT(pixels.size(), 20u);
  for (const Eigen::Vector2i& px : pixels)
    EXPECT_EQ(signal(px.x(), px.y()), full.electrons(px.x(), px.y()));
  // Nothing outside shows the marker: no pixel was forgotten.
  Plane<uint8_t> traced(160, 120, 0);
  for (const Eigen::Vector2i& px : pixels) traced(px.x(), px.y()) = 1;
  for (size_t i = 0; i < traced.data.size(); ++i) {
    if (traced.data[i] == 0) {
      EXPECT_EQ(full.marker_id[0].data[i], 0u);
    }
  }
}

TEST(ComposedPicture, WhatIsLeftOutDrownsInTheNoise) {
  // With the same seed the pictures differ only where a path meets the marker after its first
  // surface: the difference is the light that the composition leaves out (negative: the sheeting is
  // darker than the mask that it covers). In the mean over the pixels around the marker, and over
  // all others, it must be less than what the noise of one real picture, 16 times as many pixels
  // with variance = signal + read noise^2, leaves uncertain in that mean.
  const Room room;
  for (const size_t c : {size_t{0}, size_t{4}}) {
    const CameraSpec& camera = room.scene.cameras[c];
    const ComposedCamera composed(room.scene, room.rays, camera, RingChoice::kAll, Options(1),
                                  NoProgress());
    const FloatPlane signal = composed.Signal(room.marker, room.surface);
    const Film full = room.Full(camera, Options(1));
    const Plane<uint8_t> region = Regions(room, camera);
    double difference[3] = {}, light[3] = {}, pixels[3] = {};
    for (size_t i = 0; i < signal.data.size(); ++i) {
      difference[region.data[i]] +=
          static_cast<double>(full.electrons.data[i]) - static_cast<double>(signal.data[i]);
      light[region.data[i]] += static_cast<double>(full.electrons.data[i]);
      pixels[region.data[i]] += 1.0;
    }
    for (const int r : {1, 2}) {
      std::printf("%s, %s: left out %.4f e- of %.1f e- a pixel\n", camera.model.name.c_str(),
                  r == 1 ? "around" : "elsewhere", difference[r] / pixels[r], light[r] / pixels[r]);
    }
    EXPECT_EQ(difference[0], 0.0);
    for (const int r : {1, 2}) {
      const double variance =
          light[r] / pixels[r] + camera.sensor.read_noise_e * camera.sensor.read_noise_e;
      EXPECT_LT(std::abs(difference[r] / pixels[r]), std::sqrt(variance / (16.0 * pixels[r])));
    }
  }
}

TEST(ComposedPicture, IndependentSeedsAgreeWithinTheirMonteCarloError) {
  // Composed with seed 1, full with seed 2: z = difference / sqrt(sum of the variances), over the
  // marker's pixels, over those up to 8 px around it and over all others. The variances are upper
  // bounds (the samples are stratified), so that z is at most standard normal; three tests with a
  // significance of 1e-3 together.
  const Room room;
  const CameraSpec& camera = room.scene.cameras[0];
  const ComposedCamera composed(room.scene, room.rays, camera, RingChoice::kAll, Options(1),
                                NoProgress());
  const FloatPlane signal = composed.Signal(room.marker, room.surface);
  const Film background = room.Full(camera, Options(1));
  const Film full = room.Full(camera, Options(2));
  const Plane<uint8_t> region = Regions(room, camera);
  double difference[3] = {}, variance[3] = {};
  for (size_t i = 0; i < region.data.size(); ++i) {
    difference[region.data[i]] +=
        static_cast<double>(signal.data[i]) - static_cast<double>(full.electrons.data[i]);
    variance[region.data[i]] += static_cast<double>(background.variance.data[i]) +
                                static_cast<double>(full.variance.data[i]);
  }
  for (int r = 0; r < 3; ++r) {
    const double z = difference[r] / std::sqrt(variance[r]);
    std::printf("region %d: z = %.2f\n", r, z);
    EXPECT_GT(statistics::NormalPValue(z), statistics::Sidak(1e-3, 3)) << "region " << r;
  }
}

}  // namespace
}  // namespace retrolux
