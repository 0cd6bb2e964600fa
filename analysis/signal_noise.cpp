#include "analysis/signal_noise.h"

#include <cmath>

#include "renderer/camera_response.h"

namespace retrolux {

double NoiseSigma_e(const SensorSpec& sensor, double exposure_s, double mean_e) {
  const double dark_e = sensor.dark_current_e_s * sensor.DarkCurrentFactor() * exposure_s;
  const double electrons_per_dn = 1.0 / GainDnPerElectron(sensor);
  const auto square = [](double x) { return x * x; };
  return std::sqrt(sensor.LinesPerRow() *
                       (mean_e + dark_e + square(sensor.prnu * mean_e) + square(sensor.dsnu_e)) +
                   square(sensor.read_noise_e) + square(electrons_per_dn) / 12.0);
}

}  // namespace retrolux
