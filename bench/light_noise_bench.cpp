// The noise of a pixel's mean signal at a given number of samples, and what it costs: the relative
// standard deviation over independent seeds, of a retro-reflective marker and of the mask, with
// what contributes taken away one by one. One thread.
//
//   build/release/bench/light_noise_bench [SPP]
#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>

#include "renderer/exposure.h"
#include "renderer/path_tracer.h"
#include "scenes/built_in.h"

namespace {

using namespace retrolux;

constexpr int kSeeds = 48;
constexpr int kSide = 5;  // of the block of pixels

struct Noise {
  double relative_deviation;  // of a pixel, root mean square over the block
  double microseconds;        // for a pixel
};

// The block of pixels around the picture of `at`.
Noise Measure(const Scene& scene, RingChoice choice, const Vec3d& at, bool marker,
              TraceOptions options) {
  const CameraSpec& camera = scene.cameras[0];
  const RayScene rays(scene);
  const Lights lights(scene, rays, choice, camera.model.name);
  const CameraResponse response(camera, lights.Spectra(), ExposureSeconds(scene, camera));
  std::vector<PlacedMarker> markers;
  if (marker) {
    markers.push_back(PlaceMarker(scene, {"marker", 1, "mask", at}, 1));
    markers[0].dark = true;  // all of its square is bright
    markers[0].shape = std::make_shared<const MarkerShape>();
  }
  const Vec2d px = *camera.model.Project(at);
  const int x0 = static_cast<int>(px.x()), y0 = static_cast<int>(px.y());
  std::vector<double> sum(kSide * kSide), sum2(kSide * kSide);
  const auto start = std::chrono::steady_clock::now();
  for (int seed = 0; seed < kSeeds; ++seed) {
    options.seed = static_cast<uint64_t>(seed);
    const PathTracer tracer(scene, rays, lights, response, markers, options);
    for (size_t i = 0; i < sum.size(); ++i) {
      const int x = x0 - kSide / 2 + static_cast<int>(i) % kSide,
                y = y0 - kSide / 2 + static_cast<int>(i) / kSide;
      const auto signal = static_cast<double>(tracer.EstimatePixel(x, y).electrons.sum());
      sum[i] += signal;
      sum2[i] += signal * signal;
    }
  }
  const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - start;
  double relative = 0.0;
  for (size_t i = 0; i < sum.size(); ++i) {
    const double mean = sum[i] / kSeeds;
    relative += (sum2[i] / kSeeds - mean * mean) * kSeeds / (kSeeds - 1.0) / (mean * mean);
  }
  return {std::sqrt(relative / static_cast<double>(sum.size())),
          time.count() / (kSeeds * static_cast<double>(sum.size()))};
}

using Change = std::function<void(Scene&, TraceOptions&)>;

void Nothing(Scene&, TraceOptions&) {}
void DirectOnly(Scene&, TraceOptions& options) {
  options.max_surfaces = 1;
}
// One wavelength, and no filter whose band would shift.
void OneWavelength(Scene& scene, TraceOptions& options) {
  DirectOnly(scene, options);
  for (CameraSpec& camera : scene.cameras) {
    camera.filter.reset();
    if (camera.ring) camera.ring->fwhm_nm = 0.1;
  }
  scene.ambient = {};
}
// And small LEDs: no scattered ray finds one.
void PointLeds(Scene& scene, TraceOptions& options) {
  OneWavelength(scene, options);
  for (CameraSpec& camera : scene.cameras) {
    if (camera.ring) camera.ring->led_radius_mm = 0.02;
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int spp = argc > 1 ? std::atoi(argv[1]) : 16;
  struct Subject {
    const char* name;
    Scene scene;
    Vec3d at;  // world
    bool marker;
    RingChoice rings;
  };
  const Scene oval = BuiltInScene("oval"), room = BuiltInScene("ct-room");
  // On the oval of the room: a place that its first camera sees at a moderate angle.
  const Vec3d eye = room.cameras[0].model.Centre();
  const Vec3d in_room =
      Vec3d(100, 100, 140).cwiseProduct(eye.cwiseQuotient(Vec3d(100, 100, 140)).normalized());
  const Subject subjects[] = {
      {"oval: marker, own ring", oval, {100, 0, 0}, true, RingChoice::kOwn},
      {"oval: marker off axis", oval, {91.65, 40, 0}, true, RingChoice::kOwn},
      {"oval: mask, own ring", oval, {91.65, 40, 0}, false, RingChoice::kOwn},
      {"ct-room: marker, own ring", room, in_room, true, RingChoice::kOwn},
      {"ct-room: marker, six rings", room, in_room, true, RingChoice::kAll},
      {"ct-room: mask, own ring", room, in_room, false, RingChoice::kOwn},
      {"ct-room: mask, six rings", room, in_room, false, RingChoice::kAll}};
  struct Part {
    const char* name;
    Change change;
  };
  const Part parts[] = {{"all", Nothing},
                        {"direct only", DirectOnly},
                        {"and one wavelength", OneWavelength},
                        {"and point LEDs", PointLeds}};
  fmt::print("standard deviation of a pixel over {} seeds, % of its mean, at {} spp; us a pixel\n",
             kSeeds, spp);
  fmt::print("{:28}", "");
  for (const Part& part : parts) fmt::print("{:>22}", part.name);
  fmt::print("\n");
  for (const Subject& subject : subjects) {
    fmt::print("{:28}", subject.name);
    for (const Part& part : parts) {
      Scene scene = subject.scene;
      TraceOptions options;
      options.samples_per_pixel = spp;
      part.change(scene, options);
      const Noise noise = Measure(scene, subject.rings, subject.at, subject.marker, options);
      fmt::print("{:>12.3f} {:>7.1f} us", 100.0 * noise.relative_deviation, noise.microseconds);
    }
    fmt::print("\n");
  }
  return 0;
}
