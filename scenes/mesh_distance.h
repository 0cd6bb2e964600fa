// How far one surface is from another.
#pragma once

#include <vector>

#include "scenes/mesh.h"

namespace retrolux {

struct DistanceSummary {
  size_t samples = 0;
  double mean_mm = 0.0, rms_mm = 0.0, percentile95_mm = 0.0, max_mm = 0.0;
};

// Distances of the vertices and of the triangles' centres of `from` to the nearest points of `to`.
// Both must have triangles. Not symmetric: `from` may be a part of `to`; look both ways.
DistanceSummary DistanceBetween(const TriangleMesh& from, const TriangleMesh& to);

}  // namespace retrolux
