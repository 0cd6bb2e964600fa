// Checks of the sensor from its pictures and the known light alone, as EMVA 1288 does it. What is
// expected is what the sensor was described with, and closed forms of it; the measurement
// (emva1288.h) knows neither.
#include <cmath>

#include "analysis/check.h"
#include "analysis/emva1288.h"
#include "renderer/camera_response.h"
#include "renderer/sensor.h"
#include "scenes/scene_json_sensor.h"

namespace retrolux {

namespace {

constexpr int kSide_px = 256;
constexpr double kPixels = kSide_px * kSide_px;
constexpr double kExposure_s = 1e-3;
constexpr double kQuantumEfficiency = 0.08;  // of the light of these checks
constexpr int kLevelsToFullWell = 100;
constexpr int kStack = 32;  // pictures for the fixed pattern

std::vector<DigitalImage> Pictures(const Sensor& sensor, double electrons, int count,
                                   uint64_t key) {
  const FloatPlane light(kSide_px, kSide_px, static_cast<float>(electrons));
  std::vector<DigitalImage> pictures;
  for (int i = 0; i < count; ++i)
    pictures.push_back(
        sensor.Expose(light, kExposure_s, CombineKeys(key, static_cast<uint64_t>(i))));
  return pictures;
}

double LevelElectrons(const SensorSpec& spec, int level) {
  return spec.full_well_e * level / kLevelsToFullWell;
}

// From the dark to 6 % above the full well.
constexpr int kLevels = kLevelsToFullWell + 6;
std::vector<EvenPictures> LightSeries(const Sensor& sensor, const SensorSpec& spec) {
  std::vector<EvenPictures> series;
  for (int i = 0; i <= kLevels; ++i) {
    const double electrons = LevelElectrons(spec, i);
    series.push_back({electrons / kQuantumEfficiency,
                      Pictures(sensor, electrons, 2, 100 + static_cast<uint64_t>(i))});
  }
  return series;
}

// Variance of min(N, W), N normal about `mean` with the variance `mean`: with z = (W - mean) /
// sigma, E = sigma (z (1 - Phi) - phi) and E2 = sigma^2 (Phi - z phi + z^2 (1 - Phi)) about `mean`.
double ClippedVariance(double mean, double well) {
  const double sigma = std::sqrt(mean), z = (well - mean) / sigma;
  const double phi = std::exp(-0.5 * z * z) / std::sqrt(2.0 * kPi);
  const double above = 0.5 * std::erfc(z / std::numbers::sqrt2);
  const double e = z * above - phi;
  return mean * (1.0 - above - z * phi + z * z * above - e * e);
}

// Its mean over the pixels, whose signals spread by the PRNU.
double MeanClippedVariance(double mean, const SensorSpec& spec) {
  double sum = 0.0, weights = 0.0;
  for (double t = -5.0; t <= 5.0; t += 0.05) {
    const double weight = std::exp(-0.5 * t * t);
    sum += weight * ClippedVariance(mean * (1.0 + spec.prnu * t), spec.full_well_e);
    weights += weight;
  }
  return sum / weights;
}

// Where the variance is largest, and how far from there it may be found: at any level whose
// variance differs from that by less than 4 standard errors, sqrt(2 / pixels) of each.
struct Saturation {
  double electrons = 0.0, reach = 0.0;
};
Saturation ExpectedSaturation(const SensorSpec& spec) {
  const double dark = spec.read_noise_e * spec.read_noise_e;
  double largest = 0.0;
  Saturation saturation;
  const auto variance = [&](int i) {
    return dark + MeanClippedVariance(LevelElectrons(spec, i), spec);
  };
  for (int i = 1; i <= kLevels; ++i) {
    if (variance(i) <= largest) continue;
    largest = variance(i);
    saturation.electrons = LevelElectrons(spec, i);
  }
  for (int i = 1; i <= kLevels; ++i) {
    if (largest - variance(i) < 4.0 * std::sqrt(2.0) * std::sqrt(2.0 / kPixels) * largest) {
      saturation.reach =
          std::max(saturation.reach, std::abs(LevelElectrons(spec, i) - saturation.electrons));
    }
  }
  return saturation;
}

// The default sensor on an ADC whose steps are small beside the noise and that ends above the full
// well, so that each figure has a closed form.
SensorSpec TwelveBit() {
  SensorSpec spec;
  spec.adc_bits = 12;
  spec.offset_dn = 50.0;
  spec.gain_dn_e = 0.12;
  return spec;
}

std::vector<Check> CheckTwelveBit() {
  const SensorSpec spec = TwelveBit();
  const Sensor sensor(spec, "check", kSide_px, kSide_px);
  const Emva1288 found = MeasureEmva1288(LightSeries(sensor, spec));
  const NonUniformity pattern =
      MeasureNonUniformity(Pictures(sensor, 0.0, kStack, 7),
                           Pictures(sensor, 0.5 * spec.full_well_e, kStack, 8), found.gain_dn_e);

  // A variance from n pixels has the relative standard error sqrt(2 / n) = 0.55 %. The slope
  // through zero over N levels up to 70 % has 3 / sqrt(5 N) of that: 0.09 %.
  const double gain_error = 3.0 / std::sqrt(5.0 * 70.0) * std::sqrt(2.0 / kPixels);
  const double dark2 = spec.read_noise_e * spec.read_noise_e + spec.dark_current_e_s * kExposure_s;
  const double step2 = 1.0 / 12.0 / (spec.gain_dn_e * spec.gain_dn_e);
  const double dark_error = 0.5 * std::sqrt(2.0 / kPixels) * (dark2 + step2) / dark2;
  // A spatial variance s^2 from the mean of L pictures has sqrt(2 / n) (s^2 + sigma^2 / L).
  const double dsnu2 = spec.dsnu_e * spec.dsnu_e;
  const double dsnu_error =
      0.5 * std::sqrt(2.0 / kPixels) * (dsnu2 + (dark2 + step2) / kStack) / dsnu2;
  const double half_e = 0.5 * spec.full_well_e, prnu2 = std::pow(spec.prnu * half_e, 2);
  const double prnu_error =
      0.5 * std::sqrt(2.0 / kPixels) * (prnu2 + dsnu2 + (half_e + dark2 + step2) / kStack) / prnu2;
  const Saturation saturation = ExpectedSaturation(spec);
  const double threshold_e = std::sqrt(dark2 + step2) + 0.5;
  const double saturation_error = saturation.reach / saturation.electrons + 5.0 * gain_error;
  const double first_e = 0.05 * saturation.electrons;
  const double linearity_error =
      100.0 * std::sqrt((first_e + dark2 + step2) / (2.0 * kPixels)) / first_e;

  return {
      {"gain K, 12 bit", found.gain_dn_e, spec.gain_dn_e, 5.0 * gain_error * spec.gain_dn_e,
       "DN/e-", "as described; slope of sigma_y^2 over mu_y; 5 standard errors (0.45 %)"},
      {"quantum efficiency", found.quantum_efficiency, kQuantumEfficiency,
       5.0 * gain_error * kQuantumEfficiency, "e-/photon",
       "electrons over photons of the light; R / K; 5 standard errors of K"},
      {"temporal dark noise, 12 bit", found.temporal_dark_noise_e, std::sqrt(dark2),
       5.0 * (dark_error + gain_error) * std::sqrt(dark2), "e-",
       "sqrt(read noise^2 + dark current t); 5 standard errors"},
      {"saturation capacity", found.saturation_e, saturation.electrons,
       saturation_error * saturation.electrons, "e-",
       "maximum of the variance of a normal number clipped at the full well, over the PRNU; all "
       "levels within 4 standard errors of it, and 5 of K"},
      {"largest signal to noise", found.snr_max, std::sqrt(saturation.electrons),
       0.5 * saturation_error * std::sqrt(saturation.electrons), "",
       "sqrt(saturation capacity); half its relative tolerance"},
      {"dynamic range", found.dynamic_range, saturation.electrons / threshold_e,
       (saturation_error + 5.0 * (dark_error + gain_error)) * saturation.electrons / threshold_e,
       "", "saturation over sqrt(sigma_d^2 + 1 / (12 K^2)) + 0.5; tolerances of both"},
      {"linearity error", found.linearity_error_percent, 0.0, 5.0 * linearity_error, "%",
       "a linear sensor; 5 standard errors of the lowest level's mean"},
      {"DSNU", pattern.dsnu_e, spec.dsnu_e, 5.0 * (dsnu_error + gain_error) * spec.dsnu_e, "e-",
       "as described; 5 standard errors of 65,536 pixels and 32 pictures"},
      {"PRNU", 100.0 * pattern.prnu, 100.0 * spec.prnu, 5.0 * prnu_error * 100.0 * spec.prnu, "%",
       "as described; 5 standard errors of 65,536 pixels and 32 pictures"}};
}

// 8 bits on 30,000 e- leave 0.17 DN of dark noise: the gain comes from a line with an intercept
// over the 60 levels from 10 to 70 %. Var(slope) = sum (x - mean)^2 var_i / (sum (x - mean)^2)^2
// with the errors sqrt(2 / n) K x_i of the variances: 0.16 %.
Check CheckEightBit() {
  const SensorSpec spec;
  const double gain = GainDnPerElectron(spec);
  const Sensor sensor(spec, "check", kSide_px, kSide_px);
  const double found = MeasureEmva1288(LightSeries(sensor, spec)).gain_dn_e;
  return {"gain K, 8 bit",
          found,
          gain,
          5.0 * 0.0016 * gain,
          "DN/e-",
          "full well is the largest number; slope of sigma_y^2 over mu_y; 5 standard errors"};
}

// A part whose maker's measurement gives the threshold beside the figures that the preset is made
// of.
Check CheckDataSheet() {
  const SensorSpec spec = SensorPreset("imx900");
  const Sensor sensor(spec, "check", kSide_px, kSide_px);
  const double published_e = 6.106;
  return {
      "sensitivity threshold, IMX900",
      MeasureEmva1288(LightSeries(sensor, spec)).sensitivity_threshold_e,
      published_e,
      5.0 * (0.5 * std::sqrt(2.0 / kPixels) + 0.0009) * published_e,
      "e-",
      "FRAMOS, EMVA 1288 data sheet of the IMX900-AMR-C; 5 standard errors of the dark picture's "
      "noise and of K"};
}

}  // namespace

std::vector<Check> CheckPhotonTransfer() {
  std::vector<Check> checks = CheckTwelveBit();
  checks.push_back(CheckEightBit());
  checks.push_back(CheckDataSheet());
  return checks;
}

}  // namespace retrolux
