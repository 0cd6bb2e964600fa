// What the study of visible areas looks at, and how it is turned.
#pragma once

#include <cstdint>

#include "scenes/mesh.h"

namespace retrolux {

// A rotation, all equally likely, that belongs to the key.
Mat3d RandomRotation(uint64_t key);

// A flat disc about the origin that faces +z, 6 rings^2 triangles of about one size. Its edge is a
// polygon of 6 rings corners as large as the circle of that radius, so that the area is exact.
TriangleMesh DiscMesh(double radius, int rings);

// The same surface with its other side.
TriangleMesh WithBack(TriangleMesh mesh);

}  // namespace retrolux
