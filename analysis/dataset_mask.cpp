#include "analysis/dataset_mask.h"

#include <algorithm>
#include <cmath>

#include "core/hash.h"
#include "scenes/mask_mesh.h"
#include "scenes/mesh_topology.h"

namespace retrolux {

namespace {

constexpr double kSamePlace_mm = 1e-3;

TriangleMesh MeshOf(const MaskChoice& choice, const std::filesystem::path& config_file) {
  MaskSpec spec;
  spec.mesh = choice.mesh;
  spec.unit = choice.unit;
  return MaskMesh(spec, config_file);
}

std::string GeometryHash(const TriangleMesh& mesh) {
  uint64_t hash = HashBytes("mask");
  const auto add = [&](const auto& values) {
    hash = HashBytes(
        {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0])}, hash);
  };
  add(mesh.positions);
  add(mesh.normals);
  add(mesh.triangles);
  return HexHash(hash);
}

Vec3d Corner(const TriangleMesh& mesh, size_t triangle, size_t corner) {
  return mesh.positions[mesh.triangles[triangle][corner]].cast<double>();
}

void AddAreas(DatasetMask& mask) {
  double sum = 0.0;
  for (size_t i = 0; i < mask.mesh.triangles.size(); ++i) {
    const Vec3d a = Corner(mask.mesh, i, 0);
    sum += 0.5 * (Corner(mask.mesh, i, 1) - a).cross(Corner(mask.mesh, i, 2) - a).norm();
    mask.area_up_to_mm2.push_back(sum);
  }
}

void AddRim(DatasetMask& mask) {
  const MeshTopology topology = TopologyOf(mask.mesh, kSamePlace_mm);
  std::vector<Vec3d> places(topology.places);
  for (size_t v = 0; v < topology.place.size(); ++v)
    places[topology.place[v]] = mask.mesh.positions[v].cast<double>();
  double sum = 0.0;
  for (const MeshEdge& edge : topology.edges) {
    if (!edge.IsBoundary()) continue;
    mask.rim.push_back({places[edge.from], places[edge.to]});
    sum += (places[edge.to] - places[edge.from]).norm();
    mask.rim_up_to_mm.push_back(sum);
  }
}

// The piece that `u` of the whole falls into, and how far into it, 0..1.
std::pair<size_t, double> Locate(const std::vector<double>& up_to, double u) {
  const double place = u * up_to.back();
  const auto piece = static_cast<size_t>(
      std::min<ptrdiff_t>(std::upper_bound(up_to.begin(), up_to.end(), place) - up_to.begin(),
                          static_cast<ptrdiff_t>(up_to.size()) - 1));
  const double begin = piece == 0 ? 0.0 : up_to[piece - 1];
  const double length = up_to[piece] - begin;
  return {piece, length > 0.0 ? (place - begin) / length : 0.0};
}

}  // namespace

Vec3d DatasetMask::PointAt(double u_triangle, double u, double v) const {
  const size_t triangle = Locate(area_up_to_mm2, u_triangle).first;
  const double root = std::sqrt(u);
  return (1.0 - root) * Corner(mesh, triangle, 0) + root * (1.0 - v) * Corner(mesh, triangle, 1) +
         root * v * Corner(mesh, triangle, 2);
}

Vec3d DatasetMask::RimPointAt(double u) const {
  const auto [edge, along] = Locate(rim_up_to_mm, u);
  return rim[edge].from + along * (rim[edge].to - rim[edge].from);
}

DatasetMask MakeDatasetMask(const MaskChoice& choice, const std::filesystem::path& config_file) {
  DatasetMask mask;
  mask.name = choice.mesh;
  mask.mesh = MeshOf(choice, config_file);
  mask.hash = GeometryHash(mask.mesh);
  Vec3f lo = mask.mesh.positions.front(), hi = lo;
  for (const Vec3f& p : mask.mesh.positions) {
    lo = lo.cwiseMin(p);
    hi = hi.cwiseMax(p);
  }
  mask.middle = 0.5 * (lo + hi).cast<double>();
  AddAreas(mask);
  AddRim(mask);
  return mask;
}

}  // namespace retrolux
