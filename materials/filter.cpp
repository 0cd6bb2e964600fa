#include "materials/filter.h"

#include <cmath>

namespace retrolux {

namespace {

// The outermost wavelengths at which a spectrum reaches half of its maximum, to 0.1 nm.
std::pair<double, double> HalfMaximum(const Spectrum& spectrum) {
  constexpr int kSteps = static_cast<int>(kMaxWavelength_nm - kMinWavelength_nm) * 10;
  const float half = 0.5f * spectrum.Max();
  const auto nm = [](int step) { return kMinWavelength_nm + 0.1 * step; };
  const auto reached = [&](int step) { return spectrum.At(static_cast<float>(nm(step))) >= half; };
  int first = 0, last = kSteps;
  while (!reached(first)) ++first;
  while (!reached(last)) --last;
  return {nm(first), nm(last)};
}

void ReadBand(JsonReader& json, DichroicFilter& filter) {
  filter.centre_nm =
      json.Number("centre_nm", kMinWavelength_nm, kMaxWavelength_nm, filter.centre_nm);
  filter.bandwidth_nm = json.Number("bandwidth_nm", 1.0, 1000.0, filter.bandwidth_nm);
  filter.peak_transmission = json.Number("peak_transmission", 0.01, 1.0, filter.peak_transmission);
}

// lambda(theta) / lambda_0.
double BlueShift(double sin_theta, double effective_index) {
  const double s = sin_theta / effective_index;
  return std::sqrt(1.0 - s * s);
}

}  // namespace

void DichroicFilter::UseTable(const std::string& name, const Spectrum& at_normal_incidence) {
  table = name;
  tabulated = at_normal_incidence;
  const auto [from, to] = HalfMaximum(tabulated);
  centre_nm = 0.5 * (from + to);
  bandwidth_nm = to - from;
  peak_transmission = static_cast<double>(tabulated.Max());
}

double DichroicFilter::CentreAt(double sin_theta) const {
  return centre_nm * BlueShift(sin_theta, effective_index);
}

double DichroicFilter::Transmission(double nm, double sin_theta) const {
  const double floor = std::exp(-std::numbers::ln10 * optical_density);
  if (!table.empty()) {
    const double unshifted_nm = nm / BlueShift(sin_theta, effective_index);
    return std::max(floor, static_cast<double>(tabulated.At(static_cast<float>(unshifted_nm))));
  }
  const double x = 2.0 * (nm - CentreAt(sin_theta)) / bandwidth_nm;
  const double x2 = x * x;
  const double x8 = x2 * x2 * x2 * x2;
  return floor + (peak_transmission - floor) * std::exp(-std::numbers::ln2 * x8);
}

DichroicFilter ReadFilter(JsonReader json) {
  DichroicFilter filter;
  if (json.Has("table")) {
    for (const char* key : {"centre_nm", "bandwidth_nm", "peak_transmission"}) {
      if (json.Has(key)) json.Fail(fmt::format("both table and {}", key), "one of them");
    }
    filter.UseTable(json.Child("table").AsString(), ReadSpectrum(json, "table", 0.0, 1.0, 0.0));
  } else {
    ReadBand(json, filter);
  }
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
  nlohmann::json json = {{"optical_density", filter.optical_density},
                         {"effective_index", filter.effective_index}};
  if (!filter.table.empty()) {
    json["table"] = filter.table;
    return json;
  }
  json["centre_nm"] = filter.centre_nm;
  json["bandwidth_nm"] = filter.bandwidth_nm;
  json["peak_transmission"] = filter.peak_transmission;
  return json;
}

}  // namespace retrolux
