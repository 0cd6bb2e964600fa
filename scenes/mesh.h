// Triangle meshes and the queries on their surface.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/conventions.h"

namespace retrolux {

// Counter-clockwise seen from outside. `normals` are unit vectors at the vertices, as many as
// positions, or none: then the surface is flat-shaded. `uvs` likewise: texture coordinates
// (materials/texture.h), as many as positions or none.
struct TriangleMesh {
  std::vector<Vec3f> positions;  // mm
  std::vector<Vec3f> normals;
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<Vec2f> uvs = {};

  double Area() const;   // mm2
  size_t Bytes() const;  // of memory
  void Append(const TriangleMesh& other);
};

// Of a file or of a scene: more are of no use to anyone, and would be a way to take all memory.
inline constexpr size_t kMaxTriangles = 20'000'000;

// Unit normals at the corners of each triangle. Those of the vertices where the mesh has them, else
// the mean of the triangles around the corner, weighted by their angles there; in both cases only
// what lies within `crease_deg` of the triangle's own normal counts, so that edges stay edges.
std::vector<std::array<Vec3f, 3>> CornerNormals(const TriangleMesh& mesh, double crease_deg = 40.0);

struct SurfacePoint {
  Vec3d position;
  Vec3d normal;  // unit, interpolated where the mesh has vertex normals
  uint32_t triangle = 0;
};

// The point of the surface nearest to x. The mesh must have a triangle.
SurfacePoint NearestSurfacePoint(const TriangleMesh& mesh, const Vec3d& x);

}  // namespace retrolux
