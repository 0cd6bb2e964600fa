#include "renderer/sensor.h"

#include <algorithm>
#include <cmath>

#include "renderer/camera_response.h"

namespace retrolux {

namespace {

// Product of uniforms until it falls below exp(-mean) (Knuth).
double PoissonBySteps(double mean, KeyedRng& rng) {
  const double limit = std::exp(-mean);
  double product = rng.NextDouble();
  double count = 0.0;
  while (product > limit) {
    product *= rng.NextDouble();
    count += 1.0;
  }
  return count;
}

double PoissonByRejection(double mean, KeyedRng& rng) {
  const double root = std::sqrt(mean);
  const double b = 0.931 + 2.53 * root;
  const double a = -0.059 + 0.02483 * b;
  const double v_r = 0.9277 - 3.6224 / (b - 2.0);
  while (true) {
    const double u = rng.NextDouble() - 0.5;
    const double v = rng.NextDouble();
    const double us = 0.5 - std::abs(u);
    const double k = std::floor((2.0 * a / us + b) * u + mean + 0.43);
    if (us >= 0.07 && v <= v_r) return k;
    if (k < 0.0 || (us < 0.013 && v > us)) continue;
    const double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4);
    if (std::log(v * inverse_alpha / (a / (us * us) + b)) <= -mean + k * std::log(mean) - std::lgamma(k + 1.0)) {
      return k;
    }
  }
}

}  // namespace

double SamplePoisson(double mean, KeyedRng& rng) {
  if (mean <= 0.0) return 0.0;
  return mean < 10.0 ? PoissonBySteps(mean, rng) : PoissonByRejection(mean, rng);
}

double SampleNormal(KeyedRng& rng) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - rng.NextDouble()));
  return radius * std::cos(2.0 * kPi * rng.NextDouble());
}

DigitalImage ExposeSensor(const FloatPlane& mean_electrons, const SensorSpec& sensor, double exposure_s,
                          uint64_t noise_key) {
  const double gain = GainDnPerElectron(sensor);
  const double dark_e = sensor.dark_current_e_s * exposure_s;
  const double max_dn = (1 << sensor.adc_bits) - 1;
  DigitalImage image;
  image.bits = sensor.adc_bits;
  image.dn = Plane<uint16_t>(mean_electrons.width, mean_electrons.height);
  for (size_t i = 0; i < mean_electrons.data.size(); ++i) {
    KeyedRng rng(CombineKeys(noise_key, i));
    const double collected = SamplePoisson(static_cast<double>(mean_electrons.data[i]) + dark_e, rng);
    const double electrons = std::min(collected, sensor.full_well_e) + sensor.read_noise_e * SampleNormal(rng);
    image.dn.data[i] =
        static_cast<uint16_t>(std::clamp(std::round(sensor.offset_dn + gain * electrons), 0.0, max_dn));
  }
  return image;
}

}  // namespace retrolux
