// What a sensor does, measured from its pictures alone as EMVA 1288 (Release 4.0, linear model)
// does it. Nothing here knows how the pictures were made.
#pragma once

#include <vector>

#include "core/plane.h"

namespace retrolux {

// Pictures of the same even light, all exposed for the same time.
struct EvenPictures {
  double photons = 0.0;  // mean number that falls on a pixel
  std::vector<DigitalImage> pictures;
};

// Mean grey value, and temporal variance of one picture from the differences of successive ones,
// which the fixed pattern does not touch. Two pictures at least.
struct TemporalStatistics {
  double mean_dn = 0.0, variance_dn2 = 0.0;
};
TemporalStatistics MeasureTemporal(const std::vector<DigitalImage>& pictures);

// Variance over the pixels of the mean of L pictures, less what the temporal noise leaves in it,
// sigma^2 / L.
double SpatialVariance_dn2(const std::vector<DigitalImage>& pictures);

struct Emva1288 {
  double responsivity_dn = 0.0;          // R, DN per photon
  double gain_dn_e = 0.0;                // K, system gain
  double quantum_efficiency = 0.0;       // R / K
  double temporal_dark_noise_e = 0.0;    // sigma_d; 0 if lost in quantisation
  double saturation_photons = 0.0;       // where the variance is largest
  double saturation_e = 0.0;             // saturation capacity
  double sensitivity_threshold_e = 0.0;  // signal with a signal-to-noise ratio of 1
  double snr_max = 0.0;                  // sqrt(saturation capacity)
  double dynamic_range = 0.0;            // saturation over threshold
  double linearity_error_percent = 0.0;  // largest deviation from the line, of its value
};

// From a series of light: the first level dark, the others in ascending order to beyond saturation,
// two pictures or more each.
//   K    slope of sigma^2 - sigma_dark^2 over mu - mu_dark, a line through zero, up to 70 % of
//        saturation. Where the dark picture's variance is below 0.24 DN^2, quantisation adds
//        something else to it than the 1/12 DN^2 that it adds to all others: then a line with an
//        intercept from 10 % on, and no dark noise.
//   R    slope of mu - mu_dark over photons, through zero, in the same range
//   linearity  mu - mu_dark against photons from 5 to 95 % of saturation, least squares of the
//        relative deviation
Emva1288 MeasureEmva1288(const std::vector<EvenPictures>& series);

// Dark-signal non-uniformity DSNU1288 in electrons, and photo-response non-uniformity PRNU1288 of
// the signal, from some tens of pictures in the dark and at half of saturation.
struct NonUniformity {
  double dsnu_e = 0.0, prnu = 0.0;
};
NonUniformity MeasureNonUniformity(const std::vector<DigitalImage>& dark,
                                   const std::vector<DigitalImage>& half, double gain_dn_e);

}  // namespace retrolux
