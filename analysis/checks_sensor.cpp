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

// Slope through the origin of (variance - dark variance) over (mean - dark mean) from 0 to 70 % of saturation.
double PhotonTransferGain(const SensorSpec& sensor) {
  constexpr int kLevels = 24;
  const Statistics dark = MeasureTwoFrames(sensor, 0.0, 100);
  double xy = 0.0, xx = 0.0;
  for (int i = 1; i <= kLevels; ++i) {
    const Statistics bright = MeasureTwoFrames(sensor, 0.7 * sensor.full_well_e * i / kLevels, 100 + static_cast<uint64_t>(i));
    const double x = bright.mean_dn - dark.mean_dn;
    xy += x * (bright.variance_dn2 - dark.variance_dn2);
    xx += x * x;
  }
  return xy / xx;
}

}  // namespace

std::vector<Check> CheckPhotonTransfer() {
  // The standard error of a variance from n = 65,536 pixels is sqrt(2/n) = 0.55 %; over 24 levels about 0.2 %.
  SensorSpec twelve_bit;
  twelve_bit.adc_bits = 12;
  twelve_bit.offset_dn = 50.0;
  const double gain = GainDnPerElectron(twelve_bit);
  const Statistics dark = MeasureTwoFrames(twelve_bit, 0.0, 7);
  const std::string source = "EMVA 1288: sigma_y^2 - sigma_dark^2 = K (mu_y - mu_dark)";
  return {{"gain K, 12 bit", PhotonTransferGain(twelve_bit), gain, 0.01 * gain, "DN/e-", source},
          {"gain K, 8 bit", PhotonTransferGain(SensorSpec{}), GainDnPerElectron(SensorSpec{}), 0.01 * GainDnPerElectron(SensorSpec{}), "DN/e-",
           source + "; the quantisation noise of the dark picture is not 1/12 here, which costs a part of the tolerance"},
          {"temporal dark noise, 12 bit", std::sqrt(dark.variance_dn2 - 1.0 / 12.0) / gain, twelve_bit.read_noise_e,
           0.02 * twelve_bit.read_noise_e, "e-", "sigma_d = sqrt(sigma_y.dark^2 - 1/12) / K"}};
}

}  // namespace retrolux
