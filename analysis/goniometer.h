// The renderer as an instrument that measures retro-reflection: the goniometer of CIE 54.2 and ASTM
// E810.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/conventions.h"

namespace retrolux {

struct GoniometerOptions {
  std::vector<double> observation_deg = {0.2, 0.33, 1.0, 1.5};  // alpha, above 0 to 20
  std::vector<double> entrance_deg = {5.0, 20.0, 30.0, 40.0};   // beta_1, -85 to 85
  double beta2_deg = 0.0;                                       // of all, -85 to 85
  double distance_mm = 15000.0;                                 // of lamp and receiver, as E810's
  int samples = 4096;  // light paths a reading; more only narrow the standard error
  uint64_t seed = 1;
  bool exchanged = false;  // lamp and receiver in each other's place
  void Check() const;      // InputError
};

struct GoniometerReading {
  double observation_deg, beta1_deg, beta2_deg;
  double entrance_deg;    // beta: illumination axis to the sheet's normal
  double viewing_deg;     // nu: observation axis to the normal
  double ra;              // cd/(lx m2), the same number in 1/sr
  double standard_error;  // of ra, from the scatter of the light paths (an upper bound)
};

// Directions of illumination and observation, unit vectors in the sheet's frame (z: its normal).
// With the illumination axis along z and the observation axis in the half-plane x > 0, the normal
// is
//   n = (sin beta_1 cos beta_2, sin beta_2, cos beta_1 cos beta_2)     (CIE 54.2)
// so that cos beta = cos beta_1 cos beta_2 and cos nu = cos beta_2 cos(beta_1 - alpha).
struct GoniometerAxes {
  Vec3d illumination, observation;
};
GoniometerAxes AxesOf(double observation_deg, double beta1_deg, double beta2_deg);

// R_A = L cos(nu) d^2 / I of a patch of the material, {"type": ...}, under one small lamp, rendered
// by the path tracer as any scene is: a reading for each pair of angles, the observation angle
// outermost. Sheets are taken to be isotropic: rotation about the normal is not an option.
// Wavelengths are those of the lamp, an 880 nm diode.
std::vector<GoniometerReading> MeasureRetroReflection(const nlohmann::json& material,
                                                      const GoniometerOptions& options);

}  // namespace retrolux
