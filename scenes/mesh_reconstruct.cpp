#include "scenes/mesh_reconstruct.h"

#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/compute_average_spacing.h>
#include <CGAL/jet_smooth_point_set.h>

#include <cmath>

#include "core/error.h"
#include "scenes/mesh_topology.h"
#include "scenes/mesh_weld.h"

namespace retrolux {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Facet = std::array<size_t, 3>;

constexpr size_t kMinPoints = 12;

// Which of the facets that fit comes next: that of the smallest empty ball, and none with a longer
// edge than allowed.
struct ShortEdges {
  double max_squared;

  template <typename AdvancingFront, typename CellHandle>
  double operator()(const AdvancingFront& front, CellHandle& cell, const int& index) const {
    for (int i = 1; i <= 3; ++i) {
      const Point& a = cell->vertex((index + i) % 4)->point();
      const Point& b = cell->vertex((index + i % 3 + 1) % 4)->point();
      if (CGAL::squared_distance(a, b) > max_squared) return front.infinity();
    }
    return front.smallest_radius_delaunay_sphere(cell, index);
  }
};

std::vector<Point> DifferentPoints(const std::vector<Vec3f>& points) {
  std::vector<Point> different;
  different.reserve(points.size());
  for (const Vec3f& p : points) different.emplace_back(p.x(), p.y(), p.z());
  std::sort(different.begin(), different.end());
  different.erase(std::unique(different.begin(), different.end()), different.end());
  return different;
}

// The mean distance to the six nearest neighbours. CGAL counts the point itself as a seventh.
double SpacingOf(const std::vector<Point>& points) {
  return 7.0 / 6.0 * CGAL::compute_average_spacing<CGAL::Sequential_tag>(points, 6);
}

// How many points lie within `radius` of one. For points evenly at random on a plane the spacing is
// 0.98 / sqrt(density): the mean of Gamma(k + 1/2) / (Gamma(k) sqrt(pi)) over k = 1 to 6.
size_t NeighboursWithin(double radius, double spacing, size_t points) {
  const double neighbours = kPi * std::pow(0.98 * radius / spacing, 2);
  return static_cast<size_t>(
      std::clamp(neighbours, static_cast<double>(kMinPoints - 1), static_cast<double>(points - 1)));
}

// CGAL tells of a plane on stderr, and finds no surface in it.
bool LieInAPlane(const std::vector<Point>& points) {
  constexpr double kFlat = 1e-6;
  Vec3d mean = Vec3d::Zero();
  for (const Point& p : points)
    mean += Vec3d(p.x(), p.y(), p.z()) / static_cast<double>(points.size());
  Mat3d moments = Mat3d::Zero();
  for (const Point& p : points) {
    const Vec3d d = Vec3d(p.x(), p.y(), p.z()) - mean;
    moments += d * d.transpose();
  }
  const Vec3d squares = Eigen::SelfAdjointEigenSolver<Mat3d>(moments).eigenvalues();
  return squares.minCoeff() <= kFlat * kFlat * squares.maxCoeff();
}

TriangleMesh MeshOf(const std::vector<Point>& points, const std::vector<Facet>& facets) {
  TriangleMesh mesh;
  for (const Point& p : points) mesh.positions.push_back(Vec3d(p.x(), p.y(), p.z()).cast<float>());
  for (const auto& [a, b, c] : facets) {
    mesh.triangles.push_back(
        {static_cast<uint32_t>(a), static_cast<uint32_t>(b), static_cast<uint32_t>(c)});
  }
  return mesh;
}

// Each triangle begins with its smallest index, and they ascend: the order that CGAL leaves, and
// which side of the surface it calls the front, depend on addresses in memory. So this comes after
// OrientOutwards().
void PutInFixedOrder(TriangleMesh& mesh) {
  for (auto& t : mesh.triangles)
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(mesh.triangles.begin(), mesh.triangles.end());
}

}  // namespace

void ReconstructOptions::Check() const {
  const auto require = [](bool good, const char* name, double value, const char* expected) {
    if (!good) throw InputError(fmt::format("{} {:g}: expected {}", name, value, expected));
  };
  require(std::isfinite(smoothing_scale_mm) && smoothing_scale_mm >= 0.0, "--smoothing-scale-mm",
          smoothing_scale_mm, "a length in mm, or 0 for 4 times the spacing");
  require(smoothing_iterations >= 0 && smoothing_iterations <= 20, "--smoothing-iterations",
          smoothing_iterations, "a number from 0 to 20");
  require(std::isfinite(max_edge_mm) && max_edge_mm >= 0.0, "--max-edge-mm", max_edge_mm,
          "a length in mm, or 0 for 6 times the spacing");
}

Reconstruction ReconstructSurface(const std::vector<Vec3f>& given,
                                  const ReconstructOptions& options) {
  options.Check();
  std::vector<Point> points = DifferentPoints(given);
  if (points.size() < kMinPoints) {
    throw InputError(fmt::format("a cloud of {} different points; expected at least {}",
                                 points.size(), kMinPoints));
  }
  if (LieInAPlane(points)) {
    throw InputError(
        "a cloud whose points all lie in a plane; expected points on a curved surface");
  }
  Reconstruction result;
  result.spacing_mm = SpacingOf(points);
  if (options.smoothing_iterations > 0) {
    const double radius =
        options.smoothing_scale_mm > 0.0 ? options.smoothing_scale_mm : 4.0 * result.spacing_mm;
    result.neighbours = NeighboursWithin(radius, result.spacing_mm, points.size());
    for (int i = 0; i < options.smoothing_iterations; ++i) {
      CGAL::jet_smooth_point_set<CGAL::Sequential_tag>(
          points, static_cast<unsigned int>(result.neighbours));
    }
  }
  result.max_edge_mm = options.max_edge_mm > 0.0 ? options.max_edge_mm : 6.0 * result.spacing_mm;
  std::vector<Facet> facets;
  CGAL::advancing_front_surface_reconstruction(points.begin(), points.end(),
                                               std::back_inserter(facets),
                                               ShortEdges{result.max_edge_mm * result.max_edge_mm});
  if (facets.empty()) {
    throw InputError(
        fmt::format("no surface through {} points; expected points that lie densely on a surface, "
                    "with gaps below "
                    "{:.3g} mm (--max-edge-mm)",
                    points.size(), result.max_edge_mm));
  }
  result.mesh = MeshOf(points, facets);
  OrientOutwards(result.mesh);
  PutInFixedOrder(result.mesh);
  result.mesh = WithSmoothNormals(result.mesh);
  return result;
}

}  // namespace retrolux
