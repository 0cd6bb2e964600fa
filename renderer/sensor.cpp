#include "renderer/sensor.h"

#include <algorithm>

#include "core/error.h"
#include "core/hash.h"
#include "renderer/camera_response.h"
#include "renderer/sensor_blooming.h"
#include "renderer/sensor_fields.h"
#include "renderer/sensor_noise.h"
#include "renderer/sensor_smear.h"

namespace retrolux {

namespace {

// Each source of temporal noise has numbers of its own.
constexpr uint64_t kSmearNoise = HashBytes("smear noise");
constexpr uint64_t kReadNoise = HashBytes("read noise");
constexpr uint64_t kSecondField = HashBytes("second field");

void AddSmear(const Smear& smear, const FloatPlane& mean_electrons, double exposure_s, uint64_t key,
              Plane<double>& charge_e) {
  const std::vector<double> mean_e = SmearCharge(smear, mean_electrons, exposure_s);
  for (size_t i = 0; i < charge_e.data.size(); ++i) {
    KeyedRng rng(CombineKeys(key, i));
    charge_e.data[i] += SamplePoisson(mean_e[i % mean_e.size()], rng);
  }
}

}  // namespace

Sensor::Sensor(const SensorSpec& spec, const std::string& camera, int width, int height)
    : spec_(spec), pattern_(MakePixelPattern(spec, camera, width, height)) {}

Sensor::Sensor(const CameraSpec& camera)
    : Sensor(camera.sensor, camera.model.name, camera.model.width, camera.model.height) {}

// The charges of all photosites at the end of an exposure, as they are read.
Plane<double> Sensor::Collect(const FloatPlane& mean_electrons, double exposure_s,
                              uint64_t key) const {
  Plane<double> charge_e(mean_electrons.width, mean_electrons.height);
  for (size_t i = 0; i < charge_e.data.size(); ++i) {
    const double mean_e = static_cast<double>(mean_electrons.data[i] * pattern_.response.data[i]) +
                          static_cast<double>(pattern_.dark_current_e_s.data[i]) * exposure_s;
    KeyedRng rng(CombineKeys(key, i));
    charge_e.data[i] = SamplePoisson(mean_e, rng);
  }
  if (spec_.blooming) Bloom(*spec_.blooming, spec_.full_well_e, charge_e);
  for (size_t i = 0; i < charge_e.data.size(); ++i) {
    charge_e.data[i] = std::min(charge_e.data[i], spec_.full_well_e) +
                       static_cast<double>(pattern_.offset_e.data[i]);
  }
  // In the register, which holds more than a photosite.
  if (spec_.smear) {
    AddSmear(*spec_.smear, mean_electrons, exposure_s, CombineKeys(key, kSmearNoise), charge_e);
  }
  return charge_e;
}

DigitalImage Sensor::ReadOut(const Plane<double>& charge_e, uint64_t key) const {
  const double gain = GainDnPerElectron(spec_);
  const double max_dn = (1 << spec_.adc_bits) - 1;
  DigitalImage image;
  image.bits = spec_.adc_bits;
  image.dn = Plane<uint16_t>(charge_e.width, charge_e.height);
  KeyedRng rng(key);  // one number for each pixel, in their order
  for (size_t i = 0; i < charge_e.data.size(); ++i) {
    const double dn =
        spec_.offset_dn + gain * (charge_e.data[i] + spec_.read_noise_e * SampleNormal(rng));
    image.dn.data[i] = static_cast<uint16_t>(std::clamp(dn, 0.0, max_dn) + 0.5);  // rounds
  }
  return image;
}

DigitalImage Sensor::Expose(const FloatPlane& mean_electrons, double exposure_s,
                            uint64_t picture_key) const {
  RETROLUX_CHECK(mean_electrons.width == pattern_.response.width &&
                     mean_electrons.height == pattern_.response.height,
                 "a signal of {} x {} px on a sensor of {} x {} px", mean_electrons.width,
                 mean_electrons.height, pattern_.response.width, pattern_.response.height);
  Plane<double> charge_e = Collect(mean_electrons, exposure_s, picture_key);
  if (spec_.scan == Scan::kInterlaced) {
    charge_e = WeaveFields(
        charge_e, Collect(mean_electrons, exposure_s, CombineKeys(picture_key, kSecondField)));
  }
  return ReadOut(charge_e, CombineKeys(picture_key, kReadNoise));
}

}  // namespace retrolux
