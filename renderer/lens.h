// The lens: from a place on the sensor to a ray in front of the camera, and how much of its light
// arrives.
//
// The chief ray of a place p (on the plane z = 1 of the camera frame, distortion removed) passes
// the lens's centre. A pinhole has no other. A thin lens focused at s has one through every point
// l of its aperture, to where the chief ray meets the plane z = s; behind the lens it runs to the
// sensor at the principal distance s' = s f / (s - f).
//
// Irradiance: pi L T / (4 N^2) per unit of the lens's focal plane, times the fall-off
//   pinhole    cos^4(theta) / |J| x share of the aperture that the stop leaves open
//   thin lens  cos^4(theta') / |J|, theta' inside the camera, from l to the sensor; 0 if the stop
//              cuts the ray
// where |J|, the determinant of the distortion, is by how much it stretches the picture there: the
// same light falls on |J| times the area.
#pragma once

#include <optional>

#include "scenes/scene.h"

namespace retrolux {

class LensRays {
 public:
  explicit LensRays(const CameraSpec& camera);

  struct LensRay {
    Vec3f origin, direction;  // world; unit
    float cos_field = 1.0f;   // to the axis, in front of the lens
    float falloff = 1.0f;     // irradiance over that on the axis
  };
  // `aperture`: uniform on the unit square, not used by a pinhole. Nothing where no light arrives.
  std::optional<LensRay> Through(const Vec2d& px, const Vec2f& aperture) const;
  bool HasAperture() const { return thin_; }

  // Radius of the disc that a point `depth_mm` along the axis becomes, in columns of the picture:
  // f^2 / (2 N) |d - s| / (d (s - f)) over the pixel pitch (the thin-lens formula); 0 for a
  // pinhole.
  double BlurRadius_px(double depth_mm) const;

 private:
  CameraModel model_;
  Lens lens_;
  bool thin_;
  double principal_mm_;
  Vec3f centre_;
  Mat3d world_from_camera_;
};

// Share of a disc of radius r that lies within another of radius R >= r whose centre is d away.
double DiscOverlap(double r, double big_r, double d);

}  // namespace retrolux
