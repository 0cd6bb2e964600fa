// How long the parts of the marker study take, each beside its limit: rays against a bare Embree
// loop, a composed picture against a full render. One thread, unless the name says otherwise.
//
//   build/release/bench/marker_study_bench
#include <benchmark/benchmark.h>

#include "analysis/marker_study.h"
#include "renderer/bare_embree.h"
#include "renderer/exposure.h"
#include "renderer/id_pass.h"
#include "renderer/sensor.h"
#include "scenes/built_in.h"

namespace {

using namespace retrolux;

constexpr int kSpp = 32;
constexpr int kPixels = 640 * 480;

// TraceOptions::own_ray_share: a shadow ray for each group of light.
constexpr float kEveryGroup = 0.0f;

// The room with one camera ready, and a marker in the middle of its picture.
struct Bench {
  Scene scene = CtRoom();
  RayScene rays{scene};
  const CameraSpec& camera = scene.cameras[0];
  Lights lights{scene, rays, RingChoice::kAll, camera.model.name};
  CameraResponse response{camera, lights.Spectra(), ExposureSeconds(scene, camera)};
  PlacedMarker marker = PlaceMarker(scene, {"marker", 2, "mask", Vec3d(100, 0, 20)}, 1);
  MarkerSurface surface = SampleMarkerSurface(rays, marker);

  TraceOptions Options(float own_ray_share) const {
    TraceOptions options;
    options.samples_per_pixel = kSpp;
    options.own_ray_share = own_ray_share;
    if (own_ray_share > 0.0f) options.roulette = 0.5f;  // as the study does
    return options;
  }
};

const Bench& Shared() {
  static const Bench bench;
  return bench;
}

const ComposedCamera& SharedCamera() {
  static const ComposedCamera camera(Shared().scene, Shared().rays, Shared().camera,
                                     RingChoice::kAll, Shared().Options(kStrongGroups),
                                     NoProgress());
  return camera;
}

void Rate(benchmark::State& state, const char* name, double per_iteration) {
  state.counters[name] =
      benchmark::Counter(per_iteration, benchmark::Counter::kIsIterationInvariantRate);
}

// The limit of the id pass and of every primary ray: packets, nothing done with the hits.
void BareEmbreePackets(benchmark::State& state) {
  const Bench& bench = Shared();
  const BareEmbree bare(bench.scene);
  const Vec3f origin = bench.camera.model.Centre().cast<float>();
  std::vector<Vec3f> directions;
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 640; ++x)
      directions.push_back(bench.camera.model.RayThrough(Vec2d(x, y)).direction.cast<float>());
  }
  for (auto _ : state) benchmark::DoNotOptimize(bare.HitsInPackets(origin, directions));
  Rate(state, "rays", kPixels);
}
BENCHMARK(BareEmbreePackets)->Unit(benchmark::kMillisecond);

// The limit of path tracing: one ray at a time.
void BareEmbreeSingleRays(benchmark::State& state) {
  const Bench& bench = Shared();
  const BareEmbree bare(bench.scene);
  const Vec3f origin = bench.camera.model.Centre().cast<float>();
  std::vector<Vec3f> directions;
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 640; ++x)
      directions.push_back(bench.camera.model.RayThrough(Vec2d(x, y)).direction.cast<float>());
  }
  for (auto _ : state) benchmark::DoNotOptimize(bare.Hits(origin, directions));
  Rate(state, "rays", kPixels);
}
BENCHMARK(BareEmbreeSingleRays)->Unit(benchmark::kMillisecond);

void IdPass(benchmark::State& state) {
  const LimitThreads one(1);
  const Bench& bench = Shared();
  for (auto _ : state) benchmark::DoNotOptimize(RenderIds(bench.rays, bench.camera.model, {}));
  Rate(state, "rays", kPixels);
}
BENCHMARK(IdPass)->Unit(benchmark::kMillisecond);

