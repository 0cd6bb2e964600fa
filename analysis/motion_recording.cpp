#include "analysis/motion_recording.h"

#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>

#include "classifier/method.h"
#include "core/hash.h"
#include "core/image_file.h"
#include "renderer/exposure.h"
#include "renderer/render_files.h"
#include "renderer/sensor.h"
#include "scenes/mesh_shapes.h"

namespace retrolux {

namespace {

using Json = nlohmann::json;

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
  Scene scene = MotionReferenceScene(options);
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

}  // namespace

Scene MotionReferenceScene(const MotionStudyOptions& options) {
  Scene scene = StereoScene({StereoTarget::kOval, options.psi_deg, 0}, options.shot);
  scene.objects.front().world_from_object = {};
  return scene;
}

Json RecordMotionFrame(const MotionStudyOptions& options, int frame,
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

std::vector<Detection> RecordedDetections(const Json& record, size_t camera) {
  std::vector<Detection> detections;
  for (const Json& detection : record.at("cameras").at(camera).at("detections"))
    detections.push_back(DetectionOf(detection));
  return detections;
}

}  // namespace retrolux
