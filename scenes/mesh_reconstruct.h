// A surface through a cloud of points, by CGAL.
//
// Two steps: each point is moved onto a quadric fitted to its neighbours (jet smoothing; Cazals and
// Pouget, "Estimating differential quantities using polynomial fitting of osculating jets", 2005),
// which takes out the scanner's noise; then triangles grow over the points from a seed (advancing
// front; Cohen-Steiner and Da, "A greedy Delaunay-based surface reconstruction algorithm", 2004),
// which leaves an open shell open. This is what CGAL's scale-space reconstruction (Digne et al.
// 2011) does with these two parts, but the triangles are given at the smoothed points.
#pragma once

#include <vector>

#include "scenes/mesh.h"

namespace retrolux {

struct ReconstructOptions {
  // Radius of the neighbourhood to which quadrics are fitted, mm; about sqrt(number of neighbours)
  // less noise, but features of that radius are lost. 0: 4 times the spacing of the points.
  double smoothing_scale_mm = 0.0;
  int smoothing_iterations = 1;  // 0: the points as they are, for clouds without noise
  // Longest edge of a triangle, mm: wider gaps stay open. 0: 6 times the spacing.
  double max_edge_mm = 0.0;

  // InputError that names the option as on the command line.
  void Check() const;
};

struct Reconstruction {
  TriangleMesh mesh;         // outwards by the rule of mesh_topology.h, with smooth normals
  double spacing_mm = 0.0;   // mean distance of a point to its six nearest neighbours
  size_t neighbours = 0;     // that the quadrics were fitted to; 0 without smoothing
  double max_edge_mm = 0.0;  // as used
};

// The points must be finite. InputError for fewer than 12 different points, and if no triangle
// comes out. The same points give the same mesh.
Reconstruction ReconstructSurface(const std::vector<Vec3f>& points,
                                  const ReconstructOptions& options = {});

}  // namespace retrolux
