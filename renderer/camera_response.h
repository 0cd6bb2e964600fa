// From radiance in front of a camera to photo-electrons in its pixels, over wavelength and field
// angle.
//
//   electrons = pi / (4 N^2) T_lens A_pixel t falloff  *  integral of L T_filter(lambda, theta) QE
//   lambda / (h c)
//
// with the fall-off of renderer/lens.h (cos^4 of a pinhole) and A_pixel on the plane at the focal
// length (with N, that is the same for a thin lens wherever its sensor stands). The integral is
// estimated with one wavelength for each spectrum of light, drawn from emission x filter x quantum
// efficiency x lambda. The filter's band shifts with the angle, so there is a density for each of
// kAngles steps of the field; what is left of the scatter is the shift within a step.
#pragma once

#include "renderer/lights.h"

namespace retrolux {

class CameraResponse {
 public:
  CameraResponse(const CameraSpec& camera, const std::vector<Spectrum>& spectra, double exposure_s);

  // One wavelength for each spectrum, for u uniform on [0, 1), of light that meets the filter at
  // angle theta.
  Spectral SampleWavelengths(float u, float cos_theta) const;

  // What weighs a band radiance (W/(m2 sr), whole spectrum of its light) along a ray that meets the
  // filter at angle theta and falls on the sensor with `falloff`, if the path used the wavelengths
  // `nm` that were sampled for the same angle.
  struct Weights {
    Spectral electrons;  // e- per W/(m2 sr)
    Spectral in_band;    // share that passes the filter, relative to its peak: gives `radiance.Y`
  };
  Weights WeightsAt(const Spectral& nm, float cos_theta, float falloff) const;

  // Electrons per W/(m2 sr) of spectrum k that does not change with wavelength, by quadrature: what
  // the mean of WeightsAt(...).electrons must be.
  double ExpectedElectrons(int spectrum, double cos_theta, double falloff) const;

  // Of the electrons that light of the scene's first spectrum makes on the axis.
  double MeanWavelength_nm() const;

  const CameraSpec& Camera() const { return camera_; }
  double ExposureSeconds() const { return exposure_s_; }

 private:
  double FilterAt(double nm, double sin_theta) const;
  double AxialFactor() const;

  static constexpr int kAngles = 64;  // steps of equal sin^2, in which the band shifts evenly

  static constexpr int kGuides = 256;

  // The density over wavelength of one spectrum, for one step of the field angle.
  struct Band {
    std::vector<float> cumulative;             // over 1 nm cells, ends at 1
    std::vector<int> first_cell;               // from which to look for u in [i, i + 1) / kGuides
    std::vector<float> emission_over_density;  // at the cell centres
  };
  Band MakeBand(const Spectrum& emission, const std::vector<double>& transmission) const;
  std::vector<double> LargestTransmission(double sin2_from, double sin2_to) const;
  const std::vector<Band>& BandsAt(float cos_theta) const;

  CameraSpec camera_;
  double exposure_s_ = 0.0;
  Spectrum quantum_efficiency_;
  std::vector<Spectrum> spectra_;
  double step_sin2_ = 1.0;                // of sin^2 theta, for each element of bands_
  std::vector<std::vector<Band>> bands_;  // by angle, then by spectrum
};

// DN per electron of a sensor: as given, or such that a full well, one for each line that makes a
// row, is the largest number of the ADC.
double GainDnPerElectron(const SensorSpec& sensor);

}  // namespace retrolux
