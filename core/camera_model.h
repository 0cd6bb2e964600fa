// The geometry of a camera: where a point of the world falls in the picture, and the ray of a
// pixel.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/conventions.h"
#include "core/distortion.h"
#include "core/transform.h"

namespace retrolux {

struct Ray {
  Vec3d origin;
  Vec3d direction;  // unit
};

// A camera in OpenCV's convention: camera x right, y down, z forward; pixel (0, 0) is the centre of
// the top-left pixel, so u = fx x_d + cx with cx = (width - 1) / 2 for a centred lens, where (x_d,
// y_d) is (x/z, y/z) after the lens's distortion. The geometry is that of the chief rays, which
// pass the lens's centre.
struct CameraModel {
  std::string name;
  int width = 640;
  int height = 480;
  double fx = 1.0, fy = 1.0;  // px
  double cx = 0.0, cy = 0.0;  // px
  Distortion distortion;
  RigidTransform camera_from_world;

  // The full angles of the field of view along the two axes of the picture.
  static CameraModel FromFieldOfView(std::string name, int width, int height, double horizontal_deg,
                                     double vertical_deg, const RigidTransform& camera_from_world);

  Vec3d Centre() const { return camera_from_world.Inverse().translation; }
  Vec3d Forward() const { return camera_from_world.rotation.row(2).transpose(); }

  // Pixel coordinates; nothing for a point beside or behind the camera (camera z <= 0), or so far
  // off the axis that the distorted lens brings it nowhere.
  std::optional<Vec2d> Project(const Vec3d& x_in_world) const;
  // The point of the plane z = 1 of the camera frame that falls on a pixel; nothing where the
  // distorted lens brings no light. CheckScene sees to it that this is nowhere in the picture.
  std::optional<Vec2d> PlanePoint(const Vec2d& px) const;
  // The chief ray of a pixel, which must have one.
  Ray RayThrough(const Vec2d& px) const;
  // Whether the pixel coordinates lie inside the picture, half a pixel around the outer centres
  // included.
  bool InFrame(const Vec2d& px) const;
  // The same lens and field of view on another number of pixels. Non-square factors are allowed.
  CameraModel Resized(int new_width, int new_height) const;
};

// cameras.yml in the form of OpenCV's FileStorage; see docs/file-formats.md.
std::string CamerasYaml(const std::vector<CameraModel>& cameras);

}  // namespace retrolux