void Paths(benchmark::State& state, float own_ray_share) {
  const Bench& bench = Shared();
  const std::vector<PlacedMarker> markers;
  const PathTracer tracer(bench.scene, bench.rays, bench.lights, bench.response, markers,
                          bench.Options(own_ray_share));
  // A row through the middle of the picture: room, mask, highlight.
  for (auto _ : state) {
    for (int x = 0; x < 640; x += 8) benchmark::DoNotOptimize(tracer.EstimatePixel(x, 150));
  }
  Rate(state, "paths", 80.0 * kSpp);
}
BENCHMARK_CAPTURE(Paths, StrongGroups, kStrongGroups)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Paths, EveryGroup, kEveryGroup)->Unit(benchmark::kMillisecond);

// The parts of one picture of the study.
void PictureGeometry(benchmark::State& state) {
  const Bench& bench = Shared();
  for (auto _ : state) {
    const PlacedMarker marker =
        PlaceMarker(bench.scene, {"marker", 2, "mask", Vec3d(100, 0, 20)}, 1);
    const MarkerSurface surface = SampleMarkerSurface(bench.rays, marker);
    for (const CameraSpec& camera : bench.scene.cameras)
      benchmark::DoNotOptimize(ViewMarker(surface, bench.rays, camera.model));
  }
  Rate(state, "pictures", 6);
}
BENCHMARK(PictureGeometry)->Unit(benchmark::kMillisecond);

void PictureTrace(benchmark::State& state) {
  const ComposedCamera& camera = SharedCamera();
  int64_t pixels = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(camera.Signal(Shared().marker, Shared().surface, &pixels));
  state.counters["pixels"] = static_cast<double>(pixels) / static_cast<double>(state.iterations());
  Rate(state, "pictures", 1);
}
BENCHMARK(PictureTrace)->Unit(benchmark::kMillisecond);

void PictureSensor(benchmark::State& state) {
  const ComposedCamera& camera = SharedCamera();
  const Sensor sensor(camera.Camera());
  uint64_t key = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(sensor.Expose(camera.Background(), camera.ExposureSeconds(), ++key));
  }
  Rate(state, "pictures", 1);
}
BENCHMARK(PictureSensor)->Unit(benchmark::kMillisecond);

void PictureIdentify(benchmark::State& state) {
  const ComposedCamera& camera = SharedCamera();
  const DigitalImage picture =
      Sensor(camera.Camera())
          .Expose(camera.Signal(Shared().marker, Shared().surface), camera.ExposureSeconds(), 1);
  for (auto _ : state) benchmark::DoNotOptimize(IdentifyByEdges(picture, DefaultMarkerSet(), {}));
  Rate(state, "pictures", 1);
}
BENCHMARK(PictureIdentify)->Unit(benchmark::kMillisecond);

// Whole pictures: composed, and rendered from nothing.
void ComposedPicture(benchmark::State& state) {
  const ComposedCamera& camera = SharedCamera();
  const Sensor sensor(camera.Camera());
  uint64_t key = 0;
  for (auto _ : state) {
    const FloatPlane signal = camera.Signal(Shared().marker, Shared().surface);
    const DigitalImage picture = sensor.Expose(signal, camera.ExposureSeconds(), ++key);
    benchmark::DoNotOptimize(IdentifyByEdges(picture, DefaultMarkerSet(), {}));
  }
  state.counters["pictures_per_minute"] =
      benchmark::Counter(60, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(ComposedPicture)->Unit(benchmark::kMillisecond);

void FullPicture(benchmark::State& state) {
  const LimitThreads one(1);
  const Bench& bench = Shared();
  const std::vector<PlacedMarker> markers = {bench.marker};
  const PathTracer tracer(bench.scene, bench.rays, bench.lights, bench.response, markers,
                          bench.Options(kStrongGroups));
  for (auto _ : state) {
    const Film film =
        RenderFilm(tracer, bench.camera.model, bench.lights.GroupNames(), NoProgress());
    const DigitalImage picture =
        Sensor(bench.camera).Expose(film.electrons, bench.response.ExposureSeconds(), 1);
    benchmark::DoNotOptimize(IdentifyByEdges(picture, DefaultMarkerSet(), {}));
  }
  state.counters["pictures_per_minute"] =
      benchmark::Counter(60, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(FullPicture)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace

BENCHMARK_MAIN();
