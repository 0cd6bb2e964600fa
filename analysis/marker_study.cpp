#include "analysis/marker_study.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <tuple>

#include "core/atomic_file.h"
#include "core/hash.h"
#include "core/image_file.h"
#include "renderer/render_files.h"
#include "renderer/sensor.h"

namespace retrolux {

namespace fs = std::filesystem;

const char* OutcomeName(Outcome outcome) {
  constexpr const char* kNames[kOutcomes] = {"hit",         "outside_picture", "facing_away",
                                             "hidden",      "too_small",       "not_detected",
                                             "wrong_number"};
  return kNames[static_cast<size_t>(outcome)];
}

namespace {

using Clock = std::chrono::steady_clock;

double Since(Clock::time_point& last) {
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - last).count();
  last = now;
  return seconds;
}

// Light that went over another surface first is a few per cent of the signal here: half the paths
// for it do.
constexpr float kRoulette = 0.5f;

// A pattern belongs to the marker if its centroid lies this close to the marker's outline, px.
constexpr double kMatchMargin_px = 2.0;

const Detection* DetectionAt(const std::vector<Detection>& detections, const Polygon& outline_px) {
  if (outline_px.size() < 3) return nullptr;
  const Polygon hull = ConvexHull(outline_px);
  const Vec2d centre = Centroid(hull);
  const Detection* nearest = nullptr;
  for (const Detection& detection : detections) {
    const Vec2d inwards = (centre - detection.centroid_px).normalized() * kMatchMargin_px;
    const bool near =
        Contains(hull, detection.centroid_px) || Contains(hull, detection.centroid_px + inwards);
    if (!near) continue;
    if (!nearest ||
        (detection.centroid_px - centre).norm() < (nearest->centroid_px - centre).norm())
      nearest = &detection;
  }
  return nearest;
}

// Nothing if a picture has to be made to know.
std::optional<Outcome> OutcomeByGeometry(const MarkerView& view) {
  if (view.visible_fraction > 0.0) return std::nullopt;
  if (view.in_frame_fraction <= 0.0) return Outcome::kOutsidePicture;
  if (view.facing_fraction <= 0.0) return Outcome::kFacingAway;
  return Outcome::kHidden;
}

Outcome OutcomeOfPicture(int marker, const MarkerView& view, const Detection* found,
                         double min_area_px) {
  if (found && found->marker == marker) return Outcome::kHit;
  if (!view.in_frame) return Outcome::kOutsidePicture;
  if (view.visible_fraction < 0.5) return Outcome::kHidden;
  if (!found && std::abs(SignedArea(view.outline_px)) * view.visible_fraction < min_area_px)
    return Outcome::kTooSmall;
  return found ? Outcome::kWrongNumber : Outcome::kNotDetected;
}

std::string PictureName(const MarkerStudy& study, const PictureResult& result) {
  return fmt::format("marker{}_{}_{}_r{:02}_c{:02}{}", result.marker,
                     study.poses[static_cast<size_t>(result.pose)].name,
                     study.cameras[static_cast<size_t>(result.camera)], result.position.row,
                     result.position.col, result.position.mirrored ? "m" : "");
}

// One pose: the room with the patient in place, and its six backgrounds.
class PoseStudy {
 public:
  PoseStudy(const Scene& scene, MarkerStudy& study, int pose, const fs::path& folder,
            Progress& progress)
      : study_(study),
        pose_(pose),
        folder_(folder),
        progress_(progress),
        scene_(scene.AtPose(study.poses[static_cast<size_t>(pose)])),
        rays_(scene_) {
    TraceOptions trace;
    trace.samples_per_pixel = study.options.samples_per_pixel;
    trace.direct = TraceOptions::Direct::kOneOfAll;
    trace.roulette = kRoulette;
    trace.seed =
        CombineKeys(study.options.seed, HashBytes(study.poses[static_cast<size_t>(pose)].name));
    for (const CameraSpec& camera : scene_.cameras) {
      cameras_.push_back(std::make_unique<ComposedCamera>(scene_, rays_, camera, RingChoice::kAll,
                                                          trace, progress_));
    }
  }

