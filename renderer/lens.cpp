#include "renderer/lens.h"

#include <algorithm>
#include <cmath>

#include "core/sampling.h"

namespace retrolux {

double DiscOverlap(double r, double big_r, double d) {
  if (d <= big_r - r) return 1.0;
  if (d >= big_r + r) return 0.0;
  // Two circular segments, of half-angles a and b.
  const double a =
      std::acos(std::clamp((d * d + r * r - big_r * big_r) / (2.0 * d * r), -1.0, 1.0));
  const double b =
      std::acos(std::clamp((d * d + big_r * big_r - r * r) / (2.0 * d * big_r), -1.0, 1.0));
  const double area =
      r * r * (a - 0.5 * std::sin(2.0 * a)) + big_r * big_r * (b - 0.5 * std::sin(2.0 * b));
  return area / (kPi * r * r);
}

LensRays::LensRays(const CameraSpec& camera)
    : model_(camera.model),
      lens_(camera.lens),
      thin_(lens_.focus_distance_mm > 0.0),
      principal_mm_(lens_.PrincipalDistance_mm()),
      centre_(model_.Centre().cast<float>()),
      world_from_camera_(model_.camera_from_world.rotation.transpose()) {}

std::optional<LensRays::LensRay> LensRays::Through(const Vec2d& px, const Vec2f& aperture) const {
  const std::optional<Vec2d> plane = model_.PlanePoint(px);
  if (!plane) return std::nullopt;
  const double stretch = std::abs(model_.distortion.Jacobian(*plane).determinant());
  const double radius = lens_.ApertureRadius_mm();
  const auto power4 = [](double x) { return x * x * x * x; };
  LensRay ray;
  if (!thin_) {
    const Vec3d in_camera = plane->homogeneous().normalized();
    double open = 1.0;
    if (lens_.stop_radius_mm > 0.0)
      open = DiscOverlap(radius, lens_.stop_radius_mm, lens_.stop_distance_mm * plane->norm());
    if (open <= 0.0) return std::nullopt;
    ray.origin = centre_;
    ray.direction = (world_from_camera_ * in_camera).cast<float>();
    ray.cos_field = static_cast<float>(in_camera.z());
    ray.falloff = static_cast<float>(power4(in_camera.z()) * open / stretch);
    return ray;
  }
  const Vec2d on_lens = radius * SampleUnitDisc(aperture).cast<double>();
  const Vec3d to_focus =
      lens_.focus_distance_mm * plane->homogeneous() - Vec3d(on_lens.x(), on_lens.y(), 0.0);
  const Vec3d in_camera = to_focus.normalized();
  if (lens_.stop_radius_mm > 0.0) {
    const Vec2d at_stop = on_lens + lens_.stop_distance_mm / in_camera.z() * in_camera.head<2>();
    if (at_stop.norm() > lens_.stop_radius_mm) return std::nullopt;
  }
  // The picture stands on its head behind the lens: the sensor's point is -s' plane.
  const double sideways = (on_lens + principal_mm_ * *plane).norm();
  const double cos_inside = principal_mm_ / std::hypot(principal_mm_, sideways);
  ray.origin =
      (model_.Centre() + world_from_camera_ * Vec3d(on_lens.x(), on_lens.y(), 0.0)).cast<float>();
  ray.direction = (world_from_camera_ * in_camera).cast<float>();
  ray.cos_field = static_cast<float>(in_camera.z());
  ray.falloff = static_cast<float>(power4(cos_inside) / stretch);
  return ray;
}

double LensRays::BlurRadius_px(double depth_mm) const {
  if (!thin_) return 0.0;
  const double s = lens_.focus_distance_mm, f = lens_.focal_length_mm;
  const double radius_mm =
      f * f / (2.0 * lens_.f_number) * std::abs(depth_mm - s) / (depth_mm * (s - f));
  return radius_mm * model_.fx / principal_mm_;
}

}  // namespace retrolux
