#include "renderer/id_buffer.h"

#include <algorithm>
#include <cmath>

namespace retrolux {

PixelRect Crop(const CameraModel& camera, const std::vector<Vec3f>& points) {
  double left = camera.width, top = camera.height, right = -1.0, bottom = -1.0;
  for (const Vec3f& point : points) {
    const auto px = camera.Project(point.cast<double>());
    if (!px) return {0, 0, camera.width, camera.height};
    left = std::min(left, px->x());
    right = std::max(right, px->x());
    top = std::min(top, px->y());
    bottom = std::max(bottom, px->y());
  }
  PixelRect crop;
  crop.x0 = static_cast<int>(std::ceil(std::max(left, 0.0)));
  crop.y0 = static_cast<int>(std::ceil(std::max(top, 0.0)));
  crop.width =
      std::max(0, static_cast<int>(std::floor(std::min(right, camera.width - 1.0))) + 1 - crop.x0);
  crop.height = std::max(
      0, static_cast<int>(std::floor(std::min(bottom, camera.height - 1.0))) + 1 - crop.y0);
  return crop;
}

IdBuffer RenderIdBuffer(const RayScene& rays, const CameraModel& camera, const PixelRect& crop) {
  RETROLUX_CHECK(camera.distortion.IsNone(), "{}: a grid of rays is one without distortion",
                 camera.name);
  IdBuffer buffer{crop, IdPlane(crop.width, crop.height), FloatPlane(crop.width, crop.height)};
  const Mat3d world_from_camera = camera.camera_from_world.rotation.transpose();
  // Camera z = 1, so that the distance along a ray is the depth along the axis.
  const Vec3d first((crop.x0 - camera.cx) / camera.fx, (crop.y0 - camera.cy) / camera.fy, 1.0);
  RayScene::RayGrid grid;
  grid.origin = camera.Centre().cast<float>();
  grid.first = (world_from_camera * first).cast<float>();
  grid.step_x = (world_from_camera.col(0) / camera.fx).cast<float>();
  grid.step_y = (world_from_camera.col(1) / camera.fy).cast<float>();
  grid.width = crop.width;
  grid.height = crop.height;
  rays.IntersectGrid(grid, buffer.triangle.data, buffer.depth.data);
  return buffer;
}

}  // namespace retrolux
