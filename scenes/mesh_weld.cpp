#include "scenes/mesh_weld.h"

#include <cmath>
#include <map>

namespace retrolux {

namespace {

// -0 and +0 are the same place.
std::array<float, 6> KeyOf(const TriangleMesh& mesh, uint32_t vertex) {
  const Vec3f p = mesh.positions[vertex];
  const Vec3f n = mesh.normals.empty() ? Vec3f::Zero() : mesh.normals[vertex];
  return {p.x() + 0.0f, p.y() + 0.0f, p.z() + 0.0f, n.x() + 0.0f, n.y() + 0.0f, n.z() + 0.0f};
}

double AngleBetween(const Vec3d& a, const Vec3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

TriangleMesh WeldedExactly(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.positions.size(), false);
  for (const auto& triangle : mesh.triangles) {
    for (const uint32_t vertex : triangle) used[vertex] = true;
  }
  TriangleMesh welded;
  std::map<std::array<float, 6>, uint32_t> known;
  std::vector<uint32_t> new_index(mesh.positions.size(), 0);
  for (uint32_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
    if (!used[vertex]) continue;
    const auto [entry, is_new] =
        known.try_emplace(KeyOf(mesh, vertex), static_cast<uint32_t>(welded.positions.size()));
    new_index[vertex] = entry->second;
    if (!is_new) continue;
    welded.positions.push_back(mesh.positions[vertex]);
    if (!mesh.normals.empty()) welded.normals.push_back(mesh.normals[vertex]);
  }
  for (const auto& [a, b, c] : mesh.triangles)
    welded.triangles.push_back({new_index[a], new_index[b], new_index[c]});
  return welded;
}

TriangleMesh WithSmoothNormals(const TriangleMesh& mesh) {
  TriangleMesh smooth = WeldedExactly({mesh.positions, {}, mesh.triangles});
  std::vector<Vec3d> sums(smooth.positions.size(), Vec3d::Zero());
  for (const auto& triangle : smooth.triangles) {
    std::array<Vec3d, 3> p;
    for (size_t i = 0; i < 3; ++i) p[i] = smooth.positions[triangle[i]].cast<double>();
    const Vec3d cross = (p[1] - p[0]).cross(p[2] - p[0]);
    if (!(cross.norm() > 0.0)) continue;
    for (size_t i = 0; i < 3; ++i) {
      const Vec3d to_next = p[(i + 1) % 3] - p[i], to_last = p[(i + 2) % 3] - p[i];
      sums[triangle[i]] += AngleBetween(to_next, to_last) * cross.normalized();
    }
  }
  for (const Vec3d& sum : sums) {
    const double length = sum.norm();
    smooth.normals.push_back(length > 0.0 ? Vec3d(sum / length).cast<float>() : Vec3f(0, 0, 1));
  }
  return smooth;
}

}  // namespace retrolux
