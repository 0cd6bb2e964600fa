#include "scenes/mesh.h"

#include <cmath>
#include <limits>

#include "core/error.h"

namespace retrolux {

double TriangleMesh::Area() const {
  double twice = 0.0;
  for (const auto& t : triangles) {
    const Vec3d a = positions[t[0]].cast<double>();
    twice += (positions[t[1]].cast<double>() - a).cross(positions[t[2]].cast<double>() - a).norm();
  }
  return 0.5 * twice;
}

size_t TriangleMesh::Bytes() const {
  return positions.size() * sizeof(Vec3f) + normals.size() * sizeof(Vec3f) +
         triangles.size() * sizeof(triangles[0]) + uvs.size() * sizeof(Vec2f);
}

void TriangleMesh::Append(const TriangleMesh& other) {
  RETROLUX_CHECK(positions.empty() ||
                     (normals.empty() == other.normals.empty() && uvs.empty() == other.uvs.empty()),
                 "normals or texture coordinates on one side only");
  const auto offset = static_cast<uint32_t>(positions.size());
  positions.insert(positions.end(), other.positions.begin(), other.positions.end());
  normals.insert(normals.end(), other.normals.begin(), other.normals.end());
  uvs.insert(uvs.end(), other.uvs.begin(), other.uvs.end());
  for (const auto& t : other.triangles)
    triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
}

namespace {

struct Corner {
  uint32_t triangle;
  float angle_rad;
};

Vec3f FacetNormal(const TriangleMesh& mesh, const std::array<uint32_t, 3>& t) {
  const Vec3f& a = mesh.positions[t[0]];
  return (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).normalized();
}

float CornerAngle(const TriangleMesh& mesh, const std::array<uint32_t, 3>& t, size_t corner) {
  const Vec3f& at = mesh.positions[t[corner]];
  const Vec3f u = mesh.positions[t[(corner + 1) % 3]] - at;
  const Vec3f v = mesh.positions[t[(corner + 2) % 3]] - at;
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

}  // namespace

std::vector<std::array<Vec3f, 3>> CornerNormals(const TriangleMesh& mesh, double crease_deg) {
  const auto limit = static_cast<float>(std::cos(RadFromDeg(crease_deg)));
  std::vector<Vec3f> facets;
  std::vector<std::vector<Corner>> around(mesh.positions.size());
  for (uint32_t id = 0; id < mesh.triangles.size(); ++id) {
    const auto& t = mesh.triangles[id];
    facets.push_back(FacetNormal(mesh, t));
    for (size_t corner = 0; corner < 3 && mesh.normals.empty(); ++corner)
      around[t[corner]].push_back({id, CornerAngle(mesh, t, corner)});
  }
  std::vector<std::array<Vec3f, 3>> normals(mesh.triangles.size());
  for (uint32_t id = 0; id < mesh.triangles.size(); ++id) {
    for (size_t corner = 0; corner < 3; ++corner) {
      const uint32_t vertex = mesh.triangles[id][corner];
      Vec3f sum = Vec3f::Zero();
      if (!mesh.normals.empty()) sum = mesh.normals[vertex];
      for (const Corner& other : around[vertex]) {
        if (facets[other.triangle].dot(facets[id]) > limit)
          sum += other.angle_rad * facets[other.triangle];
      }
      normals[id][corner] =
          sum.normalized().dot(facets[id]) > limit ? Vec3f(sum.normalized()) : facets[id];
    }
  }
  return normals;
}

namespace {

// Barycentric coordinates of the point of triangle (a, b, c) nearest to p (Ericson, Real-Time
// Collision Detection, 5.1.5).
Vec3d NearestBarycentric(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {1.0, 0.0, 0.0};
  const Vec3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return {0.0, 1.0, 0.0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    const double v = d1 / (d1 - d3);
    return {1.0 - v, v, 0.0};
  }
  const Vec3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return {0.0, 0.0, 1.0};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    const double w = d2 / (d2 - d6);
    return {1.0 - w, 0.0, w};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0.0, 1.0 - w, w};
  }
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

}  // namespace

SurfacePoint NearestSurfacePoint(const TriangleMesh& mesh, const Vec3d& x) {
  RETROLUX_CHECK(!mesh.triangles.empty(), "an empty mesh");
  SurfacePoint nearest;
  double nearest2 = std::numeric_limits<double>::infinity();
  Vec3d weights = Vec3d::Zero();
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    const Vec3d a = mesh.positions[t[0]].cast<double>();
    const Vec3d b = mesh.positions[t[1]].cast<double>();
    const Vec3d c = mesh.positions[t[2]].cast<double>();
    const Vec3d w = NearestBarycentric(x, a, b, c);
    const Vec3d p = w.x() * a + w.y() * b + w.z() * c;
    const double distance2 = (p - x).squaredNorm();
    if (distance2 >= nearest2) continue;
    nearest2 = distance2;
    weights = w;
    nearest = {p, (b - a).cross(c - a), static_cast<uint32_t>(i)};
  }
  if (!mesh.normals.empty()) {
    const auto& t = mesh.triangles[nearest.triangle];
    nearest.normal = weights.x() * mesh.normals[t[0]].cast<double>() +
                     weights.y() * mesh.normals[t[1]].cast<double>() +
                     weights.z() * mesh.normals[t[2]].cast<double>();
  }
  nearest.normal.normalize();
  return nearest;
}

}  // namespace retrolux
