// How long the parts of the camera placement search take, the id pass beside its limit: a bare
// Embree loop of 16-wide packets over the same mesh, camera and pixels. One thread.
//
//   build/release/bench/vault_study_bench
#include <benchmark/benchmark.h>

#include "analysis/placement_search.h"
#include "core/parallel.h"
#include "renderer/bare_embree.h"
#include "scenes/masks.h"

namespace {

using namespace retrolux;

constexpr double kPartArea_mm2 = 4.0;  // as `study vault`

// The default face, looked at from a camera of the thesis's placement.
struct Bench {
  LimitThreads one{1};
  Scenario scenario = LoadScenario("1a");
  Placement placement{60.0, 31.67, 70.52};
  Scene scene;
  RayScene rays;
  CameraModel camera;
  PixelRect crop;

  Bench() : scene(FaceScene()), rays(scene) {
    camera = VaultCamera(scenario, "camera", CameraCentres(scenario, placement)[0]);
    crop = Crop(camera, scene.objects[0].mesh.positions);
  }
  static Scene FaceScene() {
    Scene face;
    face.objects.push_back({"mask", FaceMask(), {}, "", false});
    return face;
  }
  double Pixels() const { return static_cast<double>(crop.width) * crop.height; }
};

const Bench& Shared() {
  static const Bench bench;
  return bench;
}

void Rate(benchmark::State& state, const char* name, double per_iteration) {
  state.counters[name] =
      benchmark::Counter(per_iteration, benchmark::Counter::kIsIterationInvariantRate);
}

void BareEmbree16(benchmark::State& state) {
  const Bench& bench = Shared();
  const BareEmbree bare(bench.scene);
  const Vec3f origin = bench.camera.Centre().cast<float>();
  std::vector<Vec3f> directions;  // in tiles of 4 x 4
  for (int y = bench.crop.y0; y < bench.crop.y0 + bench.crop.height; y += 4) {
    for (int x = bench.crop.x0; x < bench.crop.x0 + bench.crop.width; x += 4) {
      for (int i = 0; i < 16; ++i)
        directions.push_back(
            bench.camera.RayThrough(Vec2d(x + i % 4, y + i / 4)).direction.cast<float>());
    }
  }
  for (auto _ : state) benchmark::DoNotOptimize(bare.HitsInPackets(origin, directions));
  Rate(state, "rays", bench.Pixels());
}
BENCHMARK(BareEmbree16)->Unit(benchmark::kMillisecond);

void IdBufferPass(benchmark::State& state) {
  const Bench& bench = Shared();
  for (auto _ : state) {
    const IdBuffer buffer = RenderIdBuffer(bench.rays, bench.camera, bench.crop);
    benchmark::DoNotOptimize(buffer.depth.data.data());
  }
  Rate(state, "rays", bench.Pixels());
}
BENCHMARK(IdBufferPass)->Unit(benchmark::kMillisecond);

// What a camera sees, id buffer or rays included.
void SeenBy(benchmark::State& state, VisibilityRule rule) {
  const Bench& bench = Shared();
  const Mask mask("face", FaceMask(), rule, kPartArea_mm2);
  for (auto _ : state) benchmark::DoNotOptimize(mask.SeenBy(bench.camera));
  Rate(state, "buffers", 1.0);
}
BENCHMARK_CAPTURE(SeenBy, ids, VisibilityRule::kIdBuffer)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(SeenBy, rays, VisibilityRule::kRays)->Unit(benchmark::kMillisecond);

void AreasOfNineCameras(benchmark::State& state) {
  const Bench& bench = Shared();
  const Mask mask("face", FaceMask(), VisibilityRule::kRays, kPartArea_mm2);
  std::vector<SampleSet> sets;
  for (const Vec3d& centre : CameraCentres(bench.scenario, bench.placement))
    sets.push_back(mask.SeenBy(VaultCamera(bench.scenario, "camera", centre)));
  std::vector<const SampleSet*> pointers;
  for (const SampleSet& set : sets) pointers.push_back(&set);
  for (auto _ : state) {
    benchmark::DoNotOptimize(AreasSeenByAll(pointers, mask.Samples().areas_mm2));
  }
  Rate(state, "orientations", 1.0);
}
BENCHMARK(AreasOfNineCameras)->Unit(benchmark::kMillisecond);

// A placement among neighbours, every id buffer made anew.
void EvaluatePlacement(benchmark::State& state) {
  const Bench& bench = Shared();
  const Mask mask("face", FaceMask(), VisibilityRule::kIdBuffer, kPartArea_mm2);
  VisibilityStore store(mask, 0);
  const PlacementSearch search(bench.scenario, "face", store);
  const auto known = search.Orientations(bench.placement);
  const Placement beside = {59.0, 31.67, 70.52};
  const int64_t before = store.Made();
  for (auto _ : state) benchmark::DoNotOptimize(search.Evaluate(beside, known));
  Rate(state, "orientations", static_cast<double>(search.Rotations().size()));
  state.counters["buffers"] =
      benchmark::Counter(static_cast<double>(store.Made() - before), benchmark::Counter::kIsRate);
}
BENCHMARK(EvaluatePlacement)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
