#include "analysis/motion_study.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/motion_recording.h"
#include "analysis/stereo_folder.h"
#include "core/atomic_file.h"
#include "renderer/marker_truth.h"

namespace retrolux {

namespace {

using Json = nlohmann::json;

constexpr int kIdentifiable = 6;

// Where the markers are on the mask, as planning knows it.
Constellation PlannedConstellation(const Scene& reference) {
  const RayScene rays(reference);
  Constellation constellation;
  for (const PlacedMarker& placed : PlaceMarkers(reference)) {
    const auto hit = OntoSurface(rays, placed, ShapeCentre(*placed.shape).head<2>());
    RETROLUX_CHECK(hit, "marker {} is not on the mask", placed.instance);
    const MarkerSpec& spec = reference.markers[placed.instance - 1];
    constellation.push_back(
        {spec.name, spec.number, hit->position.cast<double>(), placed.NormalInWorld()});
  }
  return constellation;
}

// Follows the markers of both cameras and the mask, frame by frame.
class Watch {
 public:
  explicit Watch(const MotionStudyOptions& options)
      : options_(options), reference_(MotionReferenceScene(options)) {
    constellation_ = PlannedConstellation(reference_);
    std::vector<TrackedMarker> markers;
    for (int n = 1; n <= kIdentifiable; ++n) markers.push_back({fmt::format("marker-{}", n), n});
    for (size_t c = 0; c < 2; ++c) trackers_.emplace_back(markers, options.tracking);
  }

  MotionFrame Next(int frame, const Json& record) {
    MotionFrame result;
    result.time_s = frame / options_.frames_per_s;
    result.true_mm = options_.profile.Displacement_mm(result.time_s);
    std::vector<CameraView> views;
    for (size_t c = 0; c < 2; ++c)
      views.push_back(FollowedView(c, RecordedDetections(record, c), result));
    const StereoResult found = Reconstruct(views, constellation_, {});
    if (!found.pose) return result;
    const PoseError error =
        ErrorOf(found.pose->world_from_mask, options_.profile.At(result.time_s));
    result.found_mm = found.pose->world_from_mask.translation;
    result.turn_error_deg = error.rotation_deg;
    result.alarm = result.found_mm->norm() > options_.limit_mm;
    result.markers = static_cast<int>(found.pose->pairs.size());
    return result;
  }

 private:
  // A camera's detections with the names that tracking gives them, and no others.
  CameraView FollowedView(size_t camera, std::vector<Detection> detections, MotionFrame& frame) {
    CameraView view{reference_.cameras[camera].model, std::move(detections)};
    const auto& tracks = trackers_[camera].Next(view.detections);
    for (Detection& detection : view.detections) {
      if (detection.marker != 0) detection.marker.reset();
    }
    for (const MarkerTracker::Track& track : tracks) {
      frame.states[camera].push_back(track.state);
      if (!track.detection) continue;
      view.detections[*track.detection].marker = track.marker.number;
      frame.followed_without_name += !track.identified;
    }
    return view;
  }