  // All cameras' pictures of a marker at a position.
  std::vector<PictureResult> Position(int marker, const GridPosition& position) {
    Clock::time_point clock = Clock::now();
    MarkerStudy::Times times;
    int64_t composed = 0, retraced = 0;
    const PlacedMarker placed = Place(marker, position);
    const MarkerSurface surface = SampleMarkerSurface(rays_, placed);
    std::vector<PictureResult> results;
    for (size_t c = 0; c < cameras_.size(); ++c) {
      PictureResult result{marker, pose_, static_cast<int>(c), position, surface.centre,
                           0.0,    0.0,   Outcome::kHidden,    {}};
      const MarkerView view = ViewMarker(surface, rays_, cameras_[c]->Camera().model);
      result.incidence_deg = view.incidence_deg;
      result.visible_fraction = view.visible_fraction;
      const std::optional<Outcome> decided = OutcomeByGeometry(view);
      times.geometry += Since(clock);
      if (decided) {
        result.outcome = *decided;
      } else {
        ++composed;
        const FloatPlane signal = cameras_[c]->Signal(placed, surface, &retraced);
        times.trace += Since(clock);
        const DigitalImage picture = Expose(*cameras_[c], signal, result);
        times.sensor += Since(clock);
        const std::vector<Detection> found =
            IdentifyByEdges(picture, DefaultMarkerSet(), study_.options.edges);
        const Detection* here = DetectionAt(found, view.outline_px);
        if (here) result.detected = here->marker;
        result.outcome = OutcomeOfPicture(marker, view, here, study_.options.edges.min_area_px);
        times.identify += Since(clock);
        const bool keep = study_.options.keep == Keep::kAll ||
                          (study_.options.keep == Keep::kMisses && result.outcome != Outcome::kHit);
        if (keep) KeepPicture(picture, result, "");
        times.write += Since(clock);
      }
      results.push_back(result);
    }
    Account(times, position.mirrored, composed, retraced);
    return results;
  }

  // The pictures that show where hits begin and end: made again, bit for bit, from what names them.
  void KeepSamples(const std::vector<PictureResult>& results) {
    for (int c = 0; c < static_cast<int>(cameras_.size()); ++c) {
      const PictureResult* frontal = nullptr;
      const PictureResult* oblique = nullptr;
      const PictureResult* rim = nullptr;
      const PictureResult* last_hit = nullptr;
      const PictureResult* first_miss = nullptr;
      const auto closer = [](const PictureResult& a, const PictureResult* b, double deg) {
        return !b || std::abs(a.incidence_deg - deg) < std::abs(b->incidence_deg - deg);
      };
      for (const PictureResult& r : results) {
        if (r.camera != c || r.visible_fraction < 0.999) continue;
        if (closer(r, frontal, 0.0)) frontal = &r;
        if (closer(r, oblique, 45.0)) oblique = &r;
        if (closer(r, rim, 80.0)) rim = &r;
        if (r.outcome == Outcome::kHit && closer(r, last_hit, 90.0)) last_hit = &r;
        if (r.outcome != Outcome::kHit && closer(r, first_miss, 0.0)) first_miss = &r;
      }
      const std::pair<const PictureResult*, const char*> chosen[] = {{frontal, "frontal"},
                                                                     {oblique, "oblique"},
                                                                     {rim, "rim"},
                                                                     {last_hit, "last hit"},
                                                                     {first_miss, "first miss"}};
      for (const auto& [result, kind] : chosen) {
        if (!result) continue;
        const PlacedMarker placed = Place(result->marker, result->position);
        const FloatPlane signal =
            cameras_[static_cast<size_t>(c)]->Signal(placed, SampleMarkerSurface(rays_, placed));
        KeepPicture(Expose(*cameras_[static_cast<size_t>(c)], signal, *result), *result, kind);
      }
    }
  }

