// Meshes of smooth surfaces over a grid of parameters, mirror symmetric in y.
#pragma once

#include <functional>

#include "scenes/mesh.h"

namespace retrolux {

// A surface over two parameters: a point in mm, smooth, also a little beyond the grid's edge. It
// must be its own mirror image, Surface(-u, v) = Surface(u, v) with y negated, and (d/du) x (d/dv)
// must point outwards.
using Surface = std::function<Vec3d(const Vec2d& uv)>;

// The parameters of the grid point (column, row), given where it lies on the unit square
// [-1, 1] x [-1, 1]. Odd in the first coordinate.
using GridMap = std::function<Vec2d(const Vec2d& place)>;

// rows x columns vertices, columns odd: the middle one lies in the plane y = 0. The columns beyond
// it are the exact mirror image of the others. Normals are those of the surface, not of the
// triangles. Each cell is cut along the diagonal that points to the middle of the grid, so that a
// corner of the grid that the map flattens to 180 degrees gives no degenerate triangle.
TriangleMesh SymmetricGridMesh(int rows, int columns, const GridMap& map, const Surface& surface);

}  // namespace retrolux
