#include "scenes/mesh_shapes.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace retrolux {

namespace {

using Triangle = std::array<uint32_t, 3>;

struct UnitSphere {
  std::vector<Vec3d> points;
  std::vector<Triangle> triangles;
};

UnitSphere Icosahedron() {
  const double t = 0.5 * (1.0 + std::sqrt(5.0));
  UnitSphere s;
  s.points = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
              {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
  for (Vec3d& p : s.points) p.normalize();
  s.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                 {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                 {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                 {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  return s;
}

void Subdivide(UnitSphere& sphere) {
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> midpoints;
  const auto midpoint = [&](uint32_t a, uint32_t b) {
    const auto [entry, is_new] =
        midpoints.try_emplace(std::minmax(a, b), static_cast<uint32_t>(sphere.points.size()));
    if (is_new) sphere.points.push_back((sphere.points[a] + sphere.points[b]).normalized());
    return entry->second;
  };
  std::vector<Triangle> finer;
  for (const auto& [a, b, c] : sphere.triangles) {
    const uint32_t ab = midpoint(a, b), bc = midpoint(b, c), ca = midpoint(c, a);
    finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
  }
  sphere.triangles = std::move(finer);
}

// A quadrilateral a b c d, counter-clockwise seen from outside.
void AddQuad(TriangleMesh& mesh, const std::array<Vec3d, 4>& corners) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (const Vec3d& corner : corners) mesh.positions.push_back(corner.cast<float>());
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

}  // namespace

TriangleMesh EllipsoidMesh(const Vec3d& semi_axes, int levels) {
  UnitSphere sphere = Icosahedron();
  for (int i = 0; i < levels; ++i) Subdivide(sphere);
  TriangleMesh mesh;
  for (const Vec3d& p : sphere.points) {
    mesh.positions.push_back(p.cwiseProduct(semi_axes).cast<float>());
    mesh.normals.push_back(p.cwiseQuotient(semi_axes).normalized().cast<float>());
  }
  mesh.triangles = std::move(sphere.triangles);
  return mesh;
}

TriangleMesh RectangleMesh(const Vec3d& corner, const Vec3d& edge_u, const Vec3d& edge_v) {
  TriangleMesh mesh;
  AddQuad(mesh, {corner, corner + edge_u, corner + edge_u + edge_v, corner + edge_v});
  return mesh;
}

TriangleMesh BoxMesh(const Vec3d& lo, const Vec3d& hi) {
  const Vec3d x((hi - lo).x(), 0, 0), y(0, (hi - lo).y(), 0), z(0, 0, (hi - lo).z());
  TriangleMesh mesh;
  mesh.Append(RectangleMesh(lo, y, x));
  mesh.Append(RectangleMesh(lo, z, y));
  mesh.Append(RectangleMesh(lo, x, z));
  mesh.Append(RectangleMesh(hi, -y, -x));
  mesh.Append(RectangleMesh(hi, -z, -y));
  mesh.Append(RectangleMesh(hi, -x, -z));
  return mesh;
}

TriangleMesh InvertedBoxMesh(const Vec3d& lo, const Vec3d& hi) {
  TriangleMesh mesh = BoxMesh(lo, hi);
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriangleMesh BoreMesh(const std::vector<Vec2d>& radius_and_z, int segments) {
  TriangleMesh mesh;
  for (size_t ring = 0; ring + 1 < radius_and_z.size(); ++ring) {
    const Vec2d a = radius_and_z[ring], b = radius_and_z[ring + 1];
    // Towards the axis, perpendicular to the profile.
    const Vec2d inward = Vec2d(-(b.y() - a.y()), b.x() - a.x()).normalized();
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (int i = 0; i < segments; ++i) {
      const double phi = 2.0 * kPi * i / segments;
      const Vec3d out(std::cos(phi), std::sin(phi), 0.0);
      const Vec3d normal = inward.x() * out + inward.y() * Vec3d::UnitZ();
      for (const Vec2d& p : {a, b}) {
        mesh.positions.push_back((p.x() * out + p.y() * Vec3d::UnitZ()).cast<float>());
        mesh.normals.push_back(normal.cast<float>());
      }
    }
    for (int i = 0; i < segments; ++i) {
      const uint32_t here = first + 2 * static_cast<uint32_t>(i);
      const uint32_t next = first + 2 * static_cast<uint32_t>((i + 1) % segments);
      mesh.triangles.push_back({here, here + 1, next});
      mesh.triangles.push_back({next, here + 1, next + 1});
    }
  }
  return mesh;
}

namespace {

// Where the ray from the origin at angle phi leaves the rectangle.
Vec2d OnRectangle(const Vec2d& lo, const Vec2d& hi, double phi) {
  const Vec2d d(std::cos(phi), std::sin(phi));
  const double tx = d.x() > 0 ? hi.x() / d.x() : d.x() < 0 ? lo.x() / d.x() : 1e30;
  const double ty = d.y() > 0 ? hi.y() / d.y() : d.y() < 0 ? lo.y() / d.y() : 1e30;
  return std::min(tx, ty) * d;
}

}  // namespace

TriangleMesh PlateWithHoleMesh(const Vec2d& lo, const Vec2d& hi, double z, double hole_radius,
                               int segments, bool faces_up) {
  std::vector<double> angles;
  for (int i = 0; i < segments; ++i) angles.push_back(-kPi + 2.0 * kPi * i / segments);
  for (const Vec2d& corner : {lo, hi, Vec2d(lo.x(), hi.y()), Vec2d(hi.x(), lo.y())}) {
    angles.push_back(std::atan2(corner.y(), corner.x()));
  }
  std::sort(angles.begin(), angles.end());
  TriangleMesh mesh;
  const auto at = [&](const Vec2d& p) { return Vec3d(p.x(), p.y(), z); };
  for (size_t i = 0; i < angles.size(); ++i) {
    const double phi0 = angles[i], phi1 = angles[(i + 1) % angles.size()];
    const Vec3d inner0 = at(hole_radius * Vec2d(std::cos(phi0), std::sin(phi0)));
    const Vec3d inner1 = at(hole_radius * Vec2d(std::cos(phi1), std::sin(phi1)));
    const Vec3d outer0 = at(OnRectangle(lo, hi, phi0)), outer1 = at(OnRectangle(lo, hi, phi1));
    if (faces_up) {
      AddQuad(mesh, {inner0, outer0, outer1, inner1});
    } else {
      AddQuad(mesh, {inner0, inner1, outer1, outer0});
    }
  }
  return mesh;
}

}  // namespace retrolux
