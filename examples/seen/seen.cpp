// Where the camera of the built-in scene `oval` sees each marker: a program that uses the library.
#include <fmt/core.h>

#include "renderer/marker_truth.h"
#include "scenes/built_in.h"
#include "scenes/marker_placement.h"

int main() {
  using namespace retrolux;
  const Scene scene = BuiltInScene("oval");
  const RayScene rays(scene);
  const CameraModel& camera = scene.cameras.front().model;
  for (const PlacedMarker& marker : PlaceMarkers(scene)) {
    const MarkerView view = ViewMarker(SampleMarkerSurface(rays, marker), rays, camera);
    const Vec2d px = view.centroid_projected_px.value();
    fmt::print("{}: at ({:.2f}, {:.2f}) px, {:.0f} % of it seen, at {:.1f} degrees\n",
               scene.markers[marker.instance - 1].name, px.x(), px.y(),
               100.0 * view.visible_fraction, view.incidence_deg);
  }
}
