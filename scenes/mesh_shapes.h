// Meshes of simple shapes, all counter-clockwise seen from outside (or from inside where it says
// so).
#pragma once

#include <vector>

#include "scenes/mesh.h"

namespace retrolux {

// Ellipsoid about the origin: an icosahedron subdivided `levels` times (20 * 4^levels triangles),
// vertices and vertex normals exact. At level 5 the surface of the oval lies less than 0.03 mm
// inside the true one.
TriangleMesh EllipsoidMesh(const Vec3d& semi_axes, int levels);

TriangleMesh BoxMesh(const Vec3d& min_corner, const Vec3d& max_corner);

// The inside of a box: a room.
TriangleMesh InvertedBoxMesh(const Vec3d& min_corner, const Vec3d& max_corner);

TriangleMesh RectangleMesh(const Vec3d& corner, const Vec3d& edge_u, const Vec3d& edge_v);

// The surface that (radius, z) points describe when turned about the z axis, seen from the axis: a
// bore. Smooth around the axis, creased between the points. z must ascend.
TriangleMesh BoreMesh(const std::vector<Vec2d>& radius_and_z, int segments);

// The rectangle [min, max] in (x, y) at height z with a round hole about the z axis, facing +z or
// -z.
TriangleMesh PlateWithHoleMesh(const Vec2d& min_xy, const Vec2d& max_xy, double z,
                               double hole_radius, int segments, bool faces_up);

}  // namespace retrolux
