#include "scenes/mesh_topology.h"

#include <cmath>
#include <map>
#include <numeric>
#include <unordered_map>

namespace retrolux {

namespace {

using Cell = std::array<int64_t, 3>;

struct CellHash {
  size_t operator()(const Cell& cell) const {
    uint64_t hash = 0;
    for (const int64_t k : cell)
      hash = (hash ^ static_cast<uint64_t>(k)) * 0x9e3779b97f4a7c15ULL + (hash >> 29);
    return hash;
  }
};

// Finds earlier places near a point by a grid with cells as wide as the tolerance.
class PlaceFinder {
 public:
  explicit PlaceFinder(double tolerance) : tolerance_(tolerance) {}

  uint32_t Place(const Vec3d& p) {
    const Cell at = CellOf(p);
    for (int64_t dx = -1; dx <= 1; ++dx) {
      for (int64_t dy = -1; dy <= 1; ++dy) {
        for (int64_t dz = -1; dz <= 1; ++dz) {
          const auto near = cells_.find({at[0] + dx, at[1] + dy, at[2] + dz});
          if (near == cells_.end()) continue;
          for (const uint32_t place : near->second) {
            if ((points_[place] - p).norm() <= tolerance_) return place;
          }
        }
      }
    }
    points_.push_back(p);
    const auto place = static_cast<uint32_t>(points_.size() - 1);
    cells_[at].push_back(place);
    return place;
  }

  const std::vector<Vec3d>& Points() const { return points_; }

 private:
  Cell CellOf(const Vec3d& p) const {
    const double width = std::max(tolerance_, 1e-9);
    return {std::llround(p.x() / width), std::llround(p.y() / width), std::llround(p.z() / width)};
  }

  const double tolerance_;
  std::vector<Vec3d> points_;
  std::unordered_map<Cell, std::vector<uint32_t>, CellHash> cells_;
};

// Sets that are joined: the root of each is its smallest member.
class DisjointSets {
 public:
  explicit DisjointSets(size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  uint32_t Root(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void Join(uint32_t a, uint32_t b) {
    const auto [low, high] = std::minmax({Root(a), Root(b)});
    parent_[high] = low;
  }

 private:
  std::vector<uint32_t> parent_;
};

class TopologyBuilder {
 public:
  TopologyBuilder(const TriangleMesh& mesh, double tolerance) : mesh_(mesh), finder_(tolerance) {
    for (const Vec3f& p : mesh.positions) result_.place.push_back(finder_.Place(p.cast<double>()));
    result_.places = finder_.Points().size();
  }

  MeshTopology Build() {
    AddEdges();
    AddPieces();
    CloseLoops();
    for (const MeshEdge& edge : result_.edges) {
      if (!edge.IsConsistent()) result_.pieces[piece_of_place_[edge.from]].is_consistent = false;
    }
    return std::move(result_);
  }

 private:
  std::array<uint32_t, 3> Places(size_t triangle) const {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    return {result_.place[a], result_.place[b], result_.place[c]};
  }

  static bool IsCollapsed(const std::array<uint32_t, 3>& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
  }

  void AddEdges() {
    std::map<std::pair<uint32_t, uint32_t>, MeshEdge> edges;
    for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const std::array<uint32_t, 3> t = Places(i);
      if (IsCollapsed(t)) continue;
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t a = t[k], b = t[(k + 1) % 3];
        MeshEdge& edge = edges[std::minmax(a, b)];
        ++(a < b ? edge.forward : edge.backward);
      }
    }
    for (const auto& [ends, edge] : edges)
      result_.edges.push_back({ends.first, ends.second, edge.forward, edge.backward});
  }

  void AddPieces() {
    DisjointSets sets(result_.places);
    for (const MeshEdge& edge : result_.edges) sets.Join(edge.from, edge.to);
    std::map<uint32_t, uint32_t> piece_of_root;
    piece_of_place_.assign(result_.places, 0);
    for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const std::array<uint32_t, 3> t = Places(i);
      if (IsCollapsed(t)) continue;
      const auto [entry, is_new] =
          piece_of_root.try_emplace(sets.Root(t[0]), static_cast<uint32_t>(result_.pieces.size()));
      if (is_new) result_.pieces.emplace_back();
      for (const uint32_t place : t) piece_of_place_[place] = entry->second;
      AddTriangle(static_cast<uint32_t>(i), t, result_.pieces[entry->second]);
    }
  }

  void AddTriangle(uint32_t index, const std::array<uint32_t, 3>& t, MeshPiece& piece) const {
    const Vec3d &a = Point(t[0]), &b = Point(t[1]), &c = Point(t[2]);
    piece.triangles.push_back(index);
    piece.area_mm2 += 0.5 * (b - a).cross(c - a).norm();
    piece.capped_volume_mm3 += VolumeUnder(a, b, c);
  }

  void CloseLoops() {
    DisjointSets sets(result_.places);
    struct Loop {
      Vec3d moment = Vec3d::Zero();
      double length = 0.0;
    };
    for (const MeshEdge& edge : result_.edges) {
      if (edge.IsBoundary()) sets.Join(edge.from, edge.to);
    }
    std::map<uint32_t, Loop> loops;
    for (const MeshEdge& edge : result_.edges) {
      if (!edge.IsBoundary()) continue;
      const Vec3d &a = Point(edge.from), &b = Point(edge.to);
      Loop& loop = loops[sets.Root(edge.from)];
      loop.moment += (b - a).norm() * 0.5 * (a + b);
      loop.length += (b - a).norm();
    }
    result_.boundary_loops = loops.size();
    for (const MeshEdge& edge : result_.edges) {
      if (!edge.IsBoundary()) continue;
      const Loop& loop = loops[sets.Root(edge.from)];
      const double volume =
          VolumeUnder(Point(edge.to), Point(edge.from), loop.moment / loop.length);
      result_.pieces[piece_of_place_[edge.from]].capped_volume_mm3 +=
          edge.forward == 1 ? volume : -volume;
    }
  }

  // Signed volume of the tetrahedron with the mesh's first point; the choice of that point drops
  // out of a closed sum, and being near keeps rounding small.
  double VolumeUnder(const Vec3d& a, const Vec3d& b, const Vec3d& c) const {
    const Vec3d& o = Point(0);
    return (a - o).dot((b - o).cross(c - o)) / 6.0;
  }

  const Vec3d& Point(uint32_t place) const { return finder_.Points()[place]; }

  const TriangleMesh& mesh_;
  PlaceFinder finder_;
  MeshTopology result_;
  std::vector<uint32_t> piece_of_place_;
};

}  // namespace

std::optional<bool> MeshPiece::IsInsideOut() const {
  constexpr double kFlat = 1e-3;
  const bool is_flat = std::abs(capped_volume_mm3) < kFlat * std::pow(area_mm2, 1.5);
  if (!is_consistent || is_flat) return std::nullopt;
  return capped_volume_mm3 < 0.0;
}

MeshTopology TopologyOf(const TriangleMesh& mesh, double tolerance_mm) {
  return TopologyBuilder(mesh, tolerance_mm).Build();
}

void OrientOutwards(TriangleMesh& mesh) {
  for (const MeshPiece& piece : TopologyOf(mesh, 0.0).pieces) {
    if (!piece.IsInsideOut().value_or(false)) continue;
    for (const uint32_t i : piece.triangles) std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
  }
}

}  // namespace retrolux
