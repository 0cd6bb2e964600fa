// Functions over wavelength: reflectances, quantum efficiencies, emission spectra.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/conventions.h"
#include "core/json_reader.h"

namespace retrolux {

// A path carries one wavelength for each distinct spectrum of light in the scene (all rings of one
// LED type share one, the room light has another), each drawn from emission x filter x quantum
// efficiency of its own light. All values along a path are arrays over them.
inline constexpr int kMaxSpectra = 4;
using Spectral = Eigen::Array<float, kMaxSpectra, 1>;

// Linear between samples 1 nm apart from 400 to 1100 nm; constant beyond.
class Spectrum {
 public:
  Spectrum() = default;  // zero everywhere
  static Spectrum Constant(double value);
  // (nm, value), strictly ascending in nm; linear between the points, constant beyond them.
  static Spectrum FromPoints(const std::vector<std::pair<double, double>>& points);
  // The first two columns of a table with comments (core/csv.h): wavelength_nm and the value.
  static Spectrum FromTable(const std::filesystem::path& file);
  template <typename Function>
  static Spectrum FromFunction(Function&& value_at_nm) {
    Spectrum spectrum;
    spectrum.samples_.resize(kSamples);
    for (int i = 0; i < kSamples; ++i) {
      spectrum.samples_[static_cast<size_t>(i)] =
          static_cast<float>(value_at_nm(kMinWavelength_nm + i));
    }
    return spectrum;
  }

  float At(float nm) const {
    if (samples_.empty()) return constant_;
    const float x = std::clamp(nm - static_cast<float>(kMinWavelength_nm), 0.0f,
                               static_cast<float>(kSamples - 1) - 1e-3f);
    const auto i = static_cast<size_t>(x);
    const float t = x - static_cast<float>(i);
    return samples_[i] + t * (samples_[i + 1] - samples_[i]);
  }
  Spectral At(const Spectral& nm) const {
    if (samples_.empty()) return Spectral::Constant(constant_);
    Spectral values;
    for (int k = 0; k < kMaxSpectra; ++k) values[k] = At(nm[k]);
    return values;
  }

  // Over 400 to 1100 nm, by the trapezoidal rule on the samples (exact for what the class holds).
  double Integral() const;
  // The same shape with the integral 1. The integral must not be zero.
  Spectrum Normalised() const;
  float Max() const;
  float Min() const;

 private:
  static constexpr int kSamples = static_cast<int>(kMaxWavelength_nm - kMinWavelength_nm) + 1;
  float constant_ = 0.0f;
  std::vector<float> samples_;  // empty: constant
};

// The shape of an LED's emission over wavelength, with x = (lambda - peak) / fwhm. kGaussian:
// exp(-4 ln 2 x^2). kOhno: (g + 2 g^5) / 3 with g = exp(-(2 c x)^2), c such that the width at half
// maximum is right: a sharper peak on broader feet (Ohno, Opt. Eng. 44(11), 111302, 2005).
enum class LedShape { kGaussian, kOhno };
const std::vector<std::string>& LedShapeNames();  // in the order of the enumerators
LedShape LedShapeOf(const std::string& name);     // one of the names

// What the spectrum of an LED is known by.
struct LedType {
  double peak_nm = 0.0;
  double fwhm_nm = 0.0;
  LedShape shape = LedShape::kGaussian;
  auto operator<=>(const LedType&) const = default;
};

// Emission of an LED over wavelength, integral 1 over 400 to 1100 nm (1/nm).
Spectrum LedSpectrum(const LedType& led);

// A reflectance or efficiency as scenes give it: a number from `min` to `max`, or the name of a
// table under the data folder ("materials/data/x.csv").
Spectrum ReadSpectrum(JsonReader& json, const std::string& key, double min, double max,
                      double fallback);

// The path of the data table that a key names; the error says where the key stands.
std::filesystem::path ReadTablePath(JsonReader& json, const std::string& key);

}  // namespace retrolux
