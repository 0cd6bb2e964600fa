#include "scenes/mesh_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/error.h"
#include "core/parallel.h"

namespace retrolux {

namespace {

// A tree of boxes over the triangles; each leaf is a small mesh of its own.
class SurfaceTree {
 public:
  explicit SurfaceTree(const TriangleMesh& mesh) {
    std::vector<Leafling> triangles;
    for (const auto& [a, b, c] : mesh.triangles)
      triangles.push_back({{mesh.positions[a], mesh.positions[b], mesh.positions[c]}});
    root_ = Build(triangles.begin(), triangles.end());
  }

  double DistanceTo(const Vec3d& x) const {
    double nearest = std::numeric_limits<double>::infinity();
    Search(*root_, x, nearest);
    return nearest;
  }

 private:
  struct Leafling {
    std::array<Vec3f, 3> corners;
    Vec3f Centre() const { return (corners[0] + corners[1] + corners[2]) / 3.0f; }
  };
  using Iterator = std::vector<Leafling>::iterator;
  struct Node {
    Eigen::AlignedBox3d box;
    std::unique_ptr<Node> low, high;
    TriangleMesh leaf;  // empty for inner nodes
  };

  static std::unique_ptr<Node> Build(Iterator begin, Iterator end) {
    constexpr ptrdiff_t kLeafSize = 8;
    auto node = std::make_unique<Node>();
    for (Iterator t = begin; t != end; ++t) {
      for (const Vec3f& corner : t->corners) node->box.extend(corner.cast<double>());
    }
    if (end - begin <= kLeafSize) {
      for (Iterator t = begin; t != end; ++t) AddToLeaf(*t, node->leaf);
      return node;
    }
    Eigen::Index axis = 0;
    node->box.sizes().maxCoeff(&axis);
    const Iterator middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end, [axis](const Leafling& a, const Leafling& b) {
      return a.Centre()[axis] < b.Centre()[axis];
    });
    node->low = Build(begin, middle);
    node->high = Build(middle, end);
    return node;
  }

  static void AddToLeaf(const Leafling& triangle, TriangleMesh& leaf) {
    const auto first = static_cast<uint32_t>(leaf.positions.size());
    leaf.positions.insert(leaf.positions.end(), triangle.corners.begin(), triangle.corners.end());
    leaf.triangles.push_back({first, first + 1, first + 2});
  }

  static void Search(const Node& node, const Vec3d& x, double& nearest) {
    if (node.box.exteriorDistance(x) >= nearest) return;
    if (!node.leaf.triangles.empty()) {
      nearest = std::min(nearest, (NearestSurfacePoint(node.leaf, x).position - x).norm());
      return;
    }
    const bool low_first = node.low->box.exteriorDistance(x) <= node.high->box.exteriorDistance(x);
    Search(low_first ? *node.low : *node.high, x, nearest);
    Search(low_first ? *node.high : *node.low, x, nearest);
  }

  std::unique_ptr<Node> root_;
};

std::vector<Vec3d> SamplesOf(const TriangleMesh& mesh) {
  std::vector<Vec3d> samples;
  for (const Vec3f& p : mesh.positions) samples.push_back(p.cast<double>());
  for (const auto& [a, b, c] : mesh.triangles)
    samples.push_back((samples[a] + samples[b] + samples[c]) / 3.0);
  return samples;
}

}  // namespace

DistanceSummary DistanceBetween(const TriangleMesh& from, const TriangleMesh& to) {
  RETROLUX_CHECK(!from.triangles.empty() && !to.triangles.empty(), "an empty mesh");
  const SurfaceTree tree(to);
  const std::vector<Vec3d> samples = SamplesOf(from);
  std::vector<double> distances(samples.size());
  ParallelFor(static_cast<int64_t>(samples.size()), [&](int64_t i) {
    distances[static_cast<size_t>(i)] = tree.DistanceTo(samples[static_cast<size_t>(i)]);
  });
  std::sort(distances.begin(), distances.end());
  DistanceSummary summary;
  summary.samples = distances.size();
  for (const double d : distances) {
    summary.mean_mm += d / static_cast<double>(distances.size());
    summary.rms_mm += d * d / static_cast<double>(distances.size());
  }
  summary.rms_mm = std::sqrt(summary.rms_mm);
  summary.percentile95_mm = distances[(distances.size() * 95 + 99) / 100 - 1];
  summary.max_mm = distances.back();
  return summary;
}

}  // namespace retrolux
