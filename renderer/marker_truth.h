// What is true of a marker in a picture, by geometry and from the noiseless film; never seen by the
// classifier.
#pragma once

#include "renderer/film.h"
#include "renderer/ray_scene.h"

namespace retrolux {

// Points of a marker's bright part on the real surface, for visibility and outline; independent of
// the camera.
struct MarkerSurface {
  struct Point {
    Vec3d position, normal;  // world
    double area_mm2;         // of the surface that it stands for
  };
  std::vector<Point> points;   // a grid over the bright part
  std::vector<Vec3d> corners;  // of the shape's outline, on the surface
  std::vector<Vec3d> outline;  // the same outline with points at most 0.5 mm apart
  std::vector<Vec3d> square;   // outline of the marker's square, likewise
  Vec3d centre, normal;
};
MarkerSurface SampleMarkerSurface(const RayScene& rays, const PlacedMarker& marker);

// The point of the marker's object above or below a place in the marker's square, whatever else
// lies over it; nothing off the object.
std::optional<SurfaceHit> OntoSurface(const RayScene& rays, const PlacedMarker& marker,
                                      const Vec2d& x_in_marker);

// Whether the camera sees a point of a surface: it lies in the frame, faces the camera, and nothing
// is in between.
bool IsSeen(const RayScene& rays, const CameraModel& camera, const Vec3d& position,
            const Vec3d& normal);

// How a camera sees it.
struct MarkerView {
  double visible_fraction =
      0.0;  // of the bright surface: in the frame, facing the camera, nothing in between
  double in_frame_fraction = 0.0;
  double facing_fraction = 0.0;
  double incidence_deg = 0.0;  // between the normal at the centre and the direction to the camera
  double distance_mm = 0.0;    // of the centre from the camera
  bool in_frame = false;       // the whole outline
  std::vector<Vec2d> corners_px;
  Polygon outline_px;
  std::optional<Vec2d> centroid_projected_px;  // of the marker's origin
  std::optional<Vec2d> centroid_outline_px;    // of the area of the projected outline
  std::optional<Vec2d>
      centroid_radiometric_px;  // of the light that the marker sends, where a film is given
};
MarkerView ViewMarker(const MarkerSurface& surface, const RayScene& rays,
                      const CameraModel& camera);

// The centroid of the light that reaches the sensor from marker `instance`, in the picture that the
// sensor gives of the film (renderer/pixel_spread.h); nothing if none does.
std::optional<Vec2d> RadiometricCentroid(const Film& film, uint32_t instance,
                                         const SensorSpec& sensor);

}  // namespace retrolux
