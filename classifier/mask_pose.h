// Where a mask is, from its markers.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "classifier/registration.h"

namespace retrolux {

struct MaskPose {
  RigidTransform world_from_mask;
  std::vector<PointPair> pairs;      // that it rests on; a: mask, b: world
  std::vector<double> residuals_mm;  // distances that it leaves, of all pairs given
  std::vector<bool> used;            // by pair given
  double fre_mm = 0.0;               // of the used pairs
  double fle_mm = 0.0;               // of a marker, from the FRE

  // Expected error of a point of the mask, root of the mean square, mm.
  double Tre_mm(const Vec3d& x_in_mask) const;
};

// A pose, or why there is none.
struct PoseEstimate {
  std::optional<MaskPose> pose;
  std::string refusal;
};

// Registration of all pairs; while one of them lies further off than `max_residual_mm`, the pair
// without which the rest fits best is left out. No pose without at least three that fit and do not
// lie on a line; three always fit in part, so a wrong one is told from four markers on.
PoseEstimate EstimatePose(std::span<const PointPair> pairs, double max_residual_mm);

}  // namespace retrolux
