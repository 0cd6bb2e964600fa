// A folder that `retrolux render` wrote, or one like it, reconstructed: cameras.yml, a picture
// NAME.png of each camera or a file of detections, and truth.json where the pictures are rendered.
#pragma once

#include <filesystem>
#include <string>

#include "classifier/stereo.h"

namespace retrolux {

struct StereoFolderOptions {
  std::filesystem::path folder;
  std::string method = "robust";        // where no detections are there
  std::filesystem::path detections;     // empty: detections.json of the folder if it has one
  std::filesystem::path constellation;  // empty: the true places where there is truth.json
  StereoOptions stereo;
};

// A marker as truth.json has it.
struct TrueMarker {
  std::string name;
  int number = 0;
  Vec3d at = Vec3d::Zero();  // the middle of its shape's area on its tangent plane, world, mm
  Vec3d normal = Vec3d::UnitZ();
};

// What is wrong with a pose, at the mask's origin (the isocentre).
struct PoseError {
  Vec3d translation_mm = Vec3d::Zero();
  double rotation_deg = 0.0;
};

struct StereoFolder {
  std::vector<CameraView> views;
  std::string detections_from;  // "method robust", or the file
  Constellation constellation;
  std::string constellation_from;  // "truth.json", the file, or "none"
  std::vector<TrueMarker> truth;   // empty without truth.json
  StereoResult result;
  std::vector<std::optional<size_t>> truth_of;  // by marker of the result
  std::optional<PoseError> pose_error;

  // Found minus true place of a marker of the result, world, mm; nothing if either is not known.
  std::optional<Vec3d> Error_mm(size_t marker) const;
};

// The true markers of a shot. Of a curved surface the middle of a shape that is not in the middle
// of its square lies below the tangent plane: 0.04 mm for the triangle on a radius of 100 mm.
std::vector<TrueMarker> ReadTruth(const std::filesystem::path& truth_json,
                                  const std::vector<CameraModel>& cameras);

// The true places as a constellation, in the world's frame.
Constellation ConstellationOf(const std::vector<TrueMarker>& truth);

PoseError ErrorOf(const RigidTransform& found, const RigidTransform& truth);

// InputError for what is missing or wrong in the folder.
StereoFolder ReconstructFolder(const StereoFolderOptions& options);

}  // namespace retrolux
