// Which pixels of a picture have to be traced, and which may be interpolated (sparse_film.h).
#pragma once

#include "renderer/id_pass.h"

namespace retrolux {

// kGrid: a smooth matt surface, or nothing. kTraced: glossy, textured or perforated, or at the edge
// of something. kMarker: on a marker, or at its edge.
enum class Need : uint8_t { kGrid, kTraced, kMarker };

// `ids` of the same scene and camera. Edges are as wide as the lens blurs anything in the picture.
Plane<Need> NeedsOf(const Scene& scene, const CameraSpec& camera, const IdBuffers& ids);

}  // namespace retrolux
