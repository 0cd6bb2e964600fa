#include "analysis/marker_study.h"

#include <algorithm>
#include <tuple>

#include "analysis/marker_study_task.h"
#include "core/atomic_file.h"
#include "core/data_path.h"
#include "core/hash.h"
#include "scenes/scene_json.h"

namespace retrolux {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const char* OutcomeName(Outcome outcome) {
  constexpr const char* kNames[kOutcomes] = {"hit",         "outside_picture", "facing_away",
                                             "hidden",      "too_small",       "not_detected",
                                             "wrong_number"};
  return kNames[static_cast<size_t>(outcome)];
}

namespace {

void CheckStudyScene(const Scene& scene) {
  if (scene.Object("mask").perforation) {
    throw InputError(
        fmt::format("scene '{}': a perforated mask; expected a closed one: the study moves its "
                    "marker over one geometry, in which no holes can be closed",
                    scene.name));
  }
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

void CheckStudy(const Scene& scene, const MarkerStudyOptions& options) {
  CheckStudyScene(scene);
  if (options.method != kEdgesMethod && options.method != kRobustMethod) {
    throw InputError(
        fmt::format("method '{}'; expected {} or {}", options.method, kEdgesMethod, kRobustMethod));
  }
  options.edges.Check();
  options.robust.Check();
  for (const int marker : options.markers) DefaultMarkerSet().ByNumber(marker);
  CheckNoneTwice("--markers", options.markers);
  std::vector<std::string> poses;
  for (const Pose& pose : options.poses) poses.push_back(pose.name);
  CheckNoneTwice("--poses", poses);
}

Json ToJson(const EdgesOptions& edges) {
  static_assert(sizeof(EdgesOptions) == 12 * sizeof(double), "every option belongs here");
  return {{"min_area_px", edges.min_area_px},
          {"min_slope_sigma", edges.min_slope_sigma},
          {"min_contrast_sigma", edges.min_contrast_sigma},
          {"max_blur_px", edges.max_blur_px},
          {"straightness_px", edges.straightness_px},
          {"bend", edges.bend},
          {"min_gain", edges.min_gain},
          {"min_edge_px", edges.min_edge_px},
          {"min_turn_deg", edges.min_turn_deg},
          {"max_shape_error_px", edges.max_shape_error_px},
          {"max_shape_error", edges.max_shape_error},
          {"max_tilt_deg", edges.max_tilt_deg}};
}

Json ToJson(const RobustOptions& robust) {
  return {{"min_area_px", robust.min_area_px},
          {"min_slope_sigma", robust.min_slope_sigma},
          {"min_contrast_sigma", robust.min_contrast_sigma},
          {"max_edge_blur_px", robust.max_edge_blur_px},
          {"turns", robust.turns},
          {"likely_outline", robust.likely_outline},
          {"fits", robust.fits},
          {"margin_px", robust.patch.margin_px},
          {"most_pixels", robust.patch.most_pixels},
          {"max_steps", robust.fit.max_steps},
          {"converged_px", robust.fit.converged_px},
          {"max_blur_px", robust.fit.max_blur_px},
          {"curvature", robust.fit.curvature},
          {"focal_px", robust.fit.focal_px},
          {"min_probability", robust.min_probability},
          {"dark", robust.dark},
          {"black_dn", robust.black_dn ? Json(*robust.black_dn) : Json()}};
}

// All that every task depends on. Which poses are studied is no part of it, so that those done stay
// done when more are asked for.
Json Inputs(const Scene& room, const MarkerStudyOptions& options) {
  const char* keep = options.keep == Keep::kAll      ? "all"
                     : options.keep == Keep::kMisses ? "misses"
                                                     : "samples";
  const std::string marker_set = ReadTextFile(DataPath("scenes/data/markers.json"));
  return {{"scene", SceneHash(room)},         {"marker_set", HexHash(HashBytes(marker_set))},
          {"markers", options.markers},       {"material", options.material},
          {"stride", options.stride},         {"mirrored_checks", options.mirrored_checks},
          {"spp", options.samples_per_pixel}, {"seed", options.seed},
          {"noise_seed", options.noise_seed}, {"keep", keep},
          {"method", options.method},         {"edges", ToJson(options.edges)},
          {"robust", ToJson(options.robust)}};
}

// By pose, then by camera.
std::vector<Task> Tasks(const MarkerStudy& study) {
  std::vector<Task> tasks;
  for (const Pose& pose : study.poses) {
    const Vec3d& t = pose.translation;
    const Json posed = {{"name", pose.name}, {"translation_mm", {t.x(), t.y(), t.z()}}};
    for (const std::string& camera : study.cameras) {
      tasks.push_back({fmt::format("camera {}, pose {}", camera, pose.name),
                       {{"camera", camera}, {"pose", posed}}});
    }
  }
  return tasks;
}

// Puts the tasks' pictures into the study, by pose, marker, position and camera.
void Collect(const std::vector<MarkerStudyTaskResult>& results, MarkerStudy& study) {
  const size_t cameras = study.cameras.size();
  for (size_t first = 0; first < results.size(); first += cameras) {
    for (size_t i = 0; i < results[first].pictures.size(); ++i) {
      for (size_t c = 0; c < cameras; ++c) {
        const PictureResult& picture = results[first + c].pictures[i];
        const bool made = picture.visible_fraction > 0.0;
        (picture.position.mirrored ? study.mirrored : study.results).push_back(picture);
        (picture.position.mirrored ? study.mirrored_composed : study.composed) += made ? 1 : 0;
      }
    }
  }
  for (const MarkerStudyTaskResult& result : results) {
    study.retraced_pixels += result.retraced_pixels;
    for (const MarkerStudyTaskResult::Kept& kept : result.kept) {
      const PictureResult& picture = result.pictures.at(kept.picture);
      study.kept.push_back({picture, kept.file, kept.kind});
    }
  }
  std::sort(study.kept.begin(), study.kept.end(), [](const KeptPicture& a, const KeptPicture& b) {
    return std::tie(a.result.pose, a.result.camera, a.result.incidence_deg, a.file) <
           std::tie(b.result.pose, b.result.camera, b.result.incidence_deg, b.file);
  });
}

}  // namespace

MarkerStudy::Times& MarkerStudy::Times::operator+=(const Times& other) {
  background += other.background;
  pictures += other.pictures;
  geometry += other.geometry;
  trace += other.trace;
  sensor += other.sensor;
  identify += other.identify;
  write += other.write;
  return *this;
}

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
  CheckStudy(scene, options);
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
  const std::vector<GridPosition> mirrored = Mirrored(positions, options.mirrored_checks);
  positions.insert(positions.end(), mirrored.begin(), mirrored.end());

  const auto pose_of = [&](size_t task) { return static_cast<int>(task / study.cameras.size()); };
  const auto camera_of = [&](size_t task) { return static_cast<int>(task % study.cameras.size()); };
  TaskLoop loop;
  loop.parallel = false;
  loop.unit = "pictures";
  loop.steps_per_task = static_cast<int64_t>(options.markers.size() * positions.size());
  loop.usable = [&](const Json& result) { return KeptPicturesAreThere(result, folder); };
  TaskManifest manifest(folder, "markers", Inputs(room, options));
  const std::vector<Json> done = manifest.Run(
      "pictures", Tasks(study),
      [&](size_t task) {
        return RunMarkerStudyTask(room, study, pose_of(task), camera_of(task), positions, folder,
                                  progress, study.times)
            .ToJson();
      },
      progress, loop);
  study.tasks = manifest.Report();
  std::vector<MarkerStudyTaskResult> results;
  for (size_t task = 0; task < done.size(); ++task)
    results.push_back(MarkerStudyTaskResult::FromJson(done[task], pose_of(task), camera_of(task)));
  Collect(results, study);
  return study;
}

}  // namespace retrolux
