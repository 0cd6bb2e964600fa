// Markers in space from what several cameras see of them, and the mask's pose from the markers.
//
// 1. Markers that identify themselves: a number that a picture holds once (and the constellation
//    at most once) is the same marker in all pictures (triangulation.h).
// 2. Three of them that the constellation knows give the mask's pose (mask_pose.h).
// 3. The pose says where all other markers are, which names what is there (position_names.h):
//    standard markers, and identifiable ones that a camera could not name.
// 4. All are triangulated, and the pose is estimated again from all.
#pragma once

#include <map>

#include "classifier/mask_pose.h"
#include "classifier/position_names.h"
#include "classifier/triangulation.h"

namespace retrolux {

struct StereoOptions {
  MarkerPoint point = MarkerPoint::kCentre;
  // Noise of a detection, 1 sigma in each of u and v, px; times RelativeSigma (marker_point.h).
  // Scales the covariances, and with them nothing but the gates of names by position.
  double sigma_px = 0.03;
  TriangulationOptions triangulation;
  PositionOptions position;  // its `point` is the one above
  // Of a marker from where the constellation has it, once the mask is registered, mm. Larger lets
  // a misnamed marker pull the pose.
  double max_residual_mm = 3.0;
};

struct CameraView {
  CameraModel camera;
  std::vector<Detection> detections;
};

struct StereoSighting {
  size_t view = 0, detection = 0;
  bool by_position = false;  // named by the constellation, not by its shape
  bool used = false;         // false: an outlier, or the marker was refused
  Vec2d residual_px = Vec2d::Zero();
};

struct StereoMarker {
  std::string name;             // the constellation's, else "marker-N"
  int number = 0;               // 0: standard
  std::optional<size_t> known;  // in the constellation
  std::vector<StereoSighting> sightings;
  std::optional<TriangulatedPoint> point;
  std::string refusal;  // why there is no point; "seen by one camera"
};

struct StereoResult {
  std::vector<StereoMarker> markers;  // the constellation's in its order, then others by number
  std::optional<MaskPose> pose;
  std::string pose_refusal;
  std::vector<size_t> pose_markers;  // of `markers`, those that pose->used is about
  // Names by position that were refused because they could have been others: view, marker's name.
  std::vector<std::pair<size_t, std::string>> ambiguous;
};

// `constellation` may be empty: then there is no pose, and only identified markers are found.
// InputError where the cameras cannot triangulate at all (parallel rays).
StereoResult Reconstruct(const std::vector<CameraView>& views, const Constellation& constellation,
                         const StereoOptions& options);

}  // namespace retrolux
