#include "analysis/stereo_folder.h"

#include <algorithm>

#include "classifier/camera_file.h"
#include "classifier/detections_json.h"
#include "classifier/method.h"
#include "core/image_file.h"
#include "core/json_reader.h"
#include "core/parallel.h"

namespace retrolux {

namespace {

namespace fs = std::filesystem;

int NumberOf(const JsonReader& marker) {
  if (marker.IsString()) return 0;
  return DefaultMarkerSet().ByNumber(static_cast<int>(marker.AsNumber(0, 1000))).number;
}

RigidTransform PoseOf(JsonReader& marker) {
  const std::vector<double> r = marker.Child("R_camera_from_marker").Numbers(9);
  RigidTransform pose;
  pose.rotation << r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8];
  pose.translation = marker.Vector3("t_camera_from_marker_mm");
  return pose;
}

// The pictures through the method, in the order of the cameras.
void FindMarkers(const StereoFolderOptions& options, std::vector<CameraView>& views) {
  const Method method = MethodByName(options.method);
  std::vector<fs::path> pictures;
  for (const CameraView& view : views) {
    pictures.push_back(options.folder / (view.camera.name + ".png"));
    if (!fs::is_regular_file(pictures.back())) {
      throw InputError::At(pictures.back(), "", "no such file",
                           "the picture of each camera of cameras.yml, or --detections FILE");
    }
  }
  // One after the other, so that of several wrong pictures the first is named.
  std::vector<DigitalImage> images;
  for (size_t i = 0; i < views.size(); ++i) {
    images.push_back(ReadGrey(pictures[i]));
    const CameraModel& camera = views[i].camera;
    const auto& dn = images.back().dn;
    if (dn.width != camera.width || dn.height != camera.height) {
      throw InputError::At(pictures[i], "", fmt::format("{} x {} px", dn.width, dn.height),
                           fmt::format("{} x {} as in cameras.yml", camera.width, camera.height));
    }
  }
  ParallelFor(static_cast<int64_t>(views.size()), [&](int64_t index) {
    const auto i = static_cast<size_t>(index);
    views[i].detections = method(images[i], DefaultMarkerSet(), nullptr);
  });
}

void TakeDetections(const fs::path& file, std::vector<CameraView>& views) {
  std::vector<std::string> names;
  for (const CameraView& view : views) names.push_back(view.camera.name);
  std::vector<bool> taken(views.size(), false);
  for (PictureDetections& picture : ReadDetections(file, DefaultMarkerSet()).pictures) {
    const auto name = std::find(names.begin(), names.end(), picture.camera);
    if (name == names.end()) {
      throw InputError::At(file, picture.file, fmt::format("camera '{}'", picture.camera),
                           fmt::format("one of {}", JoinNames(names)));
    }
    const auto i = static_cast<size_t>(name - names.begin());
    if (taken[i]) {
      throw InputError::At(file, picture.file, fmt::format("a second picture of '{}'", *name),
                           "one of each camera");
    }
    taken[i] = true;
    views[i].detections = std::move(picture.detections);
  }
}

void ReadDetectionsOf(const StereoFolderOptions& options, StereoFolder& folder) {
  fs::path file = options.detections;
  if (file.empty() && fs::is_regular_file(options.folder / "detections.json"))
    file = options.folder / "detections.json";
  if (file.empty()) {
    FindMarkers(options, folder.views);
    folder.detections_from = "method " + options.method;
  } else {
    TakeDetections(file, folder.views);
    folder.detections_from = file.filename().string();
  }
}

std::optional<size_t> TruthOf(const StereoMarker& marker, const std::vector<TrueMarker>& truth) {
  std::vector<size_t> same_number;
  for (size_t i = 0; i < truth.size(); ++i) {
    if (truth[i].name == marker.name && truth[i].number == marker.number) return i;
    if (truth[i].number == marker.number) same_number.push_back(i);
  }
  if (marker.number == 0 || same_number.size() != 1) return std::nullopt;
  return same_number.front();
}

// Of the mask: of the constellation onto the true places of its markers.
std::optional<RigidTransform> TruePose(const StereoFolder& folder) {
  std::vector<PointPair> pairs;
  for (size_t m = 0; m < folder.result.markers.size(); ++m) {
    const auto& known = folder.result.markers[m].known;
    if (known && folder.truth_of[m])
      pairs.push_back({folder.constellation[*known].at, folder.truth[*folder.truth_of[m]].at});
  }
  if (RegistrationFault(pairs)) return std::nullopt;
  return RegisterPoints(pairs).b_from_a;
}

}  // namespace

std::optional<Vec3d> StereoFolder::Error_mm(size_t marker) const {
  const auto& point = result.markers[marker].point;
  if (!point || !truth_of[marker]) return std::nullopt;
  return Vec3d(point->position - truth[*truth_of[marker]].at);
}

std::vector<TrueMarker> ReadTruth(const fs::path& truth_json,
                                  const std::vector<CameraModel>& cameras) {
  JsonReader json = JsonReader::FromFile(truth_json);
  json.Schema("retrolux/truth-1");
  const CameraModel& camera = cameras.front();
  const JsonReader markers = json.Child("cameras").Child(camera.name).Child("markers");
  std::vector<TrueMarker> truth;
  for (size_t i = 0; i < markers.Size(); ++i) {
    JsonReader marker = markers.Child(i);
    const RigidTransform world_from_marker = camera.camera_from_world.Inverse() * PoseOf(marker);
    const int number = NumberOf(marker.Child("marker"));
    const Vec3d centre = ShapeCentre(DefaultMarkerSet().ByNumber(number));
    truth.push_back({marker.String("name"), number, world_from_marker * centre,
                     world_from_marker.rotation.col(2)});
  }
  return truth;
}

Constellation ConstellationOf(const std::vector<TrueMarker>& truth) {
  Constellation constellation;
  for (const TrueMarker& marker : truth)
    constellation.push_back({marker.name, marker.number, marker.at, marker.normal});
  return constellation;
}

PoseError ErrorOf(const RigidTransform& found, const RigidTransform& truth) {
  return {found.translation - truth.translation,
          DegFromRad(RotationAngle(found.rotation * truth.rotation.transpose()))};
}

StereoFolder ReconstructFolder(const StereoFolderOptions& options) {
  StereoFolder folder;
  std::vector<CameraModel> cameras = ReadCameras(options.folder / "cameras.yml");
  const fs::path truth_json = options.folder / "truth.json";
  if (fs::is_regular_file(truth_json)) folder.truth = ReadTruth(truth_json, cameras);
  if (!options.constellation.empty()) {
    folder.constellation = ReadConstellation(options.constellation, DefaultMarkerSet());
    folder.constellation_from = options.constellation.filename().string();
  } else {
    folder.constellation = ConstellationOf(folder.truth);
    folder.constellation_from = folder.truth.empty() ? "none" : "truth.json";
  }
  for (CameraModel& camera : cameras) folder.views.push_back({std::move(camera), {}});
  if (folder.views.size() < 2) {
    throw InputError::At(options.folder / "cameras.yml", "cameras", "one",
                         "at least two to reconstruct");
  }
  ReadDetectionsOf(options, folder);
  folder.result = Reconstruct(folder.views, folder.constellation, options.stereo);
  for (const StereoMarker& marker : folder.result.markers)
    folder.truth_of.push_back(TruthOf(marker, folder.truth));
  if (folder.result.pose) {
    if (const auto truth = TruePose(folder))
      folder.pose_error = ErrorOf(folder.result.pose->world_from_mask, *truth);
  }
  return folder;
}

}  // namespace retrolux
