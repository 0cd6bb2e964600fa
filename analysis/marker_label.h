// What is known of a marker in a labelled picture. docs/datasets.md defines each figure.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "analysis/rle.h"
#include "core/polygon.h"
#include "core/transform.h"

namespace retrolux {

// As COCO's keypoints.
enum class KeypointVisibility {
  kNone = 0,    // off the surface or outside the picture
  kHidden = 1,  // in the picture, but something is before it or it faces away
  kVisible = 2,
};

struct MarkerKeypoint {
  Vec3d in_marker = Vec3d::Zero();  // on the surface, mm
  std::optional<Vec2d> px;          // nothing if it is off the surface or behind the camera
  KeypointVisibility visibility = KeypointVisibility::kNone;
};

struct MarkerLabel {
  uint32_t instance = 0;  // as in id.marker
  std::string name;
  int number = 0;  // 0: the standard marker
  bool dark = false;
  std::vector<MarkerKeypoint> corners;  // of the shape, in the set's order; none of a disc
  std::optional<Vec2d> centroid_projected_px, centroid_outline_px, centroid_radiometric_px;
  double visible_fraction = 0.0;
  double incidence_deg = 0.0;
  double distance_mm = 0.0;
  bool in_frame = false;  // the whole outline
  double size_px = 0.0;   // long side of the smallest rectangle around the bright outline
  // Of the marker's inside and of what is around it, mean signal in e-, and their distance over
  // the noise; nothing where there are no such pixels.
  std::optional<double> signal_e, background_e, snr;
  RunLengths visible;  // pixels whose centres show its bright part
  RunLengths amodal;   // pixels whose centres lie in the projected bright outline, hidden or not
  RigidTransform camera_from_marker;

  nlohmann::json ToJson() const;
  static MarkerLabel FromJson(const nlohmann::json& json);
};

// The long side of the rectangle of least area around the points; 0 for less than three.
double LongSide(const Polygon& points);

// Pixels whose centres lie in the polygon (even-odd rule).
void FillPolygon(const Polygon& polygon, MaskPlane& mask);

}  // namespace retrolux
