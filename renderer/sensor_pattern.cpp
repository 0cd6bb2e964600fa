#include "renderer/sensor_pattern.h"

#include <algorithm>

#include "core/hash.h"
#include "renderer/sensor_defects.h"
#include "renderer/sensor_noise.h"

namespace retrolux {

PixelPattern MakePixelPattern(const SensorSpec& sensor, const std::string& camera, int width,
                              int height) {
  const uint64_t part =
      HashBytes(sensor.serial.empty() ? camera : sensor.serial, HashBytes("sensor pattern"));
  const double dark_e_s = sensor.dark_current_e_s * sensor.DarkCurrentFactor();
  PixelPattern pattern{FloatPlane(width, height), FloatPlane(width, height),
                       FloatPlane(width, height, static_cast<float>(dark_e_s))};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      KeyedRng rng(PixelKey(part, x, y));
      // Below zero only beyond 5 sigma of the largest PRNU that a scene may ask for.
      pattern.response(x, y) =
          static_cast<float>(std::max(0.0, 1.0 + sensor.prnu * SampleNormal(rng)));
      pattern.offset_e(x, y) = static_cast<float>(sensor.dsnu_e * SampleNormal(rng));
    }
  }
  if (sensor.defects) AddDefects(*sensor.defects, sensor.DarkCurrentFactor(), part, pattern);
  return pattern;
}

}  // namespace retrolux
