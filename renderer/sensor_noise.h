// The random numbers of a sensor.
#pragma once

#include "core/rng.h"

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

}  // namespace retrolux
