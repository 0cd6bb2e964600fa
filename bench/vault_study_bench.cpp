// How long the parts of the camera placement search take, the id pass beside its limit: a bare
// Embree loop of 16-wide packets over the same mesh, camera and pixels. One thread.
//
//   build/release/bench/vault_study_bench
#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

#include <limits>

#include "analysis/placement_search.h"
#include "core/parallel.h"
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

// Embree alone, with its default flags and nothing kept but the number of hits.
class BareScene {
 public:
  explicit BareScene(const TriangleMesh& mesh) {
    device_ = rtcNewDevice(nullptr);
    tree_ = rtcNewScene(device_);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<Vec3f*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(Vec3f), mesh.positions.size()));
    std::copy(mesh.positions.begin(), mesh.positions.end(), vertices);
    auto* indices = static_cast<std::array<uint32_t, 3>*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                sizeof(mesh.triangles[0]), mesh.triangles.size()));
    std::copy(mesh.triangles.begin(), mesh.triangles.end(), indices);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(tree_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(tree_);
  }
  ~BareScene() {
    rtcReleaseScene(tree_);
    rtcReleaseDevice(device_);
  }
  BareScene(const BareScene&) = delete;
  BareScene& operator=(const BareScene&) = delete;

  int Hits(const CameraModel& camera, const PixelRect& crop) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    const Vec3f origin = camera.Centre().cast<float>();
    const Eigen::Matrix3f turn = camera.camera_from_world.rotation.transpose().cast<float>();
    const auto fx = static_cast<float>(camera.fx), fy = static_cast<float>(camera.fy);
    const auto cx = static_cast<float>(camera.cx), cy = static_cast<float>(camera.cy);
    alignas(64) int valid[16];
    std::fill(valid, valid + 16, -1);
    int hits = 0;
    for (int y = crop.y0; y < crop.y0 + crop.height; y += 4) {
      for (int x = crop.x0; x < crop.x0 + crop.width; x += 4) {
        RTCRayHit16 packet{};
        for (int i = 0; i < 16; ++i) {
          const float u = (static_cast<float>(x + i % 4) - cx) / fx;
          const float v = (static_cast<float>(y + i / 4) - cy) / fy;
          packet.ray.org_x[i] = origin.x();
          packet.ray.org_y[i] = origin.y();
          packet.ray.org_z[i] = origin.z();
          packet.ray.dir_x[i] = turn(0, 0) * u + turn(0, 1) * v + turn(0, 2);
          packet.ray.dir_y[i] = turn(1, 0) * u + turn(1, 1) * v + turn(1, 2);
          packet.ray.dir_z[i] = turn(2, 0) * u + turn(2, 1) * v + turn(2, 2);
          packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
          packet.ray.mask[i] = ~0u;
          packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        }
        rtcIntersect16(valid, tree_, &context, &packet);
        for (int i = 0; i < 16; ++i) hits += packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
      }
    }
    return hits;
  }

 private:
  RTCDevice device_;
  RTCScene tree_;
};

void BareEmbree16(benchmark::State& state) {
  const Bench& bench = Shared();
  const BareScene bare(bench.scene.objects[0].mesh);
  for (auto _ : state) benchmark::DoNotOptimize(bare.Hits(bench.camera, bench.crop));
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
