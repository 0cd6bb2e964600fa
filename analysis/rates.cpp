#include "analysis/rates.h"

#include <unistd.h>

#include <chrono>
#include <filesystem>

#include "core/atomic_file.h"
#include "core/image_file.h"
#include "renderer/bare_embree.h"
#include "renderer/exposure.h"
#include "renderer/film.h"
#include "renderer/id_pass.h"
#include "renderer/sensor.h"
#include "renderer/sensor_noise.h"
#include "scenes/built_in.h"

namespace retrolux {

namespace {

constexpr int kSpp = 16;
constexpr int kFirst = 208, kSide = 64;  // of the block of pixels that paths start from

// Results go here, so that no loop is left out as useless.
volatile double sink = 0.0;

// Calls a second.
template <typename Body>
double CallsPerSecond(double seconds, Body&& body) {
  body();  // fills caches
  const auto start = std::chrono::steady_clock::now();
  double passed = 0.0;
  int calls = 0;
  while (passed < seconds) {
    body();
    ++calls;
    passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return calls / passed;
}

// A folder that is removed with what it holds.
struct Scratch {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("retrolux-rates-{}", ::getpid());
  Scratch() { EnsureWritableFolder(path); }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
};

class Rates {
 public:
  Rates(double seconds, Progress& progress) : seconds_(seconds), progress_(progress) {
    for (int y = 0; y < model_.height; ++y) {
      for (int x = 0; x < model_.width; ++x)
        directions_.push_back(model_.RayThrough(Vec2d(x, y)).direction.cast<float>());
    }
    for (int i = 0; i < model_.width * model_.height; ++i) {
      const int tile = i / 16, tiles = model_.width / 4;
      const int x = 4 * (tile % tiles) + i % 4, y = 4 * (tile / tiles) + i % 16 / 4;
      tiled_directions_.push_back(
          directions_[static_cast<size_t>(y) * static_cast<size_t>(model_.width) +
                      static_cast<size_t>(x)]);
    }
  }

  std::vector<Rate> All(int threads) {
    {
      const LimitThreads one(1);
      Rays();
      IdPass();
      ShadowRays();
      Paths(1);
      SensorPictures();
      Files();
    }
    Paths(threads);
    return std::move(rates_);
  }

 private:
  // `per_call` of `unit` in each call of the body.
  template <typename Body>
  double Add(const std::string& name, const std::string& unit, double per_call,
             const std::string& limit, double limit_per_second, Body&& body) {
    const double rate = per_call * CallsPerSecond(seconds_, body);
    rates_.push_back({name, unit, 1, rate, limit, limit_per_second});
    progress_.Advance(1);
    return rate;
  }

  double Pixels() const { return static_cast<double>(directions_.size()); }

  void Rays() {
    bare_single_ = Add("bare Embree, single rays", "rays", Pixels(), "", 0.0,
                       [&] { sink = bare_.Hits(origin_, directions_); });
    bare_packets_ = Add("bare Embree, packets of 16", "rays", Pixels(), "", 0.0,
                        [&] { sink = bare_.HitsInPackets(origin_, tiled_directions_); });
    Add("surface hits with normals", "rays", Pixels(), "bare Embree, single rays", bare_single_,
        [&] {
          for (const Vec3f& direction : directions_)
            sink = static_cast<double>(rays_.Intersect(origin_, direction).has_value());
        });
  }

  void IdPass() {
    Add("id pass, all channels", "rays", Pixels(), "bare Embree, packets of 16", bare_packets_,
        [&] { sink = RenderIds(rays_, model_, {}).object.data[0]; });
  }

  // From a place on the mask to the diodes of the first camera.
  void ShadowRays() {
    const Vec3f from(150.0f, 0.0f, 0.0f);
    std::vector<Vec3f> targets, ways;
    for (int i = 0; i < 1 << 16; ++i) {
      targets.push_back(LedCentre(camera_, i % camera_.ring->count).cast<float>());
      ways.push_back(targets.back() - from);
    }
    const auto count = static_cast<double>(targets.size());
    const double bare = Add("bare Embree, shadow rays", "rays", count, "", 0.0,
                            [&] { sink = bare_.Blocked(from, ways); });
    Add("shadow rays", "rays", count, "bare Embree, shadow rays", bare, [&] {
      for (const Vec3f& target : targets) sink = static_cast<double>(rays_.Occluded(from, target));
    });
  }

  // A path casts several rays: one from the camera, a shadow ray to each ring, and so on at each
  // surface after that.
  void Paths(int threads) {
    TraceOptions options;
    options.samples_per_pixel = kSpp;
    const PathTracer tracer(scene_, rays_, lights_, response_, markers_, options);
    const double rate =
        kSide * kSide * kSpp * CallsPerSecond(seconds_, [&] {
          ParallelFor(kSide, [&](int64_t row) {
            double sum = 0.0;
            for (int x = 0; x < kSide; ++x)
              sum += static_cast<double>(
                  tracer.EstimatePixel(kFirst + x, kFirst + static_cast<int>(row)).electrons.sum());
            if (row == 0) sink = sum;
          });
        });
    rates_.push_back({fmt::format("paths, {} lights", lights_.GroupCount()), "paths", threads, rate,
                      fmt::format("bare Embree, single rays, x {}", threads),
                      threads * bare_single_});
    progress_.Advance(1);
  }

  void SensorPictures() {
    const Sensor sensor(camera_);
    const FloatPlane signal(model_.width, model_.height, 1000.0f);
    const double draws =
        Add("a Poisson and a normal number a pixel", "pictures", 1.0, "", 0.0, [&] {
          KeyedRng rng(1);
          for (size_t i = 0; i < directions_.size(); ++i)
            sink = SamplePoisson(1000.0, rng) + SampleNormal(rng);
        });
    Add("sensor pictures", "pictures", 1.0, "a Poisson and a normal number a pixel", draws,
        [&] { sink = sensor.Expose(signal, 5e-3, 1).dn.data[0]; });
  }

  void Files() {
    const Scratch scratch;
    // Channels with noise in their last bits, as a film has.
    ExrImage image;
    KeyedRng rng(2);
    for (const char* name : {"electrons.Y", "variance.Y", "radiance.Y", "depth.Z"}) {
      FloatPlane plane(model_.width, model_.height);
      for (float& value : plane.data) value = 1000.0f + rng.NextFloat();
      image.channels.push_back({name, plane});
    }
    const DigitalImage picture =
        Sensor(camera_).Expose(FloatPlane(model_.width, model_.height, 1000.0f), 5e-3, 1);
    const double exr_mb = 4e-6 * 4.0 * Pixels(), png_mb = 1e-6 * Pixels();
    const auto raw = [&](const std::string& what, double mb) {
      const std::string bytes(static_cast<size_t>(1e6 * mb + 0.5), 'x');
      return Add("raw bytes of " + what, "MB", mb, "", 0.0,
                 [&] { WriteTextFile(scratch.path / "raw", bytes); });
    };
    const double raw_exr = raw("an EXR", exr_mb);
    Add("EXR, 4 channels, ZIP", "MB", exr_mb, "raw bytes of an EXR", raw_exr,
        [&] { WriteExr(scratch.path / "film.exr", image); });
    const double raw_png = raw("a PNG", png_mb);
    Add("PNG, 8 bit", "MB", png_mb, "raw bytes of a PNG", raw_png,
        [&] { WritePng(scratch.path / "picture.png", picture); });
  }

  double seconds_;
  Progress& progress_;
  Scene scene_ = CtRoom();
  const CameraSpec& camera_ = scene_.cameras[0];
  const CameraModel& model_ = camera_.model;
  RayScene rays_{scene_};
  BareEmbree bare_{scene_};
  Lights lights_{scene_, rays_, RingChoice::kAll, camera_.model.name};
  CameraResponse response_{camera_, lights_.Spectra(), ExposureSeconds(scene_, camera_)};
  std::vector<PlacedMarker> markers_;
  Vec3f origin_ = model_.Centre().cast<float>();
  std::vector<Vec3f> directions_;        // of the pixels, row by row
  std::vector<Vec3f> tiled_directions_;  // the same in tiles of 4 x 4
  double bare_single_ = 0.0, bare_packets_ = 0.0;
  std::vector<Rate> rates_;
};

}  // namespace

std::vector<Rate> MeasureRates(double seconds, int threads, Progress& progress) {
  constexpr int kLoops = 14;
  progress.Begin("rates", kLoops, "loops");
  std::vector<Rate> rates = Rates(seconds, progress).All(threads);
  progress.End();
  return rates;
}

}  // namespace retrolux
