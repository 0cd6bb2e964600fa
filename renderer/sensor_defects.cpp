#include "renderer/sensor_defects.h"

#include "core/hash.h"

namespace retrolux {

void AddDefects(const DefectPixels& defects, double dark_current_factor, uint64_t part,
                PixelPattern& pattern) {
  const uint64_t key = CombineKeys(part, HashBytes("defect pixels"));
  const double dead = 1e-6 * defects.dead_per_million;
  const double hot = 1e-6 * defects.hot_per_million;
  const auto extra_e_s = static_cast<float>(defects.hot_dark_current_e_s * dark_current_factor);
  for (int y = 0; y < pattern.response.height; ++y) {
    for (int x = 0; x < pattern.response.width; ++x) {
      const double u = KeyedRng(PixelKey(key, x, y)).NextDouble();
      if (u < dead) {
        pattern.response(x, y) = 0.0f;
      } else if (u < dead + hot) {
        pattern.dark_current_e_s(x, y) += extra_e_s;
      }
    }
  }
}

}  // namespace retrolux