 private:
  PlacedMarker Place(int marker, const GridPosition& position) const {
    MarkerSpec spec{"marker", marker, "mask", marker_grid::Point(position)};
    spec.material = study_.options.material;
    return PlaceMarker(scene_, spec, 1);
  }

  DigitalImage Expose(const ComposedCamera& camera, const FloatPlane& signal,
                      const PictureResult& result) const {
    return ExposeSensor(signal, camera.Camera().sensor, camera.ExposureSeconds(),
                        NoiseKey(study_.options.noise_seed, PictureName(study_, result)));
  }

  void KeepPicture(const DigitalImage& picture, const PictureResult& result,
                   const std::string& kind) {
    const std::string file = fmt::format("pictures/{}.png", PictureName(study_, result));
    WritePng(folder_ / file, picture);
    const std::lock_guard lock(mutex_);
    study_.kept.push_back({result, file, kind});
  }

  void Account(const MarkerStudy::Times& times, bool mirrored, int64_t composed, int64_t retraced) {
    const std::lock_guard lock(mutex_);
    study_.times.geometry += times.geometry;
    study_.times.trace += times.trace;
    study_.times.sensor += times.sensor;
    study_.times.identify += times.identify;
    study_.times.write += times.write;
    (mirrored ? study_.mirrored_composed : study_.composed) += composed;
    study_.retraced_pixels += retraced;
  }

  MarkerStudy& study_;
  int pose_;
  fs::path folder_;
  Progress& progress_;
  Scene scene_;
  RayScene rays_;
  std::vector<std::unique_ptr<ComposedCamera>> cameras_;
  std::mutex mutex_;
};

void CheckStudyScene(const Scene& scene) {
  scene.Object("mask");
  std::vector<std::string> names;
  for (const CameraSpec& camera : scene.cameras) names.push_back(camera.model.name);
  for (const std::string& name : names) {
    if (!name.starts_with("front") && !name.starts_with("back")) {
      throw InputError(
          fmt::format("scene '{}': camera '{}'; expected names that begin with 'front' or 'back'",
                      scene.name, name));
    }
    std::string mirrored = name;
    if (name.ends_with("-left")) mirrored.replace(name.size() - 5, 5, "-right");
    if (name.ends_with("-right")) mirrored.replace(name.size() - 6, 6, "-left");
    if (std::find(names.begin(), names.end(), mirrored) == names.end()) {
      throw InputError(
          fmt::format("scene '{}': camera '{}' without '{}'; expected cameras in mirrored pairs",
                      scene.name, name, mirrored));
    }
  }
}

std::vector<GridPosition> Positions(int stride) {
  std::vector<GridPosition> positions;
  for (int row = stride / 2; row < marker_grid::kRows; row += stride) {
    for (int col = stride / 2; col < marker_grid::kColumns; col += stride)
      positions.push_back({row, col});
  }
  return positions;
}

// `count` of the positions, or all if there are fewer, evenly spread over their list, mirrored.
std::vector<GridPosition> Mirrored(const std::vector<GridPosition>& positions, int count) {
  std::vector<GridPosition> mirrored;
  const size_t chosen = std::min(positions.size(), static_cast<size_t>(count));
  for (size_t i = 0; i < chosen; ++i) {
    mirrored.push_back(positions[(2 * i + 1) * positions.size() / (2 * chosen)]);
    mirrored.back().mirrored = true;
  }
  return mirrored;
}

template <typename T>
void CheckNoneTwice(const char* option, std::vector<T> values) {
  std::sort(values.begin(), values.end());
  const auto twice = std::adjacent_find(values.begin(), values.end());
  if (twice != values.end())
    throw InputError(fmt::format("{}: {} twice; expected each once", option, *twice));
}

}  // namespace

