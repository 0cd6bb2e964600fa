// Where pictures take more samples.
#include "renderer/edge_pixels.h"

#include <gtest/gtest.h>

#include "renderer/film.h"
#include "scenes/built_in.h"

namespace retrolux {
namespace {

// Marker and object at a place in the picture, of a scene without distortion.
std::pair<uint32_t, uint32_t> WhatIsAt(const RayScene& rays, const CameraModel& camera,
                                       const std::vector<PlacedMarker>& markers, const Vec2d& px) {
  const Ray ray = camera.RayThrough(px);
  const auto hit = rays.Intersect(ray.origin.cast<float>(), ray.direction.cast<float>());
  if (!hit) return {0, 0};
  for (const PlacedMarker& marker : markers) {
    const auto place =
        marker.Locate(hit->position.cast<double>(), hit->geometric_normal.cast<double>());
    if (place && marker.IsBright(*place)) return {hit->body + 1, marker.instance};
  }
  return {hit->body + 1, 0};
}

TEST(EdgePixels, AreThoseThatShowTwoThings) {
  // Of the pixels in which 4 x 4 rays do not all meet the same, 98 % are edges; the rest shows less
  // than a half-pixel tip of something that no pixel centre around meets. No more than a sixteenth
  // of the picture is edges.
  const Scene scene = OvalScene();
  const RayScene rays(scene);
  const std::vector<PlacedMarker> markers = PlaceMarkers(scene);
  const CameraModel camera = scene.cameras[0].model.Resized(320, 240);
  const Plane<uint8_t> edges = EdgePixels(RenderIds(rays, camera, markers), camera);
  int mixed = 0, found = 0, all = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      all += edges(x, y);
      const auto first = WhatIsAt(rays, camera, markers, Vec2d(x - 0.375, y - 0.375));
      bool differs = false;
      for (int i = 1; i < 16; ++i) {
        const Vec2d px(x - 0.375 + 0.25 * (i % 4), y - 0.375 + 0.25 * (i / 4));
        differs |= WhatIsAt(rays, camera, markers, px) != first;
      }
      mixed += differs ? 1 : 0;
      found += differs && edges(x, y) != 0 ? 1 : 0;
    }
  }
  EXPECT_GT(mixed, 500);
  EXPECT_GT(found, 0.98 * mixed);
  EXPECT_LT(all, camera.width * camera.height / 16);
}

TEST(EdgePixels, SeeOnePartOfASurfaceInFrontOfAnother) {
  // The nose of the face, seen from the side, before the cheek: one object, no marker.
  Scene scene = FaceScene();
  scene.markers.clear();
  const RayScene rays(scene);
  const CameraModel& camera = scene.Camera("side").model;
  const IdBuffers ids = RenderIds(rays, camera, {});
  const Plane<uint8_t> edges = EdgePixels(ids, camera);
  int steps = 0, found = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x + 1 < camera.width; ++x) {
      const size_t i = edges.Index(x, y);
      if (ids.object.data[i] == 0 || ids.object.data[i + 1] == 0) continue;
      if (std::abs(ids.depth.data[i] - ids.depth.data[i + 1]) < 30.0f) continue;
      ++steps;
      found += edges.data[i];
    }
  }
  EXPECT_GT(steps, 10);
  EXPECT_EQ(found, steps);
}

TEST(RenderFilm, SamplesOfAPixelAreThoseOfItsNumber) {
  // More samples in one pixel change no other, and it is what it would be with that many
  // everywhere.
  const Scene scene = OvalScene();
  CameraSpec camera = scene.cameras[0];
  camera.model = camera.model.Resized(32, 24);
  const RayScene rays(scene);
  const std::vector<PlacedMarker> markers = PlaceMarkers(scene);
  const Lights lights(scene, rays, RingChoice::kAll, camera.model.name);
  const CameraResponse response(camera, lights.Spectra(), 1e-3);
  const auto film = [&](int everywhere, const Plane<int>* samples) {
    TraceOptions options;
    options.samples_per_pixel = everywhere;
    const PathTracer tracer(scene, rays, lights, response, markers, options);
    return samples ? RenderFilm(tracer, camera.model, *samples, lights.GroupNames(), NoProgress())
                   : RenderFilm(tracer, camera.model, lights.GroupNames(), NoProgress());
  };
  Plane<int> samples(32, 24, 4);
  samples(16, 12) = 16;
  const Film mixed = film(4, &samples), few = film(4, nullptr), many = film(16, nullptr);
  for (size_t i = 0; i < mixed.electrons.data.size(); ++i) {
    const Film& expected = i == samples.Index(16, 12) ? many : few;
    ASSERT_EQ(mixed.electrons.data[i], expected.electrons.data[i]) << i;
    ASSERT_EQ(mixed.variance.data[i], expected.variance.data[i]) << i;
  }
  EXPECT_NE(many.electrons(16, 12), few.electrons(16, 12));
}

}  // namespace
}  // namespace retrolux
