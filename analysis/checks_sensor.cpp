// Checks of the sensor from its pictures alone, as EMVA 1288 does it.
#include <cmath>

#include "analysis/check.h"
#include "renderer/camera_response.h"
#include "renderer/sensor.h"

namespace retrolux {

namespace {

struct Statistics {
  double mean_dn, variance_dn2;  // temporal variance, from two frames of the same light
};

Statistics MeasureTwoFrames(const SensorSpec& sensor, double electrons, uint64_t key) {
  const FloatPlane light(256, 256, static_cast<float>(electrons));
  const DigitalImage a = ExposeSensor(light, sensor, 1e-3, CombineKeys(key, 1));
  const DigitalImage b = ExposeSensor(light, sensor, 1e-3, CombineKeys(key, 2));
  double sum = 0.0, difference2 = 0.0;
  for (size_t i = 0; i < a.dn.data.size(); ++i) {
    const double va = a.dn.data[i], vb = b.dn.data[i];
    sum += va + vb;
    difference2 += (va - vb) * (va - vb);
  }
  const auto n = static_cast<double>(a.dn.data.size());
  return {0.5 * sum / n, 0.5 * difference2 / n};
}

// Slope of the variance over the mean, from 0.1 to 0.7 of saturation, by least squares with an
// intercept. EMVA 1288 puts the line through the dark picture, which needs a dark noise of 0.24 DN
// or more; 8 bits on 30,000 e- leave 0.17 DN, and what quantisation adds to the dark picture is
// then not the 1/12 DN^2 that it adds to all others.
double PhotonTransferGain(const SensorSpec& sensor) {
  constexpr int kLevels = 24;
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (int i = 0; i <= kLevels; ++i) {
    const double share = 0.1 + 0.6 * i / kLevels;
    const Statistics s =
        MeasureTwoFrames(sensor, share * sensor.full_well_e, 100 + static_cast<uint64_t>(i));
    n += 1.0;
    sx += s.mean_dn;
    sy += s.variance_dn2;
    sxx += s.mean_dn * s.mean_dn;
    sxy += s.mean_dn * s.variance_dn2;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace

std::vector<Check> CheckPhotonTransfer() {
  // The standard error of a variance from n = 65,536 pixels is sqrt(2/n) = 0.55 %; of the slope
  // over 25 levels about 0.3 %.
  SensorSpec twelve_bit;
  twelve_bit.adc_bits = 12;
  twelve_bit.offset_dn = 50.0;
  const double gain = GainDnPerElectron(twelve_bit);
  const Statistics dark = MeasureTwoFrames(twelve_bit, 0.0, 7);
  const std::string source = "EMVA 1288: the slope of sigma_y^2 over mu_y is K";
  return {{"gain K, 12 bit", PhotonTransferGain(twelve_bit), gain, 0.01 * gain, "DN/e-", source},
          {"gain K, 8 bit", PhotonTransferGain(SensorSpec{}), GainDnPerElectron(SensorSpec{}),
           0.01 * GainDnPerElectron(SensorSpec{}), "DN/e-", source},
          {"temporal dark noise, 12 bit", std::sqrt(dark.variance_dn2 - 1.0 / 12.0) / gain,
           twelve_bit.read_noise_e, 0.02 * twelve_bit.read_noise_e, "e-",
           "sigma_d = sqrt(sigma_y.dark^2 - 1/12) / K"}};
}

}  // namespace retrolux
