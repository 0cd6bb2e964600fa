// Markers on surfaces: a shape is projected onto the surface along the normal at its centre, so
// that its edges stay crisp at any resolution and on any mesh.
#pragma once

#include "scenes/scene.h"

namespace retrolux {

// marker_from_object of a marker at a surface point: z along the normal, y along the surface
// towards the object's +z (towards its +x where the normal is within 2 degrees of z), turned by
// `roll_deg` counter-clockwise seen from outside.
RigidTransform MarkerFromObject(const SurfacePoint& point, double roll_deg);

// A marker that is ready to be looked up at a surface hit.
struct PlacedMarker {
  uint32_t instance = 0;  // 1-based, what id.marker holds
  std::shared_ptr<const MarkerShape> shape;
  size_t object = 0;  // index in Scene::objects
  RigidTransform marker_from_world;
  std::shared_ptr<const Bsdf> bright;
  bool dark = false;
  double half_size_mm = 0.0;  // of the square

  // Coordinates in the marker's square of a surface point, or nothing if it lies outside or on a
  // part of the surface that faces away from the marker or lies more than the square's side above
  // or below it.
  std::optional<Vec2d> Locate(const Vec3d& x_in_world, const Vec3d& normal) const;
  // Whether a place in the square is retro-reflective sheeting rather than the object's own
  // surface.
  bool IsBright(const Vec2d& x_in_marker) const;
  // The outline of what is bright: the shape, or the square of a dark marker.
  Polygon BrightOutline() const;
  Vec3d CentreInWorld() const { return marker_from_world.Inverse().translation; }
  Vec3d NormalInWorld() const { return marker_from_world.rotation.row(2).transpose(); }
};

PlacedMarker PlaceMarker(const Scene& scene, const MarkerSpec& marker, uint32_t instance);
std::vector<PlacedMarker> PlaceMarkers(const Scene& scene);

}  // namespace retrolux
