// Smear of an interline CCD: while charge is moved down its column in the shielded register, a
// little of the column's light leaks in.
#pragma once

#include <vector>

#include "core/plane.h"
#include "scenes/scene.h"

namespace retrolux {

// Mean charge that each pixel of a column collects on its way, e-, for each column:
//
//   ratio x line time / exposure x sum of the column's mean signal
//
// Charge of each line passes all lines of the column in steady light: those below it when it is
// read, those above it when the picture before was. The light is taken as constant in time. Light
// in pulses within the exposure does not smear at all (the register is emptied before the charges
// are moved into it): leave smear out then. The leak counts the light, also where it is more than
// the wells hold.
std::vector<double> SmearCharge(const Smear& smear, const FloatPlane& mean_electrons,
                                double exposure_s);

}  // namespace retrolux
