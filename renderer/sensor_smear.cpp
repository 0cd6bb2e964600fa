#include "renderer/sensor_smear.h"

namespace retrolux {

std::vector<double> SmearCharge(const Smear& smear, const FloatPlane& mean_electrons,
                                double exposure_s) {
  const double share = smear.ratio * smear.line_time_s / exposure_s;
  std::vector<double> charge_e(static_cast<size_t>(mean_electrons.width), 0.0);
  for (int y = 0; y < mean_electrons.height; ++y) {
    for (int x = 0; x < mean_electrons.width; ++x)
      charge_e[static_cast<size_t>(x)] += share * static_cast<double>(mean_electrons(x, y));
  }
  return charge_e;
}

}  // namespace retrolux
