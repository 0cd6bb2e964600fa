// One vertex where a file gives several at the same place, and normals for meshes that have none.
#pragma once

#include "scenes/mesh.h"

namespace retrolux {

// The same surface; vertices that agree in every bit of position and normal become one, those that
// no triangle uses are left out. The order of what stays is kept.
TriangleMesh WeldedExactly(const TriangleMesh& mesh);

// The same surface with one vertex at each place and smooth normals: the mean of the adjoining
// triangles' normals, weighted with their angles at the vertex (Thuermer and Wuethrich, "Computing
// vertex normals from polygonal facets", 1998), so that the cut into triangles does not matter.
TriangleMesh WithSmoothNormals(const TriangleMesh& mesh);

}  // namespace retrolux
