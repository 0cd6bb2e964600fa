// Defect pixels: hot ones, whose dark current is larger, and dead ones, which do not see light.
#pragma once

#include "renderer/sensor_pattern.h"

namespace retrolux {

// Each pixel is hot or dead by itself, with the probability that the counts per million say; their
// number is binomial. `part` names the sensor.
void AddDefects(const DefectPixels& defects, double dark_current_factor, uint64_t part,
                PixelPattern& pattern);

}  // namespace retrolux