std::vector<Pose> ScanPoses(const Scene& scene, double step_mm) {
  double lo = 0.0, hi = 0.0;
  for (const Pose& pose : scene.poses) {
    lo = std::min(lo, pose.translation.z());
    hi = std::max(hi, pose.translation.z());
  }
  std::vector<Pose> poses;
  for (int i = 0; i <= static_cast<int>(std::lround((hi - lo) / step_mm)); ++i) {
    const double z = hi - i * step_mm;
    poses.push_back({fmt::format("z{:+.0f}", z), Vec3d(0, 0, z)});
  }
  return poses;
}

MarkerStudy RunMarkerStudy(const Scene& scene, const MarkerStudyOptions& options,
                           const fs::path& folder, Progress& progress) {
  CheckStudyScene(scene);
  options.edges.Check();
  for (const int marker : options.markers) DefaultMarkerSet().ByNumber(marker);
  CheckNoneTwice("--markers", options.markers);
  std::vector<std::string> pose_names;
  for (const Pose& pose : options.poses) pose_names.push_back(pose.name);
  CheckNoneTwice("--poses", pose_names);
  EnsureWritableFolder(folder / "pictures");
  MarkerStudy study;
  study.options = options;
  study.poses = options.poses;
  for (const CameraSpec& camera : scene.cameras) {
    study.cameras.push_back(camera.model.name);
    study.camera_centres.push_back(camera.model.Centre());
  }
  Scene room = scene;
  room.UseMaterial(options.material);
  room.exposure.marker_material = options.material;

  std::vector<GridPosition> positions = Positions(options.stride);
  const size_t own_half = positions.size();
  const std::vector<GridPosition> mirrored = Mirrored(positions, options.mirrored_checks);
  positions.insert(positions.end(), mirrored.begin(), mirrored.end());
  int64_t background_pixels = 0;
  for (const CameraSpec& camera : scene.cameras)
    background_pixels += camera.model.width * camera.model.height;
  for (int pose = 0; pose < static_cast<int>(study.poses.size()); ++pose) {
    const std::string& name = study.poses[static_cast<size_t>(pose)].name;
    Clock::time_point clock = Clock::now();
    progress.Begin("backgrounds, " + name, background_pixels, "px");
    PoseStudy pose_study(room, study, pose, folder, progress);
    progress.End();
    study.times.background += Since(clock);

    const auto tasks = static_cast<int64_t>(positions.size() * options.markers.size());
    std::vector<std::vector<PictureResult>> results(static_cast<size_t>(tasks));
    progress.Begin("pictures, " + name, tasks * static_cast<int64_t>(scene.cameras.size()),
                   "pictures");
    ParallelFor(tasks, [&](int64_t task) {
      const auto t = static_cast<size_t>(task);
      results[t] = pose_study.Position(options.markers[t / positions.size()],
                                       positions[t % positions.size()]);
      progress.Advance(static_cast<int64_t>(scene.cameras.size()));
    });
    std::vector<PictureResult> of_pose;
    for (size_t t = 0; t < results.size(); ++t) {
      auto& target = t % positions.size() < own_half ? of_pose : study.mirrored;
      target.insert(target.end(), results[t].begin(), results[t].end());
    }
    if (options.keep == Keep::kSamples) pose_study.KeepSamples(of_pose);
    study.results.insert(study.results.end(), of_pose.begin(), of_pose.end());
    progress.End();
    study.times.pictures += Since(clock);
  }
  std::sort(study.kept.begin(), study.kept.end(), [](const KeptPicture& a, const KeptPicture& b) {
    return std::tie(a.result.pose, a.result.camera, a.result.incidence_deg, a.file) <
           std::tie(b.result.pose, b.result.camera, b.result.incidence_deg, b.file);
  });
  return study;
}

}  // namespace retrolux
