#include "analysis/area_shapes.h"

#include <cmath>

#include "core/rng.h"

namespace retrolux {

Mat3d RandomRotation(uint64_t key) {
  // Shoemake, "Uniform random rotations", Graphics Gems III, 1992.
  KeyedRng rng(key);
  const double u = rng.NextDouble();
  const double a = 2.0 * kPi * rng.NextDouble(), b = 2.0 * kPi * rng.NextDouble();
  return Eigen::Quaterniond(std::sqrt(u) * std::cos(b), std::sqrt(1.0 - u) * std::sin(a),
                            std::sqrt(1.0 - u) * std::cos(a), std::sqrt(u) * std::sin(b))
      .toRotationMatrix();
}

TriangleMesh DiscMesh(double radius, int rings) {
  const double corner = kPi / (6 * rings);
  const double equal_area = radius * std::sqrt(corner / (std::sin(corner) * std::cos(corner)));
  TriangleMesh mesh;
  mesh.positions.emplace_back(0.0f, 0.0f, 0.0f);
  const auto at = [](int ring, int k) {  // ring 1 has 6 points, ring 2 has 12 ...
    return ring == 0 ? 0u : static_cast<uint32_t>(1 + 3 * ring * (ring - 1) + k % (6 * ring));
  };
  for (int ring = 1; ring <= rings; ++ring) {
    for (int k = 0; k < 6 * ring; ++k) {
      const double phi = 2.0 * kPi * k / (6 * ring), r = equal_area * ring / rings;
      mesh.positions.push_back(Vec3d(r * std::cos(phi), r * std::sin(phi), 0.0).cast<float>());
    }
    for (int sector = 0; sector < 6; ++sector) {
      for (int k = 0; k < ring; ++k) {
        const int outer = sector * ring + k, inner = sector * (ring - 1) + k;
        mesh.triangles.push_back({at(ring, outer), at(ring, outer + 1), at(ring - 1, inner)});
        if (k + 1 < ring) {
          mesh.triangles.push_back(
              {at(ring, outer + 1), at(ring - 1, inner + 1), at(ring - 1, inner)});
        }
      }
    }
  }
  return mesh;
}

TriangleMesh WithBack(TriangleMesh mesh) {
  TriangleMesh back = mesh;
  for (auto& [a, b, c] : back.triangles) std::swap(b, c);
  mesh.Append(back);
  return mesh;
}

}  // namespace retrolux
