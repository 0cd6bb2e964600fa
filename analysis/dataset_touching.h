// Where a marker has to lie to touch another one.
#pragma once

#include "scenes/scene.h"

namespace retrolux {

// The place on the mesh, from the marker `there` in the direction of `angle_rad` in its plane
// (counter-clockwise from its x), at which the outline of `marker` just touches its: in the plane
// of `there`, to within 0.1 mm.
SurfacePoint TouchingPlace(const TriangleMesh& mesh, const MarkerSpec& there,
                           const MarkerSpec& marker, double angle_rad);

}  // namespace retrolux
