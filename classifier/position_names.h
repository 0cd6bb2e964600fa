// Names by position: once identified markers say where the mask is, its other markers (standard
// ones, and those whose shape could not be told) are where the constellation has them.
#pragma once

#include <functional>
#include <vector>

#include "classifier/constellation.h"
#include "classifier/marker_point.h"
#include "core/camera_model.h"

namespace retrolux {

struct PositionOptions {
  MarkerPoint point = MarkerPoint::kCentre;
  // 1 sigma of what lies between predicted and seen point beside the error of the pose: noise,
  // falling light, calibration.
  double sigma_px = 0.4;
  // A detection belongs to a marker within this many standard deviations; 3.72 holds 99.9 % of the
  // right ones (two normal components). Larger names more and refuses more as ambiguous.
  double gate_sigma = 3.72;
  double max_incidence_deg = 85.0;  // of markers whose normal is known
};

struct PositionName {
  size_t marker = 0;     // of the constellation
  size_t detection = 0;  // of the picture
  double distance_px = 0.0;
  double gate_px = 0.0;  // in that direction
};

struct PositionNames {
  std::vector<PositionName> named;
  // Markers that could be several detections, or whose detection could be several markers: refused.
  std::vector<size_t> ambiguous;
};

// `wanted` (by marker) and `free` (by detection) say what is still without a partner. `sigma_mm`:
// how well the pose places a point of the mask, root of the expected squared distance. A detection
// with another marker's name is never taken, nor one without a name that is much larger (or, if the
// marker's normal is known, smaller) than the marker can be.
PositionNames NameByPosition(const CameraModel& camera, const std::vector<Detection>& detections,
                             const std::vector<bool>& free, const Constellation& constellation,
                             const std::vector<bool>& wanted, const RigidTransform& world_from_mask,
                             const std::function<double(const Vec3d& x_in_mask)>& sigma_mm,
                             const PositionOptions& options);

}  // namespace retrolux
