// Point clouds as a scanner would give them: made from a mesh, written to files.
#pragma once

#include <filesystem>
#include <vector>

#include "scenes/mesh.h"

namespace retrolux {

// `count` points on the surface, evenly by area (one at random in each of `count` equal parts of
// the area, taken in the order of the triangles), each shifted by Gaussian noise of `noise_mm`
// (1 sigma) along every axis. The same seed gives the same points.
std::vector<Vec3f> SampleSurface(const TriangleMesh& mesh, int count, double noise_mm,
                                 uint64_t seed);

// .ply (ASCII) or .xyz by the extension, mm, in the shortest digits that give the same floats back.
void WritePointCloud(const std::vector<Vec3f>& points, const std::filesystem::path& file);

}  // namespace retrolux
