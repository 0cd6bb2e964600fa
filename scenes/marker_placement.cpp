#include "scenes/marker_placement.h"

#include <cmath>

namespace retrolux {

RigidTransform MarkerFromObject(const SurfacePoint& point, double roll_deg) {
  const Vec3d z = point.normal;
  const Vec3d reference =
      std::abs(z.z()) < std::cos(RadFromDeg(2.0)) ? Vec3d::UnitZ() : Vec3d::UnitX();
  const Vec3d y0 = (reference - reference.dot(z) * z).normalized();
  const Vec3d x0 = y0.cross(z);
  const double roll = RadFromDeg(roll_deg);
  Mat3d rotation;
  rotation.row(0) = std::cos(roll) * x0 + std::sin(roll) * y0;
  rotation.row(1) = -std::sin(roll) * x0 + std::cos(roll) * y0;
  rotation.row(2) = z;
  return {rotation, -(rotation * point.position)};
}

std::optional<Vec2d> PlacedMarker::Locate(const Vec3d& x_in_world, const Vec3d& normal) const {
  const Vec3d x = marker_from_world * x_in_world;
  if (std::abs(x.x()) > half_size_mm || std::abs(x.y()) > half_size_mm) return std::nullopt;
  if (std::abs(x.z()) > 2.0 * half_size_mm || normal.dot(NormalInWorld()) <= 0.0)
    return std::nullopt;
  return x.head<2>();
}

bool PlacedMarker::IsBright(const Vec2d& x_in_marker) const {
  return shape->Contains(x_in_marker) != dark;
}

Polygon PlacedMarker::BrightOutline() const {
  const double s = half_size_mm;
  return dark ? Polygon{{-s, -s}, {s, -s}, {s, s}, {-s, s}} : shape->outline_mm;
}

PlacedMarker PlaceMarker(const Scene& scene, const MarkerSpec& marker, uint32_t instance) {
  const MarkerSet& set = *scene.marker_set;
  PlacedMarker placed;
  placed.instance = instance;
  placed.shape = {scene.marker_set, &set.ByNumber(marker.number)};
  const SceneObject& object = scene.Object(marker.object);
  placed.object = static_cast<size_t>(&object - scene.objects.data());
  const SurfacePoint point = NearestSurfacePoint(object.mesh, marker.at);
  placed.marker_from_world =
      MarkerFromObject(point, marker.roll_deg) * object.world_from_object.Inverse();
  placed.bright = scene.materials.at(marker.material).bsdf;
  placed.dark = marker.dark;
  placed.half_size_mm = 0.5 * set.Side_mm(marker.dark);
  return placed;
}

std::vector<PlacedMarker> PlaceMarkers(const Scene& scene) {
  std::vector<PlacedMarker> placed;
  for (const MarkerSpec& marker : scene.markers) {
    placed.push_back(PlaceMarker(scene, marker, static_cast<uint32_t>(placed.size() + 1)));
  }
  return placed;
}

}  // namespace retrolux
