// How the triangles of a mesh hang together: its edges and its connected pieces.
#pragma once

#include "scenes/mesh.h"

namespace retrolux {

// An edge between two places of the welded mesh, from < to, and how many triangles run along it in
// each direction. Two neighbours that are wound alike run along it once in each.
struct MeshEdge {
  uint32_t from = 0, to = 0;
  int forward = 0, backward = 0;

  bool IsBoundary() const { return forward + backward == 1; }
  bool IsManifold() const { return forward + backward <= 2; }
  bool IsConsistent() const { return !IsManifold() || (forward <= 1 && backward <= 1); }
};

// Triangles that are connected through common places.
struct MeshPiece {
  std::vector<uint32_t> triangles;
  double area_mm2 = 0.0;
  // Volume that the piece encloses once each of its boundary loops is closed by a cone from the
  // loop's centroid. Positive: counter-clockwise seen from outside.
  double capped_volume_mm3 = 0.0;
  bool is_consistent = true;  // its edges are

  // Whether it is wound clockwise seen from outside: its capped volume is negative. Nothing is said
  // of pieces that are wound inconsistently, or as flat as a sheet (a volume below 1e-3 of the
  // area^(3/2); half a sphere has 0.13), of which no side is outside.
  std::optional<bool> IsInsideOut() const;
};

struct MeshTopology {
  std::vector<uint32_t> place;  // of each vertex; places are numbered from 0
  size_t places = 0;
  std::vector<MeshEdge> edges;
  size_t boundary_loops = 0;  // two that touch in a vertex count as one
  std::vector<MeshPiece> pieces;
};

// Vertices within `tolerance_mm` of an earlier one are at the same place as it. Triangles of which
// two corners are at the same place take no part.
MeshTopology TopologyOf(const TriangleMesh& mesh, double tolerance_mm);

// Turns every piece that is inside out.
void OrientOutwards(TriangleMesh& mesh);

}  // namespace retrolux
