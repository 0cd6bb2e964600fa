// How noisy one pixel's signal is.
#pragma once

#include "scenes/scene.h"

namespace retrolux {

// Standard deviation in e- of what is read of a pixel whose photosites have a mean signal of
// `mean_e` each, over exposures and over pixels (EMVA 1288, Release 4.0): with n lines that are
// read as one row,
//   sigma^2 = n (S + D + (PRNU S)^2 + DSNU^2) + read^2 + q^2 / 12
// S the signal, D the dark signal of the exposure, q the electrons of one DN.
double NoiseSigma_e(const SensorSpec& sensor, double exposure_s, double mean_e);

}  // namespace retrolux
