#include "materials/beckmann.h"

namespace retrolux::beckmann {

namespace {

constexpr double kSteepest = 6.0;  // slopes beyond: below 1e-16 of the facets

// The slope s at which the share `u` of the density (cosine + s sine)+ exp(-s^2) is reached:
// Newton's method within a bracket that shrinks, so that it always converges.
double SlopeAt(double u, double cosine, double sine) {
  const double sqrt_pi = std::sqrt(kPi);
  const auto cumulated = [&](double s) {
    return 0.5 * cosine * std::erfc(-s) - 0.5 * sine * std::exp(-s * s) / sqrt_pi;
  };
  double low = cosine < kSteepest * sine ? -cosine / sine : -kSteepest;
  double high = kSteepest;
  const double from = cumulated(low);
  const double target = from + u * (cumulated(high) - from);
  double s = std::clamp(0.0, low, high);
  for (int i = 0; i < 60; ++i) {
    const double error = cumulated(s) - target;
    (error > 0.0 ? high : low) = s;
    const double density = (cosine + s * sine) * std::exp(-s * s) / sqrt_pi;
    double next = s - error / density;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - s) < 1e-9) return next;
    s = next;
  }
  return s;
}

}  // namespace

Vec3f SampleVisibleNormal(const Vec3f& w, float alpha, const Vec2f& u) {
  const Vec3d stretched = Vec3f(alpha * w.x(), alpha * w.y(), w.z()).cast<double>().normalized();
  const double sine = std::hypot(stretched.x(), stretched.y());
  const Vec2d towards = sine > 0.0 ? Vec2d(stretched.head<2>() / sine) : Vec2d::UnitX();
  const double along = SlopeAt(static_cast<double>(u.x()), stretched.z(), sine);
  const double across = SlopeAt(static_cast<double>(u.y()), 1.0, 0.0);
  const Vec2d slope = along * towards + across * Vec2d(-towards.y(), towards.x());
  const auto a = static_cast<double>(alpha);
  return Vec3d(a * slope.x(), a * slope.y(), 1.0).normalized().cast<float>();
}

}  // namespace retrolux::beckmann
