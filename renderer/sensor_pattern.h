// What the pixels of one sensor have of their own: the same in each of its pictures.
#pragma once

#include <string>

#include "core/plane.h"
#include "core/rng.h"
#include "scenes/scene.h"

namespace retrolux {

struct PixelPattern {
  FloatPlane response;          // to light, relative; mean 1
  FloatPlane offset_e;          // added to the charge when it is read, e-; mean 0
  FloatPlane dark_current_e_s;  // at the sensor's temperature
};

// The numbers of a pixel of the part, whatever the size of the picture.
constexpr uint64_t PixelKey(uint64_t part, int x, int y) {
  return CombineKeys(part, static_cast<uint64_t>(y) << 32 | static_cast<uint64_t>(x));
}

// Normal numbers about the mean, 1 sigma `prnu` and `dsnu_e` (EMVA 1288), and defect pixels if the
// sensor has any. They depend on the sensor's serial (or `camera`, if it has none) and on the
// pixel's place alone.
PixelPattern MakePixelPattern(const SensorSpec& sensor, const std::string& camera, int width,
                              int height);

}  // namespace retrolux
