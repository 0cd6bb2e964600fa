// What each pixel's centre shows: one unfiltered ray a pixel, in packets.
#pragma once

#include "core/plane.h"
#include "renderer/ray_scene.h"
#include "scenes/marker_placement.h"

namespace retrolux {

// All ids 1-based, 0 = none. Objects first, then rings ("ring-NAME") and "panels"
// (RayScene::BodyNames).
struct IdBuffers {
  IdPlane object;
  IdPlane triangle;                    // within its object
  IdPlane marker;                      // instance; bright part only
  FloatPlane depth;                    // mm along the camera's axis; 0 where nothing is
  std::array<FloatPlane, 3> position;  // world, mm
  std::array<FloatPlane, 3> normal;    // world, shading normal
};

IdBuffers RenderIds(const RayScene& rays, const CameraModel& camera,
                    const std::vector<PlacedMarker>& markers);

}  // namespace retrolux
