#include "renderer/camera_response.h"

#include <algorithm>
#include <cmath>

#include "core/data_path.h"

namespace retrolux {

namespace {

constexpr int kCells = static_cast<int>(kMaxWavelength_nm - kMinWavelength_nm);  // of 1 nm

double CellCentre(int cell) {
  return kMinWavelength_nm + cell + 0.5;
}

// Photons per joule.
double PhotonsPerJoule(double nm) {
  return nm * 1e-9 / (kPlanck_J_s * kSpeedOfLight_m_s);
}

// sin^2 of the largest field angle: that of a corner.
double LargestSine2(const CameraModel& model) {
  double largest = 0.0;
  for (const double u : {-0.5, model.width - 0.5}) {
    for (const double v : {-0.5, model.height - 0.5}) {
      const double cosine = model.RayThrough({u, v}).direction.dot(model.Forward());
      largest = std::max(largest, 1.0 - cosine * cosine);
    }
  }
  return largest;
}

}  // namespace

double GainDnPerElectron(const SensorSpec& sensor) {
  if (sensor.gain_dn_e > 0.0) return sensor.gain_dn_e;
  return ((1 << sensor.adc_bits) - 1 - sensor.offset_dn) /
         (sensor.LinesPerRow() * sensor.full_well_e);
}

CameraResponse::CameraResponse(const CameraSpec& camera, const std::vector<Spectrum>& spectra,
                               double exposure_s)
    : camera_(camera),
      exposure_s_(exposure_s),
      quantum_efficiency_(Spectrum::FromTable(DataPath(camera.sensor.quantum_efficiency))),
      spectra_(spectra) {
  const int angles = camera_.filter ? kAngles : 1;
  step_sin2_ = LargestSine2(camera_.model) / angles;
  for (int i = 0; i < angles; ++i) {
    const std::vector<double> transmission =
        LargestTransmission(i * step_sin2_, (i + 1) * step_sin2_);
    std::vector<Band>& bands = bands_.emplace_back();
    for (const Spectrum& emission : spectra_) bands.push_back(MakeBand(emission, transmission));
  }
}

double CameraResponse::FilterAt(double nm, double sin_theta) const {
  return camera_.filter ? camera_.filter->Transmission(nm, sin_theta) : 1.0;
}

// m2 s: pi / (4 N^2) T A t.
double CameraResponse::AxialFactor() const {
  const Lens& lens = camera_.lens;
  const double pixel_width_m = 1e-3 * lens.focal_length_mm / camera_.model.fx;
  const double pixel_height_m = 1e-3 * lens.focal_length_mm / camera_.model.fy;
  return kPi / (4.0 * lens.f_number * lens.f_number) * lens.transmission * pixel_width_m *
         pixel_height_m * exposure_s_;
}

// In each cell, at the two ends of the step: in between the band is no farther.
std::vector<double> CameraResponse::LargestTransmission(double sin2_from, double sin2_to) const {
  std::vector<double> transmission;
  for (int i = 0; i < kCells; ++i) {
    const double nm = CellCentre(i);
    transmission.push_back(
        std::max(FilterAt(nm, std::sqrt(sin2_from)), FilterAt(nm, std::sqrt(sin2_to))));
  }
  return transmission;
}

CameraResponse::Band CameraResponse::MakeBand(const Spectrum& emission,
                                              const std::vector<double>& transmission) const {
  Band band;
  std::vector<double> density(kCells);
  double total = 0.0;
  for (int i = 0; i < kCells; ++i) {
    const double nm = CellCentre(i);
    const auto f = static_cast<float>(nm);
    const auto cell = static_cast<size_t>(i);
    density[cell] = static_cast<double>(emission.At(f)) * transmission[cell] *
                    static_cast<double>(quantum_efficiency_.At(f)) * PhotonsPerJoule(nm);
    total += density[cell];
  }
  double sum = 0.0;
  for (const double value : density) {
    sum += value;
    band.cumulative.push_back(static_cast<float>(total > 0.0 ? sum / total : 1.0));
  }
  int cell = 0;
  for (int i = 0; i < kGuides; ++i) {
    while (cell < kCells - 1 &&
           band.cumulative[static_cast<size_t>(cell)] <= static_cast<float>(i) / kGuides)
      ++cell;
    band.first_cell.push_back(cell);
  }
  for (int i = 0; i < kCells; ++i) {
    const double d = density[static_cast<size_t>(i)];
    const double emitted = static_cast<double>(emission.At(static_cast<float>(CellCentre(i))));
    band.emission_over_density.push_back(static_cast<float>(d > 0.0 ? total * emitted / d : 0.0));
  }
  return band;
}

const std::vector<CameraResponse::Band>& CameraResponse::BandsAt(float cos_theta) const {
  const auto cosine = static_cast<double>(cos_theta);
  const double step = std::max(0.0, 1.0 - cosine * cosine) / step_sin2_;
  return bands_[std::min(bands_.size() - 1, static_cast<size_t>(step))];
}

Spectral CameraResponse::SampleWavelengths(float u, float cos_theta) const {
  const std::vector<Band>& bands = BandsAt(cos_theta);
  Spectral nm = Spectral::Constant(static_cast<float>(kMinWavelength_nm));
  for (size_t k = 0; k < bands.size(); ++k) {
    int cell = bands[k].first_cell[static_cast<size_t>(u * kGuides)];
    while (cell < kCells - 1 && bands[k].cumulative[static_cast<size_t>(cell)] <= u) ++cell;
    nm[static_cast<Eigen::Index>(k)] = static_cast<float>(CellCentre(cell));
  }
  return nm;
}

CameraResponse::Weights CameraResponse::WeightsAt(const Spectral& nm, float cos_theta,
                                                  float falloff) const {
  const auto cosine = static_cast<double>(cos_theta);
  const double sin_theta = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  const double geometry = AxialFactor() * static_cast<double>(falloff);
  const double peak = camera_.filter ? camera_.filter->peak_transmission : 1.0;
  const std::vector<Band>& bands = BandsAt(cos_theta);
  Weights weights{Spectral::Zero(), Spectral::Zero()};
  for (size_t k = 0; k < bands.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const auto lambda = static_cast<double>(nm[i]);
    const auto cell = static_cast<size_t>(lambda - kMinWavelength_nm);
    const double transmission = FilterAt(lambda, sin_theta);
    const auto per_density =
        static_cast<double>(bands[k].emission_over_density[cell]) * transmission;  // S T / p
    weights.in_band[i] = static_cast<float>(per_density / peak);
    weights.electrons[i] = static_cast<float>(geometry * per_density *
                                              static_cast<double>(quantum_efficiency_.At(nm[i])) *
                                              PhotonsPerJoule(lambda));
  }
  return weights;
}

double CameraResponse::ExpectedElectrons(int spectrum, double cos_theta, double falloff) const {
  const double sin_theta = std::sqrt(std::max(0.0, 1.0 - cos_theta * cos_theta));
  double sum = 0.0;
  for (int i = 0; i < kCells; ++i) {
    const double nm = CellCentre(i);
    const auto f = static_cast<float>(nm);
    sum += static_cast<double>(spectra_[static_cast<size_t>(spectrum)].At(f) *
                               quantum_efficiency_.At(f)) *
           FilterAt(nm, sin_theta) * PhotonsPerJoule(nm);
  }
  return AxialFactor() * falloff * sum;
}

double CameraResponse::MeanWavelength_nm() const {
  double sum = 0.0, weighted = 0.0;
  for (int i = 0; i < kCells; ++i) {
    const double nm = CellCentre(i);
    const auto f = static_cast<float>(nm);
    const double electrons =
        static_cast<double>(spectra_.front().At(f) * quantum_efficiency_.At(f)) *
        FilterAt(nm, 0.0) * PhotonsPerJoule(nm);
    sum += electrons;
    weighted += nm * electrons;
  }
  return sum > 0.0 ? weighted / sum : 0.5 * (kMinWavelength_nm + kMaxWavelength_nm);
}

}  // namespace retrolux
