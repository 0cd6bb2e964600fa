#include "scenes/nozzle.h"

#include <algorithm>
#include <cmath>

namespace retrolux {

Vec3d BeamDirection(const Beam& beam) {
  const double elevation = RadFromDeg(beam.elevation_deg);
  return {std::cos(elevation), 0.0, std::sin(elevation)};
}

namespace {

// Where the snout's tip must stand, at least, for a gap to this point along the beam. Nothing
// for a point that the snout would pass.
std::optional<double> TipDistanceFor(const NozzleSpec& spec, const Vec3d& direction,
                                     const Vec3d& point) {
  const double along = point.dot(direction);
  const double across = (point - along * direction).norm();
  if (across > spec.snout_back_radius_mm) return std::nullopt;
  // How far behind the tip the snout's surface is at this distance from the axis.
  double behind = 0.0;
  if (across > spec.tip_radius_mm) {
    behind = spec.snout_length_mm * (across - spec.tip_radius_mm) /
             (spec.snout_back_radius_mm - spec.tip_radius_mm);
  }
  return along + spec.gap_mm - behind;
}

}  // namespace

PlacedNozzle PlaceNozzle(const NozzleSpec& spec, const Beam& beam,
                         std::span<const Vec3d> mask_points) {
  const Vec3d direction = BeamDirection(beam);
  PlacedNozzle nozzle;
  nozzle.tip_distance_mm = spec.min_tip_distance_mm;
  for (const Vec3d& point : mask_points) {
    if (const auto tip = TipDistanceFor(spec, direction, point))
      nozzle.tip_distance_mm = std::max(nozzle.tip_distance_mm, *tip);
  }
  if (nozzle.tip_distance_mm > spec.cylinder_front_mm) {
    nozzle.too_close = true;
    nozzle.tip_distance_mm = spec.cylinder_front_mm;
  }
  nozzle.snout = {nozzle.tip_distance_mm * direction, direction, spec.snout_length_mm,
                  spec.tip_radius_mm, spec.snout_back_radius_mm};
  nozzle.cylinder = {spec.cylinder_front_mm * direction, direction, spec.cylinder_length_mm,
                     spec.cylinder_radius_mm, spec.cylinder_radius_mm};
  return nozzle;
}

TriangleMesh TruncatedConeMesh(const TruncatedCone& cone, int segments) {
  const Vec3d u = cone.axis.unitOrthogonal();
  const Vec3d v = cone.axis.cross(u);
  TriangleMesh mesh;
  const auto add = [&](const Vec3d& point) { mesh.positions.push_back(point.cast<float>()); };
  const Vec3d top = cone.base + cone.length_mm * cone.axis;
  add(cone.base);
  add(top);
  for (int i = 0; i < segments; ++i) {
    const double angle = 2.0 * kPi * i / segments;
    const Vec3d radial = std::cos(angle) * u + std::sin(angle) * v;
    add(cone.base + cone.base_radius_mm * radial);
    add(top + cone.top_radius_mm * radial);
  }
  for (int i = 0; i < segments; ++i) {
    const auto base = static_cast<uint32_t>(2 + 2 * i);
    const auto next = static_cast<uint32_t>(2 + 2 * ((i + 1) % segments));
    mesh.triangles.push_back({0, next, base});
    mesh.triangles.push_back({1, base + 1, next + 1});
    mesh.triangles.push_back({base, next, next + 1});
    mesh.triangles.push_back({base, next + 1, base + 1});
  }
  return mesh;
}

}  // namespace retrolux
