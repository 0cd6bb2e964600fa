#include "materials/filter.h"

#include <cmath>

namespace retrolux {

double DichroicFilter::CentreAt(double sin_theta) const {
  const double s = sin_theta / effective_index;
  return centre_nm * std::sqrt(1.0 - s * s);
}

double DichroicFilter::Transmission(double nm, double sin_theta) const {
  const double x = 2.0 * (nm - CentreAt(sin_theta)) / bandwidth_nm;
  const double x2 = x * x;
  const double x8 = x2 * x2 * x2 * x2;
  const double floor = std::exp(-std::numbers::ln10 * optical_density);
  return floor + (peak_transmission - floor) * std::exp(-std::numbers::ln2 * x8);
}

DichroicFilter ReadFilter(JsonReader json) {
  DichroicFilter filter;
  filter.centre_nm =
      json.Number("centre_nm", kMinWavelength_nm, kMaxWavelength_nm, filter.centre_nm);
  filter.bandwidth_nm = json.Number("bandwidth_nm", 1.0, 1000.0, filter.bandwidth_nm);
  filter.peak_transmission = json.Number("peak_transmission", 0.01, 1.0, filter.peak_transmission);
  filter.optical_density = json.Number("optical_density", 1.0, 12.0, filter.optical_density);
  filter.effective_index = json.Number("effective_index", 1.1, 5.0, filter.effective_index);
  if (filter.peak_transmission <= std::pow(10.0, -filter.optical_density)) {
    json.Fail(fmt::format("a peak of {} below the floor of optical density {}",
                          filter.peak_transmission, filter.optical_density),
              "peak_transmission above 10^-optical_density");
  }
  json.Finish();
  return filter;
}

nlohmann::json ToJson(const DichroicFilter& filter) {
  return {{"centre_nm", filter.centre_nm},
          {"bandwidth_nm", filter.bandwidth_nm},
          {"peak_transmission", filter.peak_transmission},
          {"optical_density", filter.optical_density},
          {"effective_index", filter.effective_index}};
}

}  // namespace retrolux
