// Rigid transforms, named b_from_a: x_in_b = b_from_a * x_in_a.
#pragma once

#include "core/conventions.h"

namespace retrolux {

struct RigidTransform {
  Mat3d rotation = Mat3d::Identity();
  Vec3d translation = Vec3d::Zero();  // mm

  Vec3d operator*(const Vec3d& x) const { return rotation * x + translation; }

  // c_from_b * b_from_a = c_from_a
  RigidTransform operator*(const RigidTransform& other) const {
    return {rotation * other.rotation, rotation * other.translation + translation};
  }

  RigidTransform Inverse() const {
    return {rotation.transpose(), -(rotation.transpose() * translation)};
  }
};

// camera_from_world of a camera at `eye` that looks at `target` with the world direction `up`
// upwards in the picture (camera y down). `up` must not be parallel to the line of sight.
inline RigidTransform LookAt(const Vec3d& eye, const Vec3d& target, const Vec3d& up) {
  const Vec3d forward = (target - eye).normalized();
  const Vec3d right = forward.cross(up).normalized();
  Mat3d rotation;
  rotation.row(0) = right;
  rotation.row(1) = forward.cross(right);
  rotation.row(2) = forward;
  return {rotation, -(rotation * eye)};
}

}  // namespace retrolux
