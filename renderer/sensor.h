// From the mean signal to the digital picture, by EMVA 1288's linear model:
//   electrons  Poisson(signal + dark current x time)      shot noise
//              at most the full well
//              + Normal(0, read noise)
//   DN         round(offset + gain x electrons), clipped to the range of the ADC
#pragma once

#include "core/plane.h"
#include "core/rng.h"
#include "scenes/scene.h"

namespace retrolux {

// A number of the Poisson distribution of the given mean, exact: inversion below 10, transformed
// rejection (Hoermann, Insurance: Mathematics and Economics 12, 1993, PTRS) from there on. mean in
// [0, 1e9].
double SamplePoisson(double mean, KeyedRng& rng);

// Where the standard normal distribution has the cumulated probability p in (0, 1): a rational
// approximation with a relative error below 1.2e-9 (Acklam 2003).
double InverseNormalCdf(double p);

// A number of the standard normal distribution, by inversion.
double SampleNormal(KeyedRng& rng);

// `noise_key` names the picture; each pixel has its own numbers, whatever the order.
DigitalImage ExposeSensor(const FloatPlane& mean_electrons, const SensorSpec& sensor,
                          double exposure_s, uint64_t noise_key);

}  // namespace retrolux
