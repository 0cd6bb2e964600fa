#include "analysis/motion_profile.h"

#include <cmath>

namespace retrolux {

namespace {

double CoughAt(const MotionProfile& profile, double time_s) {
  const double phase = (time_s - profile.cough_start_s) / profile.cough_length_s;
  if (phase <= 0.0 || phase >= 1.0) return 0.0;
  return std::pow(std::sin(kPi * phase), 2);
}

}  // namespace

Vec3d MotionProfile::Displacement_mm(double time_s) const {
  // Breathed out at time 0.
  const double breath = std::pow(std::sin(kPi * time_s / breath_period_s), 2 * breath_exponent);
  return breath * breath_mm + time_s * drift_mm_s + CoughAt(*this, time_s) * cough_mm;
}

RigidTransform MotionProfile::At(double time_s) const {
  const double nod = RadFromDeg(cough_nod_deg) * CoughAt(*this, time_s);
  return {Eigen::AngleAxisd(nod, Vec3d::UnitY()).toRotationMatrix(), Displacement_mm(time_s)};
}

double MotionProfile::FirstCrossing_s(double limit_mm, double end_s) const {
  constexpr double kStep_s = 1e-4;
  for (int i = 0; i * kStep_s <= end_s; ++i) {
    if (Displacement_mm(i * kStep_s).norm() > limit_mm) return i * kStep_s;
  }
  return -1.0;
}

}  // namespace retrolux
