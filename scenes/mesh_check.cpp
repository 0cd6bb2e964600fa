#include "scenes/mesh_check.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "scenes/mesh_topology.h"

namespace retrolux {

namespace {

std::array<Vec3d, 3> Corners(const TriangleMesh& mesh, const std::array<uint32_t, 3>& triangle) {
  std::array<Vec3d, 3> corners;
  for (size_t i = 0; i < 3; ++i) corners[i] = mesh.positions[triangle[i]].cast<double>();
  return corners;
}

bool IsDegenerate(const std::array<Vec3d, 3>& p) {
  constexpr double kThin = 1e-6;
  const double longest =
      std::max({(p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[0] - p[2]).norm()});
  return 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm() <= kThin * longest * longest;
}

void CheckTriangles(const TriangleMesh& mesh, MeshFindings& findings) {
  for (const auto& triangle : mesh.triangles) {
    const std::array<Vec3d, 3> p = Corners(mesh, triangle);
    if (IsDegenerate(p)) {
      ++findings.degenerate_triangles;
    } else if (!mesh.normals.empty()) {
      const Vec3f mean =
          mesh.normals[triangle[0]] + mesh.normals[triangle[1]] + mesh.normals[triangle[2]];
      const Vec3d winding = (p[1] - p[0]).cross(p[2] - p[0]);
      if (winding.dot(mean.cast<double>()) < 0.0) ++findings.opposed_normals;
    }
  }
}

size_t CountDuplicates(const TriangleMesh& mesh, const MeshTopology& topology) {
  const float same_direction = std::cos(static_cast<float>(RadFromDeg(1.0)));
  std::vector<std::vector<uint32_t>> distinct(topology.places);
  size_t duplicates = 0;
  for (uint32_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
    std::vector<uint32_t>& others = distinct[topology.place[vertex]];
    bool is_duplicate = false;
    for (const uint32_t other : others) {
      is_duplicate |=
          mesh.normals.empty() || mesh.normals[vertex].dot(mesh.normals[other]) > same_direction;
    }
    if (is_duplicate) {
      ++duplicates;
    } else {
      others.push_back(vertex);
    }
  }
  return duplicates;
}

// What the lengths would be multiplied by if the file were in another unit, and that would make a
// mask of them.
std::string UnitHint(double extent_mm) {
  for (const double factor : {10.0, 1000.0, 100.0, 0.1, 0.001, 0.01}) {
    const double other = factor * extent_mm;
    if (other < 100.0 || other > 1000.0) continue;
    return fmt::format("; {} it would be {:.0f} mm: is --unit right?",
                       factor > 1.0 ? fmt::format("in a unit {:g} times as long", factor)
                                    : fmt::format("in a unit {:g} times shorter", 1.0 / factor),
                       other);
  }
  return "; is --unit right?";
}

}  // namespace

MeshFindings CheckMesh(const TriangleMesh& mesh) {
  RETROLUX_CHECK(!mesh.triangles.empty(), "an empty mesh");
  constexpr double kWeld = 1e-4;
  Vec3f low = mesh.positions.front(), high = low;
  for (const Vec3f& p : mesh.positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  MeshFindings findings;
  findings.vertices = mesh.positions.size();
  findings.triangles = mesh.triangles.size();
  findings.min_corner = low.cast<double>();
  findings.max_corner = high.cast<double>();
  findings.area_mm2 = mesh.Area();
  const double size = (findings.max_corner - findings.min_corner).norm();
  const MeshTopology topology = TopologyOf(mesh, kWeld * size);
  findings.pieces = topology.pieces.size();
  findings.holes = topology.boundary_loops;
  for (const MeshEdge& edge : topology.edges) {
    findings.boundary_edges += edge.IsBoundary();
    findings.non_manifold_edges += !edge.IsManifold();
    findings.inconsistent_edges += !edge.IsConsistent();
  }
  for (const MeshPiece& piece : topology.pieces)
    findings.inside_out_pieces += piece.IsInsideOut().value_or(false);
  findings.duplicate_vertices = CountDuplicates(mesh, topology);
  CheckTriangles(mesh, findings);
  return findings;
}

std::vector<std::string> Warnings(const MeshFindings& f) {
  std::vector<std::string> lines;
  const double extent = f.LargestExtent_mm();
  if (extent < kSmallestMask_mm || extent > kLargestMask_mm) {
    lines.push_back(fmt::format("largest extent {:.4g} mm, a mask has {:g} to {:g} mm{}", extent,
                                kSmallestMask_mm, kLargestMask_mm, UnitHint(extent)));
  }
  if (f.inside_out_pieces > 0) {
    lines.push_back(
        fmt::format("{} of {} pieces inside out: their outer side looks inwards; turn them with "
                    "--flip, or flip the normals in the program that wrote the file",
                    f.inside_out_pieces, f.pieces));
  }
  if (f.inconsistent_edges > 0) {
    lines.push_back(
        fmt::format("{} edges between triangles that are wound against each other: parts of the "
                    "outer side look inwards; make the normals consistent",
                    f.inconsistent_edges));
  }
  if (f.opposed_normals > 0) {
    lines.push_back(
        fmt::format("{} of {} triangles have vertex normals that point to their inner side: import "
                    "with --smooth to compute new ones",
                    f.opposed_normals, f.triangles));
  }
  if (f.pieces > 1) {
    lines.push_back(
        fmt::format("{} unconnected pieces: remove those that are not of the mask", f.pieces));
  }
  if (f.holes > 1) {
    lines.push_back(
        fmt::format("{} holes ({} edges without a neighbour): an open mask has one, its rim; close "
                    "the others if they are not in the mask",
                    f.holes, f.boundary_edges));
  }
  if (f.non_manifold_edges > 0) {
    lines.push_back(fmt::format("{} edges of three triangles or more: remove inner walls",
                                f.non_manifold_edges));
  }
  if (f.duplicate_vertices > 0) {
    lines.push_back(fmt::format("{} duplicate vertices: harmless, but merge them to save memory",
                                f.duplicate_vertices));
  }
  if (f.degenerate_triangles > 0) {
    lines.push_back(fmt::format("{} triangles without area: harmless, but remove them",
                                f.degenerate_triangles));
  }
  return lines;
}

}  // namespace retrolux
