// Which pixels need more samples than others, found before any of them is taken: so more samples
// there make the picture better without a bias, and the same picture comes every time.
#pragma once

#include "core/camera_model.h"
#include "renderer/id_pass.h"

namespace retrolux {

// 1 where a surface, or what lies on it, begins or ends within the 3 x 3 pixels around: objects or
// markers differ, or one surface hides another part of itself (a neighbour's point lies farther off
// the tangent plane than a pixel is wide there). 0 elsewhere. By the pixel centres, through a
// pinhole: things between them, shadows, and what a thin lens blurs are not seen.
Plane<uint8_t> EdgePixels(const IdBuffers& ids, const CameraModel& camera);

}  // namespace retrolux
