#include "analysis/goniometer.h"

#include <cmath>

#include "analysis/measuring_bench.h"

namespace retrolux {

namespace {

constexpr double kMostObservation_deg = 20.0, kMostEntrance_deg = 85.0;

void CheckAngles(const char* what, const std::vector<double>& angles_deg, double low, double high) {
  if (angles_deg.empty()) throw InputError(fmt::format("no {} angles; expected one or more", what));
  for (const double deg : angles_deg) {
    if (deg >= low && deg <= high) continue;
    throw InputError(fmt::format("{} angle {} degrees; expected {} to {}", what, deg, low, high));
  }
}

// The bench's patch has the normal +x.
Vec3d BenchFromSheet(const Vec3d& w) {
  return {w.z(), w.x(), w.y()};
}

double AngleToNormalDeg(const Vec3d& w) {
  return DegFromRad(std::acos(std::clamp(w.z(), -1.0, 1.0)));
}

GoniometerReading Measure(const std::string& material, const GoniometerOptions& options,
                          double observation_deg, double beta1_deg) {
  const GoniometerAxes axes = AxesOf(observation_deg, beta1_deg, options.beta2_deg);
  const Vec3d& to_lamp = options.exchanged ? axes.observation : axes.illumination;
  const Vec3d& to_receiver = options.exchanged ? axes.illumination : axes.observation;
  MeasuringBench bench;
  bench.material_json = material;
  bench.lamp_position = options.distance_mm * BenchFromSheet(to_lamp);
  bench.camera_position = options.distance_mm * BenchFromSheet(to_receiver);
  const MeasuringBench::Radiance radiance = bench.Measure(options.samples, options.seed);
  const double to_ra =
      to_receiver.z() * std::pow(options.distance_mm * 1e-3, 2) / bench.lamp_intensity_w_sr;
  return {observation_deg,
          beta1_deg,
          options.beta2_deg,
          AngleToNormalDeg(to_lamp),
          AngleToNormalDeg(to_receiver),
          radiance.mean * to_ra,
          radiance.standard_error * to_ra};
}

}  // namespace

void GoniometerOptions::Check() const {
  CheckAngles("observation", observation_deg, 0.01, kMostObservation_deg);
  CheckAngles("entrance", entrance_deg, -kMostEntrance_deg, kMostEntrance_deg);
  CheckAngles("beta 2", {beta2_deg}, -kMostEntrance_deg, kMostEntrance_deg);
  for (const double alpha : observation_deg) {
    for (const double beta1 : entrance_deg) {
      const GoniometerAxes axes = AxesOf(alpha, beta1, beta2_deg);
      const double steepest =
          std::max(AngleToNormalDeg(axes.illumination), AngleToNormalDeg(axes.observation));
      if (steepest <= kMostEntrance_deg) continue;
      throw InputError(fmt::format(
          "observation {} degrees, entrance {} degrees: {:.2f} degrees to the normal; expected at "
          "most {}",
          alpha, beta1, steepest, kMostEntrance_deg));
    }
  }
}

GoniometerAxes AxesOf(double observation_deg, double beta1_deg, double beta2_deg) {
  const double alpha = RadFromDeg(observation_deg), b1 = RadFromDeg(beta1_deg),
               b2 = RadFromDeg(beta2_deg);
  // The sheet's frame: its y is the goniometer's, turned by beta_2.
  const Vec3d normal(std::sin(b1) * std::cos(b2), std::sin(b2), std::cos(b1) * std::cos(b2));
  const Vec3d along_x(std::cos(b1), 0.0, -std::sin(b1));
  const Vec3d along_y = normal.cross(along_x);
  const auto in_sheet = [&](const Vec3d& w) -> Vec3d {
    return {w.dot(along_x), w.dot(along_y), w.dot(normal)};
  };
  return {in_sheet(Vec3d::UnitZ()), in_sheet({std::sin(alpha), 0.0, std::cos(alpha)})};
}

std::vector<GoniometerReading> MeasureRetroReflection(const nlohmann::json& material,
                                                      const GoniometerOptions& options) {
  options.Check();
  const std::string text = material.dump();
  std::vector<GoniometerReading> readings;
  for (const double alpha : options.observation_deg) {
    for (const double beta1 : options.entrance_deg) {
      readings.push_back(Measure(text, options, alpha, beta1));
    }
  }
  return readings;
}

}  // namespace retrolux
