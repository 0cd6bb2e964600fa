#include "classifier/projection.h"

namespace retrolux {

std::optional<Projection> ProjectWithSlope(const CameraModel& camera, const Vec3d& x_in_world) {
  const std::optional<Vec2d> px = camera.Project(x_in_world);
  if (!px) return std::nullopt;
  const Vec3d x = camera.camera_from_world * x_in_world;
  const Vec2d ideal = x.head<2>() / x.z();
  Eigen::Matrix<double, 2, 3> ideal_per_mm;
  ideal_per_mm << 1.0, 0.0, -ideal.x(), 0.0, 1.0, -ideal.y();
  ideal_per_mm /= x.z();
  const Eigen::Matrix2d lens =
      Vec2d(camera.fx, camera.fy).asDiagonal() * camera.distortion.Jacobian(ideal);
  return Projection{*px, lens * ideal_per_mm * camera.camera_from_world.rotation};
}

}  // namespace retrolux
