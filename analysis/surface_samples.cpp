#include "analysis/surface_samples.h"

#include <algorithm>
#include <cmath>

#include "core/rng.h"

namespace retrolux {

namespace {

using Corners = std::array<Vec3f, 3>;

Vec3f Mix(const Corners& corners, const Vec3f& barycentric) {
  return barycentric[0] * corners[0] + barycentric[1] * corners[1] + barycentric[2] * corners[2];
}

// Half the way to the mean of the corners' tangent planes (Phong tessellation, Boubekeur and Alexa
// 2008, with alpha = 1/2: on a sphere the mean lies twice as far out as the sphere does).
Vec3f Lift(const Corners& positions, const Corners& normals, const Vec3f& barycentric) {
  const Vec3f flat = Mix(positions, barycentric);
  Vec3f lift = Vec3f::Zero();
  for (size_t i = 0; i < 3; ++i) {
    const float height = (positions[i] - flat).dot(normals[i]);
    lift += barycentric[static_cast<Eigen::Index>(i)] * height * normals[i];
  }
  return 0.5f * lift;
}

// A random point of part (column, row) of k x k congruent parts of a triangle, barycentric. In the
// square that two copies of the triangle make, cell (column, row) belongs to the copy below the
// diagonal for column + row < k, half of it on the diagonal; the upper copies fill the rest.
Vec3f PointOfPart(int column, int row, int k, KeyedRng& rng) {
  float s = rng.NextFloat(), t = rng.NextFloat();
  if (s + t > 1.0f) {
    s = 1.0f - s;
    t = 1.0f - t;
  }
  const auto scale = 1.0f / static_cast<float>(k);
  float u, v;
  if (column + row < k) {
    u = (static_cast<float>(column) + s) * scale;
    v = (static_cast<float>(row) + t) * scale;
  } else {
    // the part that stands on its head in cell (k - 1 - column, k - 1 - row)
    u = (static_cast<float>(k - column) - s) * scale;
    v = (static_cast<float>(k - row) - t) * scale;
  }
  return {1.0f - u - v, u, v};
}

}  // namespace

SurfaceSamples SampleSurface(const TriangleMesh& mesh, double part_area_mm2, uint64_t seed) {
  SurfaceSamples samples;
  const std::vector<std::array<Vec3f, 3>> corner_normals = CornerNormals(mesh);
  for (uint32_t id = 0; id < mesh.triangles.size(); ++id) {
    const auto& t = mesh.triangles[id];
    const Corners corners = {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
    const Corners& normals = corner_normals[id];
    const Vec3f across = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    const double area = 0.5 * static_cast<double>(across.norm());
    if (!(area > 0.0)) continue;
    samples.area_mm2 += area;
    const int k = std::max(1, static_cast<int>(std::ceil(std::sqrt(area / part_area_mm2))));
    KeyedRng rng(CombineKeys(seed, id));
    for (int row = 0; row < k; ++row) {
      for (int column = 0; column < k; ++column) {
        const Vec3f barycentric = PointOfPart(column, row, k, rng);
        const Vec3f normal = Mix(normals, barycentric).normalized();
        const Vec3f lift = Lift(corners, normals, barycentric);
        const bool outwards = lift.dot(normal) > 0.0f;
        samples.positions.push_back(Mix(corners, barycentric) +
                                    (outwards ? lift : Vec3f(Vec3f::Zero())));
        samples.normals.push_back(normal);
        samples.triangles.push_back(id);
        samples.areas_mm2.push_back(static_cast<float>(area / (k * k)));
      }
    }
  }
  return samples;
}

SurfaceSamples TriangleCentres(const TriangleMesh& mesh) {
  SurfaceSamples samples;
  for (uint32_t id = 0; id < mesh.triangles.size(); ++id) {
    const auto& t = mesh.triangles[id];
    const Vec3f &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const Vec3f across = (b - a).cross(c - a);
    samples.positions.push_back((a + b + c) / 3.0f);
    samples.normals.push_back(across.normalized());
    samples.triangles.push_back(id);
    samples.areas_mm2.push_back(0.5f * across.norm());
    samples.area_mm2 += 0.5 * static_cast<double>(across.norm());
  }
  return samples;
}

}  // namespace retrolux
