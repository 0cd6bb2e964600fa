#include "analysis/cross_highlight.h"

#include <algorithm>
#include <cmath>

namespace retrolux {

Vec3d SphereHighlight(const Vec3d& centre, double radius_mm, const Vec3d& a, const Vec3d& b) {
  // Each step brings the normal nearer by about radius / distance.
  constexpr int kSteps = 60;
  Vec3d normal = (a - centre).normalized();
  for (int step = 0; step < kSteps; ++step) {
    const Vec3d at = centre + radius_mm * normal;
    normal = ((a - at).normalized() + (b - at).normalized()).normalized();
  }
  return centre + radius_mm * normal;
}

double HighlightBrdf(double ior, double alpha, double psi_deg) {
  const double half = 0.5 * RadFromDeg(psi_deg);
  const double cos_i = std::cos(half);
  const double cos_t = std::sqrt(1.0 - std::pow(std::sin(half) / ior, 2));
  const double across = (cos_i - ior * cos_t) / (cos_i + ior * cos_t);
  const double along = (ior * cos_i - cos_t) / (ior * cos_i + cos_t);
  const double fresnel = 0.5 * (across * across + along * along);
  const double masking = std::sqrt(1.0 + std::pow(alpha * std::tan(half), 2));
  return fresnel / (4.0 * kPi * alpha * alpha * cos_i * cos_i * masking);
}

double RingIrradiance_w_m2(const CameraSpec& camera, const Vec3d& x, const Vec3d& normal) {
  const DiodeRing& ring = *camera.ring;
  const Vec3d forward = camera.model.Forward();
  double sum = 0.0;
  for (int i = 0; i < ring.count; ++i) {
    const Vec3d towards = LedCentre(camera, i) - x;
    const double d2_m2 = 1e-6 * towards.squaredNorm();
    const double cos_led = std::max(0.0, -towards.normalized().dot(forward));
    const double cos_surface = std::max(0.0, towards.normalized().dot(normal));
    sum += ring.Intensity_w_sr() * std::pow(cos_led, ring.LambertExponent()) * cos_surface / d2_m2;
  }
  return sum;
}

double Separation_deg(const CameraModel& a, const CameraModel& b, const Vec3d& x) {
  const Vec3d to_a = a.Centre() - x, to_b = b.Centre() - x;
  return DegFromRad(std::atan2(to_a.cross(to_b).norm(), to_a.dot(to_b)));
}

}  // namespace retrolux
