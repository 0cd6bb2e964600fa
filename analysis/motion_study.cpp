#include "analysis/motion_study.h"

#include <cmath>
#include <ctime>

#include "analysis/stereo_folder.h"
#include "classifier/method.h"
#include "core/atomic_file.h"
#include "core/hash.h"
#include "core/image_file.h"
#include "renderer/exposure.h"
#include "renderer/marker_truth.h"
#include "renderer/render_files.h"
#include "renderer/sensor.h"
#include "scenes/mesh_shapes.h"

namespace retrolux {

namespace {

using Json = nlohmann::json;

constexpr int kIdentifiable = 6;

StereoShotSpec ReferenceShot(const MotionStudyOptions& options) {
  return {StereoTarget::kOval, options.psi_deg, 0};
}

// The mask where the planning had it: its frame is the world.
Scene ReferenceScene(const MotionStudyOptions& options) {
  Scene scene = StereoScene(ReferenceShot(options), options.shot);
  scene.objects.front().world_from_object = {};
  return scene;
}

// A black plate between the left camera and a marker: wide enough to hide it, and so near that the
// right camera looks past it at the marker and its neighbours.
void AddPlate(const PlacedMarker& marker, Scene& scene) {
  constexpr double kBefore_mm = 35.0, kHalf_mm = 12.0;
  const Vec3d at = marker.CentreInWorld();
  const Vec3d towards = (scene.cameras.front().model.Centre() - at).normalized();
  const Vec3d u = Vec3d::UnitZ().cross(towards).normalized(), v = towards.cross(u);
  scene.UseMaterial("black");
  scene.objects.push_back({"plate",
                           RectangleMesh(at + kBefore_mm * towards - kHalf_mm * (u + v),
                                         2.0 * kHalf_mm * u, 2.0 * kHalf_mm * v),
                           {},
                           "black"});
}

bool IsHidden(const HiddenFrames& hidden, int frame) {
  return frame >= hidden.first && frame <= hidden.last;
}

Scene SceneAt(const MotionStudyOptions& options, int frame) {
  Scene scene = ReferenceScene(options);
  scene.objects.front().world_from_object = options.profile.At(frame / options.frames_per_s);
  const std::vector<PlacedMarker> placed = PlaceMarkers(scene);
  for (const HiddenFrames& hidden : options.hidden) {
    if (IsHidden(hidden, frame)) AddPlate(placed[static_cast<size_t>(hidden.number - 1)], scene);
  }
  return scene;
}

// Frames whose pictures people look at: the first, those in the middle of what is hidden and after
// it, and the height of the cough.
bool IsKept(const MotionStudyOptions& options, int frame) {
  const MotionProfile& profile = options.profile;
  const double cough_s = profile.cough_start_s + 0.5 * profile.cough_length_s;
  bool kept = frame == 0 || frame == static_cast<int>(std::lround(cough_s * options.frames_per_s));
  for (const HiddenFrames& hidden : options.hidden)
    kept = kept || frame == (hidden.first + hidden.last) / 2 || frame == hidden.last + 1;
  return kept;
}

Json ToJson(const Detection& detection) {
  Json json = {{"marker", nullptr},
               {"centroid_px", {detection.centroid_px.x(), detection.centroid_px.y()}},
               {"centre_px", nullptr},
               {"straight_edges", detection.straight_edges},
               {"area_px", detection.area_px}};
  if (detection.marker) json["marker"] = *detection.marker;
  if (detection.centre_px) json["centre_px"] = {detection.centre_px->x(), detection.centre_px->y()};
  return json;
}

Vec2d PointOf(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>()};
}

Detection DetectionOf(const Json& json) {
  Detection detection;
  if (!json.at("marker").is_null()) detection.marker = json.at("marker").get<int>();
  detection.centroid_px = PointOf(json.at("centroid_px"));
  if (!json.at("centre_px").is_null()) detection.centre_px = PointOf(json.at("centre_px"));
  detection.straight_edges = json.at("straight_edges");
  detection.area_px = json.at("area_px");
  return detection;
}

// That this thread has worked, whatever else the machine does.
double ThreadTime_ms() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

Json RecordFrame(const MotionStudyOptions& options, int frame,
                 const std::filesystem::path& folder) {
  const Scene scene = SceneAt(options, frame);
  const RayScene rays(scene);
  const std::vector<PlacedMarker> placed = PlaceMarkers(scene);
  const Method method = MethodByName("robust");
  Json cameras = Json::array(), pictures = Json::array();
  for (const CameraSpec& camera : scene.cameras) {
    const double exposure_s = ExposureSeconds(scene, camera);
    const uint64_t seed = CombineKeys(options.shot.seed, static_cast<uint64_t>(frame));
    const Film film = RenderSparsely(scene, rays, placed, camera, exposure_s,
                                     options.shot.samples_per_pixel, seed);
    const std::string name = fmt::format("frame-{:03}_{}", frame, camera.model.name);
    const DigitalImage image =
        Sensor(camera).Expose(film.electrons, exposure_s, NoiseKey(options.shot.seed, name));
    const double start_ms = ThreadTime_ms();
    const std::vector<Detection> detections = method(image, *scene.marker_set, nullptr);
    const double identify_ms = ThreadTime_ms() - start_ms;
    Json found = Json::array();
    for (const Detection& detection : detections) found.push_back(ToJson(detection));
    cameras.push_back({{"detections", found}, {"identify_ms", identify_ms}});
    if (!IsKept(options, frame)) continue;
    pictures.push_back("pictures/" + name + ".png");
    WritePng(folder / pictures.back().get<std::string>(), image);
  }
  return {{"cameras", cameras}, {"pictures", pictures}};
}

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
      : options_(options), reference_(ReferenceScene(options)) {
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
      views.push_back(FollowedView(c, record.at("cameras").at(c).at("detections"), result));
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
  CameraView FollowedView(size_t camera, const Json& record, MotionFrame& frame) {
    CameraView view{reference_.cameras[camera].model, {}};
    for (const Json& detection : record) view.detections.push_back(DetectionOf(detection));
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
      [&](size_t task) { return RecordFrame(options, static_cast<int>(task), folder); }, progress,
      loop);
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
