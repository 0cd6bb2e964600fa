#include "materials/spectrum.h"

#include <algorithm>
#include <cmath>

#include "core/csv.h"
#include "core/data_path.h"

namespace retrolux {

Spectrum Spectrum::Constant(double value) {
  Spectrum spectrum;
  spectrum.constant_ = static_cast<float>(value);
  return spectrum;
}

Spectrum Spectrum::FromPoints(const std::vector<std::pair<double, double>>& points) {
  RETROLUX_CHECK(!points.empty(), "a spectrum without points");
  return FromFunction([&](double nm) {
    const auto above =
        std::find_if(points.begin(), points.end(), [&](const auto& p) { return p.first > nm; });
    if (above == points.begin()) return points.front().second;
    if (above == points.end()) return points.back().second;
    const auto below = above - 1;
    const double t = (nm - below->first) / (above->first - below->first);
    return below->second + t * (above->second - below->second);
  });
}

Spectrum Spectrum::FromTable(const std::filesystem::path& file) {
  const NumberTable table = ReadNumberTable(file);
  if (table.columns.size() < 2 || table.columns[0] != "wavelength_nm") {
    throw InputError::At(file, "header", JoinNames(table.columns), "wavelength_nm and a value");
  }
  std::vector<std::pair<double, double>> points;
  for (const std::vector<double>& row : table.rows) {
    if (!points.empty() && row[0] <= points.back().first) {
      throw InputError::At(file, "", fmt::format("{} nm after {} nm", row[0], points.back().first),
                           "ascending wavelengths");
    }
    points.emplace_back(row[0], row[1]);
  }
  return FromPoints(points);
}

double Spectrum::Integral() const {
  if (samples_.empty())
    return static_cast<double>(constant_) * (kMaxWavelength_nm - kMinWavelength_nm);
  double sum = 0.0;
  for (const float sample : samples_) sum += static_cast<double>(sample);
  return sum - 0.5 * static_cast<double>(samples_.front() + samples_.back());
}

Spectrum Spectrum::Normalised() const {
  const double integral = Integral();
  RETROLUX_CHECK(integral > 0.0, "integral {}", integral);
  return FromFunction(
      [&](double nm) { return static_cast<double>(At(static_cast<float>(nm))) / integral; });
}

float Spectrum::Max() const {
  return samples_.empty() ? constant_ : *std::max_element(samples_.begin(), samples_.end());
}

float Spectrum::Min() const {
  return samples_.empty() ? constant_ : *std::min_element(samples_.begin(), samples_.end());
}

const std::vector<std::string>& LedShapeNames() {
  static const std::vector<std::string> names = {"gaussian", "ohno"};
  return names;
}

LedShape LedShapeOf(const std::string& name) {
  const std::vector<std::string>& names = LedShapeNames();
  const auto found = std::find(names.begin(), names.end(), name);
  RETROLUX_CHECK(found != names.end(), "no LED shape {}", name);
  return static_cast<LedShape>(found - names.begin());
}

Spectrum LedSpectrum(const LedType& led) {
  // Ohno's shape is half its maximum where g + 2 g^5 = 3/2, g = 0.808609: ln(1 / g) = c^2.
  constexpr double kOhnoSquare = 0.2124395;
  return Spectrum::FromFunction([&](double nm) {
           const double x = 2.0 * (nm - led.peak_nm) / led.fwhm_nm;
           if (led.shape == LedShape::kGaussian) return std::exp(-std::numbers::ln2 * x * x);
           const double g = std::exp(-kOhnoSquare * x * x);
           return (g + 2.0 * std::pow(g, 5)) / 3.0;
         })
      .Normalised();
}

Spectrum ReadSpectrum(JsonReader& json, const std::string& key, double min, double max,
                      double fallback) {
  if (!json.Has(key)) return Spectrum::Constant(fallback);
  if (!json.Child(key).IsString()) return Spectrum::Constant(json.Number(key, min, max));
  const std::filesystem::path file = ReadTablePath(json, key);
  const Spectrum spectrum = Spectrum::FromTable(file);
  if (spectrum.Max() > static_cast<float>(max) || spectrum.Min() < static_cast<float>(min)) {
    throw InputError::At(file, "",
                         fmt::format("values from {} to {}", spectrum.Min(), spectrum.Max()),
                         fmt::format("each a number from {} to {}", min, max));
  }
  return spectrum;
}

std::filesystem::path ReadTablePath(JsonReader& json, const std::string& key) {
  const JsonReader node = json.Child(key);
  const std::string name = node.AsString();
  try {
    return DataPath(name);
  } catch (const InputError&) {
    node.Fail(fmt::format("no table \"{}\"", name),
              "a table of the data folder, such as materials/data/fluorescent.csv");
  }
}

}  // namespace retrolux
