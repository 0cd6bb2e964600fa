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

}  // namespace

double GainDnPerElectron(const SensorSpec& sensor) {
  if (sensor.gain_dn_e > 0.0) return sensor.gain_dn_e;
  return ((1 << sensor.adc_bits) - 1 - sensor.offset_dn) / sensor.full_well_e;
}

CameraResponse::CameraResponse(const CameraSpec& camera, const std::vector<Spectrum>& spectra,
                               double exposure_s)
    : camera_(camera),
      exposure_s_(exposure_s),
      quantum_efficiency_(Spectrum::FromTable(DataPath(camera.sensor.quantum_efficiency))),
      spectra_(spectra) {
  const CameraModel& model = camera_.model;
  for (const double u : {-0.5, model.width - 0.5}) {
    for (const double v : {-0.5, model.height - 0.5}) {
      const double cosine = model.RayThrough({u, v}).direction.dot(model.Forward());
      max_sin_theta_ = std::max(max_sin_theta_, std::sqrt(1.0 - cosine * cosine));
    }
  }
  full_scale_e_ = ((1 << camera.sensor.adc_bits) - 1 - camera.sensor.offset_dn) /
                  GainDnPerElectron(camera.sensor);
  for (const Spectrum& emission : spectra_) bands_.push_back(MakeBand(emission));
}

double CameraResponse::FilterAt(double nm, double sin_theta) const {
  return camera_.filter ? camera_.filter->Transmission(nm, sin_theta) : 1.0;
}

// m2 s: pi / (4 N^2) T A t cos^4.
double CameraResponse::GeometricFactor(double cos_theta) const {
  const Lens& lens = camera_.lens;
  const double pixel_width_m = 1e-3 * lens.focal_length_mm / camera_.model.fx;
  const double pixel_height_m = 1e-3 * lens.focal_length_mm / camera_.model.fy;
  const double cos2 = cos_theta * cos_theta;
  return kPi / (4.0 * lens.f_number * lens.f_number) * lens.transmission * pixel_width_m *
         pixel_height_m * exposure_s_ * cos2 * cos2;
}

CameraResponse::Band CameraResponse::MakeBand(const Spectrum& emission) const {
  Band band;
  std::vector<double> density(kCells);
  for (int i = 0; i < kCells; ++i) {
    const double nm = CellCentre(i);
    const double envelope = std::max(
        {FilterAt(nm, 0.0), FilterAt(nm, 0.5 * max_sin_theta_), FilterAt(nm, max_sin_theta_)});
    const auto f = static_cast<float>(nm);
    const double value = static_cast<double>(emission.At(f)) * envelope *
                         static_cast<double>(quantum_efficiency_.At(f)) * PhotonsPerJoule(nm);
    density[static_cast<size_t>(i)] = value;
    band.total += value;
  }
  double sum = 0.0;
  for (const double value : density) {
    sum += value;
    band.cumulative.push_back(static_cast<float>(band.total > 0.0 ? sum / band.total : 1.0));
  }
  for (int i = 0; i < kCells; ++i) {
    const double d = density[static_cast<size_t>(i)];
    const double emitted = static_cast<double>(emission.At(static_cast<float>(CellCentre(i))));
    band.emission_over_density.push_back(
        static_cast<float>(d > 0.0 ? band.total * emitted / d : 0.0));
  }
  return band;
}

Spectral CameraResponse::SampleWavelengths(float u) const {
  Spectral nm = Spectral::Constant(static_cast<float>(kMinWavelength_nm));
  for (size_t k = 0; k < bands_.size(); ++k) {
    const std::vector<float>& cumulative = bands_[k].cumulative;
    const auto cell = std::min<ptrdiff_t>(
        std::upper_bound(cumulative.begin(), cumulative.end(), u) - cumulative.begin(), kCells - 1);
    nm[static_cast<Eigen::Index>(k)] = static_cast<float>(CellCentre(static_cast<int>(cell)));
  }
  return nm;
}

CameraResponse::Weights CameraResponse::WeightsAt(const Spectral& nm, float cos_theta) const {
  const auto cosine = static_cast<double>(cos_theta);
  const double sin_theta = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  const double geometry = GeometricFactor(cosine);
  const double peak = camera_.filter ? camera_.filter->peak_transmission : 1.0;
  Weights weights{Spectral::Zero(), Spectral::Zero()};
  for (size_t k = 0; k < bands_.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const auto lambda = static_cast<double>(nm[i]);
    const auto cell = static_cast<size_t>(lambda - kMinWavelength_nm);
    const double transmission = FilterAt(lambda, sin_theta);
    const auto per_density =
        static_cast<double>(bands_[k].emission_over_density[cell]) * transmission;  // S T / p
    weights.in_band[i] = static_cast<float>(per_density / peak);
    weights.electrons[i] = static_cast<float>(geometry * per_density *
                                              static_cast<double>(quantum_efficiency_.At(nm[i])) *
                                              PhotonsPerJoule(lambda));
  }
  return weights;
}

double CameraResponse::ExpectedElectrons(int spectrum, double cos_theta) const {
  const double sin_theta = std::sqrt(std::max(0.0, 1.0 - cos_theta * cos_theta));
  double sum = 0.0;
  for (int i = 0; i < kCells; ++i) {
    const double nm = CellCentre(i);
    const auto f = static_cast<float>(nm);
    sum += static_cast<double>(spectra_[static_cast<size_t>(spectrum)].At(f) *
                               quantum_efficiency_.At(f)) *
           FilterAt(nm, sin_theta) * PhotonsPerJoule(nm);
  }
  return GeometricFactor(cos_theta) * sum;
}

}  // namespace retrolux
