// From radiance in front of a camera to photo-electrons in its pixels, over wavelength and field
// angle.
//
//   electrons = pi / (4 N^2) T_lens A_pixel t cos^4(theta)  *  integral of L T_filter(lambda,
//   theta) QE lambda / (h c)
//
// (distant object; the pinhole's f-number enters the irradiance only). The integral is estimated
// with one wavelength for each spectrum of light, drawn from emission x filter x quantum efficiency
// x lambda. The filter shifts with the angle, so the density takes the largest transmission over
// the camera's field.
#pragma once

#include "renderer/lights.h"

namespace retrolux {

class CameraResponse {
 public:
  CameraResponse(const CameraSpec& camera, const std::vector<Spectrum>& spectra, double exposure_s);

  // One wavelength for each spectrum, for u uniform on [0, 1).
  Spectral SampleWavelengths(float u) const;

  // What weighs a band radiance (W/(m2 sr), whole spectrum of its light) along a ray of the camera
  // at field angle theta, if the path used the wavelengths `nm`.
  struct Weights {
    Spectral electrons;  // e- per W/(m2 sr)
    Spectral in_band;    // share that passes the filter, relative to its peak: gives `radiance.Y`
  };
  Weights WeightsAt(const Spectral& nm, float cos_theta) const;

  // Electrons per W/(m2 sr) of spectrum k that does not change with wavelength, at field angle
  // theta, by quadrature: what the mean of WeightsAt(...).electrons must be.
  double ExpectedElectrons(int spectrum, double cos_theta) const;

  double FullScaleElectrons() const { return full_scale_e_; }
  const CameraSpec& Camera() const { return camera_; }
  double ExposureSeconds() const { return exposure_s_; }

 private:
  double FilterAt(double nm, double sin_theta) const;
  double GeometricFactor(double cos_theta) const;

  struct Band {
    std::vector<float> cumulative;             // over 1 nm cells, ends at 1
    std::vector<float> emission_over_density;  // at the cell centres
    double total = 0.0;
  };
  Band MakeBand(const Spectrum& emission) const;

  CameraSpec camera_;
  double exposure_s_ = 0.0;
  double max_sin_theta_ = 0.0;
  double full_scale_e_ = 0.0;
  Spectrum quantum_efficiency_;
  std::vector<Spectrum> spectra_;
  std::vector<Band> bands_;
};

// DN per electron of a sensor: as given, or such that a full well is the largest number of the ADC.
double GainDnPerElectron(const SensorSpec& sensor);

}  // namespace retrolux