  const MotionStudyOptions& options_;
  Scene reference_;
  Constellation constellation_;
  std::vector<MarkerTracker> trackers_;
};

HiddenOutcome OutcomeOf(const HiddenFrames& hidden, const std::vector<MotionFrame>& frames) {
  HiddenOutcome outcome{hidden};
  const auto state = [&](size_t frame) {
    return frames[frame].states[0][static_cast<size_t>(hidden.number - 1)];
  };
  for (auto f = static_cast<size_t>(hidden.first); f < frames.size(); ++f) {
    if (f <= static_cast<size_t>(hidden.last)) {
      outcome.lost = outcome.lost || state(f) == MarkerTracker::State::kLost;
    } else if (state(f) == MarkerTracker::State::kTracked) {
      outcome.back_after_frames = static_cast<int>(f) - hidden.last - 1;
      outcome.by_name = outcome.lost;
      break;
    }
  }
  return outcome;
}

void Evaluate(MotionStudy& study) {
  const MotionStudyOptions& options = study.options;
  const double end_s = (options.frames - 1) / options.frames_per_s;
  study.crossing_s = options.profile.FirstCrossing_s(options.limit_mm, end_s);
  double squares = 0.0, found = 0.0;
  Vec3d sum = Vec3d::Zero();
  for (const MotionFrame& frame : study.frames) {
    const bool beyond = frame.true_mm.norm() > options.limit_mm;
    study.false_alarms += frame.alarm && !beyond;
    study.missed_alarms += !frame.alarm && beyond;
    if (frame.alarm && study.alarm_s < 0.0) study.alarm_s = frame.time_s;
    if (!frame.found_mm) continue;
    const Vec3d error = *frame.found_mm - frame.true_mm;
    squares += error.squaredNorm();
    sum += error;
    ++found;
    study.max_error_mm = std::max(study.max_error_mm, error.norm());
  }
  if (found > 0.0) {
    study.rms_error_mm = std::sqrt(squares / found);
    study.bias_mm = sum.norm() / found;
  }
  for (const HiddenFrames& hidden : options.hidden) {
    if (hidden.last + 1 < options.frames) study.outcomes.push_back(OutcomeOf(hidden, study.frames));
  }
}

Json OptionsJson(const MotionStudyOptions& options) {
  const MotionProfile& p = options.profile;
  const auto vector = [](const Vec3d& v) { return Json{v.x(), v.y(), v.z()}; };
  Json hidden = Json::array();
  for (const HiddenFrames& h : options.hidden) hidden.push_back({h.number, h.first, h.last});
  return {{"seed", options.shot.seed},
          {"spp", options.shot.samples_per_pixel},
          {"frames_per_s", options.frames_per_s},
          {"psi_deg", options.psi_deg},
          {"distance_mm", options.shot.distance_mm},
          {"material", options.shot.material},
          {"hidden", hidden},
          {"breath_mm", vector(p.breath_mm)},
          {"breath_period_s", p.breath_period_s},
          {"breath_exponent", p.breath_exponent},
          {"drift_mm_s", vector(p.drift_mm_s)},
          {"cough_start_s", p.cough_start_s},
          {"cough_length_s", p.cough_length_s},
          {"cough_mm", vector(p.cough_mm)},
          {"cough_nod_deg", p.cough_nod_deg}};
}

}  // namespace

const char* NameOf(MarkerTracker::State state) {
  switch (state) {
    case MarkerTracker::State::kUnseen:
      return "unseen";
    case MarkerTracker::State::kTracked:
      return "tracked";
    case MarkerTracker::State::kMissed:
      return "missed";
    case MarkerTracker::State::kLost:
      return "lost";
  }
  RETROLUX_CHECK(false, "state {}", static_cast<int>(state));
}

MotionStudy RunMotionStudy(const MotionStudyOptions& options, const std::filesystem::path& folder,
                           Progress& progress) {
  MotionStudy study;
  study.options = options;
  EnsureWritableFolder(folder / "pictures");
  TaskManifest manifest(folder, "motion", OptionsJson(options));
  std::vector<Task> tasks;
  for (int f = 0; f < options.frames; ++f)
    tasks.push_back({fmt::format("frame {}", f), {{"frame", f}}});
  TaskLoop loop;
  loop.unit = "frames";
  loop.usable = [&](const Json& result) {
    for (const Json& picture : result.at("pictures")) {
      if (!std::filesystem::is_regular_file(folder / picture.get<std::string>())) return false;
    }
    return true;
  };
  const std::vector<Json> records = manifest.Run(
      "frames", tasks,
      [&](size_t task) { return RecordMotionFrame(options, static_cast<int>(task), folder); },
      progress, loop);
  study.tasks = manifest.Report();
  Watch watch(study.options);
  for (int f = 0; f < options.frames; ++f) {
    const Json& record = records[static_cast<size_t>(f)];
    study.frames.push_back(watch.Next(f, record));
    for (const Json& camera : record.at("cameras"))
      study.identify_ms += camera.at("identify_ms").get<double>() / (2.0 * options.frames);
    for (const Json& picture : record.at("pictures"))
      study.pictures.push_back(picture.get<std::string>());
  }
  Evaluate(study);
  return study;
}

}  // namespace retrolux
