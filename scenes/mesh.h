// Triangle meshes and the queries on their surface.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/conventions.h"

namespace retrolux {

// Counter-clockwise seen from outside. `normals` are unit vectors at the vertices, as many as
// positions, or none: then the surface is flat-shaded.
struct TriangleMesh {
  std::vector<Vec3f> positions;  // mm
  std::vector<Vec3f> normals;
  std::vector<std::array<uint32_t, 3>> triangles;

  double Area() const;  // mm2
  void Append(const TriangleMesh& other);
};

struct SurfacePoint {
  Vec3d position;
  Vec3d normal;  // unit, interpolated where the mesh has vertex normals
  uint32_t triangle = 0;
};

// The point of the surface nearest to x. The mesh must have a triangle.
SurfacePoint NearestSurfacePoint(const TriangleMesh& mesh, const Vec3d& x);

}  // namespace retrolux
