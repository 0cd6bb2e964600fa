// How a patient moves who breathes, drifts and coughs.
#pragma once

#include <vector>

#include "core/transform.h"

namespace retrolux {

// Displacement of the mask's origin from its reference over time, and a nod about the mask's y axis
// that goes with the cough. World axes. What is known of such motion, and what is assumed:
// docs/stereo.md.
struct MotionProfile {
  // Lujan et al., Med. Phys. 26(5), 1999: a cos^2n, so that more time is spent breathed out.
  Vec3d breath_mm = Vec3d(0.3, 0.0, 0.15);
  double breath_period_s = 4.0;
  int breath_exponent = 3;  // n
  // A steady sinking; minutes of it pressed into seconds.
  Vec3d drift_mm_s = Vec3d(-0.04, 0.02, 0.0);
  // A pulse sin^2 of that length.
  double cough_start_s = 3.0;
  double cough_length_s = 0.5;
  Vec3d cough_mm = Vec3d(2.0, 0.3, 0.8);
  double cough_nod_deg = 0.6;

  Vec3d Displacement_mm(double time_s) const;
  // world_now_from_reference, the turn about the origin of the reference.
  RigidTransform At(double time_s) const;
  // The first time up to `end_s` at which the displacement is longer than the limit; to 0.1 ms.
  // Negative: never.
  double FirstCrossing_s(double limit_mm, double end_s) const;
};

}  // namespace retrolux
