// The id pass in bulk: which triangle of one mesh each pixel's centre shows, only where the mesh
// can be. What RenderIds (id_pass.h) says of a whole scene, without what a search does not need.
#pragma once

#include "core/camera_model.h"
#include "core/plane.h"
#include "renderer/ray_scene.h"

namespace retrolux {

// Pixels [x0, x0 + width) x [y0, y0 + height).
struct PixelRect {
  int x0 = 0, y0 = 0, width = 0, height = 0;
};

// The pixels of the picture whose centres the points can lie on or surround; all of it if one lies
// beside or behind the camera.
PixelRect Crop(const CameraModel& camera, const std::vector<Vec3f>& points);

struct IdBuffer {
  PixelRect crop;
  IdPlane triangle;  // from 0; kNone where the mesh is not
  FloatPlane depth;  // mm along the camera's axis, infinite there
  static constexpr uint32_t kNone = RayScene::PacketHit::kNone;
};

// `rays` must hold one object, in the frame that `camera.camera_from_world` starts from. One
// thread.
IdBuffer RenderIdBuffer(const RayScene& rays, const CameraModel& camera, const PixelRect& crop);

}  // namespace retrolux
