// From the mean signal to the digital picture, by EMVA 1288's linear model (Release 4.0):
//   charge  Poisson(signal x response + dark current x time)     shot noise of the sum, PRNU
//           at most the full well
//           + the pixel's offset                                 DSNU
//           + Normal(0, read noise)
//   DN      round(offset + gain x charge), clipped to the range of the ADC
// and what the options of SensorSpec add, each where it happens (renderer/sensor_*.h). The signal
// is in photo-electrons: the quantum efficiency is in it already (camera_response.h).
#pragma once

#include "renderer/sensor_pattern.h"

namespace retrolux {

// The sensor of one camera. What its pixels have of their own is drawn once, so that all pictures
// share it.
class Sensor {
 public:
  // `camera` names the part if the sensor has no serial.
  Sensor(const SensorSpec& spec, const std::string& camera, int width, int height);
  explicit Sensor(const CameraSpec& camera);

  // One exposure (of each field, if the scan is interlaced) to a mean signal in electrons per
  // photosite. `picture_key` names the picture: its temporal noise depends on the key and on the
  // pixel alone, not on the order or on threads. Any number of threads may call it.
  DigitalImage Expose(const FloatPlane& mean_electrons, double exposure_s,
                      uint64_t picture_key) const;

 private:
  Plane<double> Collect(const FloatPlane& mean_electrons, double exposure_s, uint64_t key) const;
  DigitalImage ReadOut(const Plane<double>& charge_e, uint64_t key) const;

  SensorSpec spec_;
  PixelPattern pattern_;
};

}  // namespace retrolux
