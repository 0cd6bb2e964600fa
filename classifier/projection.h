// The projection of a camera with its slope, for fits to reprojection errors.
#pragma once

#include <optional>

#include "core/camera_model.h"

namespace retrolux {

struct Projection {
  Vec2d px;                            // distorted, as in the picture
  Eigen::Matrix<double, 2, 3> per_mm;  // d px / d x_in_world
};

// As CameraModel::Project; nothing where that gives nothing.
std::optional<Projection> ProjectWithSlope(const CameraModel& camera, const Vec3d& x_in_world);

}  // namespace retrolux
