// Points spread over a mesh by area, so that areas of any part of it are sums over points.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/mesh.h"

namespace retrolux {

// Every triangle is cut into k x k congruent parts, k the least that makes them no larger than
// `part_area_mm2`, and each part holds one random point: stratified, and unbiased for any region
// of the mesh. All arrays are as long as there are points; those of one triangle lie together.
struct SurfaceSamples {
  // Lifted from the triangle onto the smooth surface that the corner normals imply, where that is
  // outside: a facet lies up to edge^2 / 8R inside a round surface, and at its limb that matters.
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;  // unit, interpolated between the corners (CornerNormals)
  std::vector<uint32_t> triangles;
  std::vector<float> areas_mm2;  // of the part that the point stands for
  double area_mm2 = 0.0;         // of the mesh

  size_t Size() const { return positions.size(); }
};

SurfaceSamples SampleSurface(const TriangleMesh& mesh, double part_area_mm2, uint64_t seed);

// One point in the middle of each triangle, flat: the thesis's resolution (algorithm 4.5.4).
SurfaceSamples TriangleCentres(const TriangleMesh& mesh);

}  // namespace retrolux
