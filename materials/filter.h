// The dichroic band-pass filter in front of a lens.
#pragma once

#include "materials/spectrum.h"

namespace retrolux {

// Transmission over wavelength and angle of incidence. The band is a super-Gaussian of order 8
// whose half-maximum points lie `bandwidth_nm` apart, above a floor of 10^-optical_density, or a
// measured table. With the angle it shifts to the blue, lambda(theta) = lambda_0 sqrt(1 - (sin
// theta / n_eff)^2), valid to about 30 degrees (Smith, Modern Optical Engineering; ING filter
// pages).
struct DichroicFilter {
  double centre_nm = 880.0;
  double bandwidth_nm = 50.0;  // full width at half maximum
  double peak_transmission = 0.85;
  double optical_density = 4.0;  // outside the band; of a table, what it calls zero
  double effective_index = 1.9;
  // Name of a table of the data folder, wavelength_nm and transmission at normal incidence; empty:
  // none. Centre, width and peak are then those of the table.
  std::string table = "";
  Spectrum tabulated = {};  // what it holds

  void UseTable(const std::string& name, const Spectrum& at_normal_incidence);
  // The wavelength at which the band is centred for light that arrives at this angle.
  double CentreAt(double sin_theta) const;
  double Transmission(double nm, double sin_theta) const;
};

DichroicFilter ReadFilter(JsonReader json);
nlohmann::json ToJson(const DichroicFilter& filter);

}  // namespace retrolux
