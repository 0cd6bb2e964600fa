// What may be wrong with a mesh that a user brings, in numbers and in words.
#pragma once

#include <string>
#include <vector>

#include "scenes/mesh.h"

namespace retrolux {

// Counts are of the mesh with its vertices welded within 1e-4 of its size (the diagonal of its
// bounding box), so that seams of normals or of STL's loose triangles are not taken for holes.
struct MeshFindings {
  size_t vertices = 0, triangles = 0;
  Vec3d min_corner = Vec3d::Zero(), max_corner = Vec3d::Zero();  // mm
  double area_mm2 = 0.0;
  size_t pieces = 0;
  size_t boundary_edges = 0;
  size_t holes = 0;               // boundary loops: an open shell has one, a closed surface none
  size_t non_manifold_edges = 0;  // of three triangles or more
  size_t inconsistent_edges = 0;  // whose two triangles are wound against each other
  // By the rule of MeshPiece::IsInsideOut: the volume after closing the holes is negative.
  size_t inside_out_pieces = 0;
  size_t opposed_normals = 0;     // triangles against which the mean of their vertex normals points
  size_t duplicate_vertices = 0;  // with the place and, within a degree, the normal of another
  size_t degenerate_triangles = 0;  // with an area below 1e-6 of the longest edge squared

  double LargestExtent_mm() const { return (max_corner - min_corner).maxCoeff(); }
};

// The mesh must have a triangle.
MeshFindings CheckMesh(const TriangleMesh& mesh);

// Sizes that a mask can have, mm.
inline constexpr double kSmallestMask_mm = 50.0;
inline constexpr double kLargestMask_mm = 2500.0;

// A line for each finding that a mask should not have: what, how many, and what to do.
std::vector<std::string> Warnings(const MeshFindings& findings);

}  // namespace retrolux
