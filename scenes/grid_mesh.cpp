#include "scenes/grid_mesh.h"

#include "core/error.h"

namespace retrolux {

namespace {

Vec3d NormalOf(const Surface& surface, const Vec2d& uv) {
  constexpr double kStep = 1e-4;
  const Vec2d du(kStep, 0.0), dv(0.0, kStep);
  const Vec3d along_u = surface(uv + du) - surface(uv - du);
  const Vec3d along_v = surface(uv + dv) - surface(uv - dv);
  return along_u.cross(along_v).normalized();
}

// From -1 to 1, exactly odd about the middle.
double PlaceOf(int index, int count) {
  return static_cast<double>(2 * index - (count - 1)) / (count - 1);
}

void AddVertices(int rows, int columns, const GridMap& map, const Surface& surface,
                 TriangleMesh& mesh) {
  const int middle = columns / 2;
  for (int row = 0; row < rows; ++row) {
    const auto first = static_cast<size_t>(row) * columns;
    for (int column = 0; column <= middle; ++column) {
      const Vec2d uv = map({PlaceOf(column, columns), PlaceOf(row, rows)});
      Vec3f position = surface(uv).cast<float>(), normal = NormalOf(surface, uv).cast<float>();
      if (column == middle) {
        position.y() = 0.0f;
        normal = Vec3f(normal.x(), 0.0f, normal.z()).normalized();
      }
      mesh.positions.push_back(position);
      mesh.normals.push_back(normal);
    }
    for (int column = middle + 1; column < columns; ++column) {
      const size_t twin = first + (columns - 1 - column);
      mesh.positions.push_back(mesh.positions[twin].cwiseProduct(Vec3f(1, -1, 1)));
      mesh.normals.push_back(mesh.normals[twin].cwiseProduct(Vec3f(1, -1, 1)));
    }
  }
}

void AddTriangles(int rows, int columns, TriangleMesh& mesh) {
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      const auto a = static_cast<uint32_t>(row * columns + column), b = a + 1;
      const uint32_t c = b + static_cast<uint32_t>(columns), d = c - 1;
      const bool upper = 2 * row + 1 >= rows - 1, right = 2 * column + 1 >= columns - 1;
      if (upper == right) {
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
      } else {
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {b, c, d}});
      }
    }
  }
}

}  // namespace

TriangleMesh SymmetricGridMesh(int rows, int columns, const GridMap& map, const Surface& surface) {
  RETROLUX_CHECK(rows >= 2 && columns >= 3 && columns % 2 == 1, "{} x {}", rows, columns);
  TriangleMesh mesh;
  AddVertices(rows, columns, map, surface, mesh);
  AddTriangles(rows, columns, mesh);
  return mesh;
}

}  // namespace retrolux
