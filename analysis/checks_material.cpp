// Checks of retro-reflection: the renderer as a measuring instrument for R_A.
#include <cmath>

#include "analysis/check.h"
#include "analysis/measuring_bench.h"

namespace retrolux {

namespace {

// The two lobes of the default sheeting alone, without cover and body.
constexpr const char* kLobesOnly =
    R"({"type": "retroreflector", "diffuse_reflectance": 0.0, "ior": 1.0,
  "lobes": [{"roughness": 0.0043, "albedo": 0.109}, {"roughness": 0.0255, "albedo": 0.075}]})";

constexpr double kDistance_mm = 10000.0;

// R_A = L cos(nu) d^2 / I of a patch at the origin: lamp and camera 10 m away, alpha apart, both in
// the plane of incidence, the lamp at `entrance_deg`. With `exchanged` they change places.
MeasuringBench::Radiance MeasureRa(const char* material, double alpha_deg, double entrance_deg,
                                   bool exchanged) {
  const auto at = [](double deg) -> Vec3d {
    return kDistance_mm * Vec3d(std::cos(RadFromDeg(deg)), std::sin(RadFromDeg(deg)), 0);
  };
  MeasuringBench bench;
  bench.material_json = material;
  bench.lamp_position = at(exchanged ? entrance_deg + alpha_deg : entrance_deg);
  bench.camera_position = at(exchanged ? entrance_deg : entrance_deg + alpha_deg);
  const double cos_nu = bench.camera_position.x() / kDistance_mm;
  const double to_ra = cos_nu * std::pow(kDistance_mm * 1e-3, 2) / bench.lamp_intensity_w_sr;
  const MeasuringBench::Radiance radiance = bench.Measure(1 << 12, 5);
  return {radiance.mean * to_ra, radiance.standard_error * to_ra};
}

}  // namespace

std::vector<Check> CheckRetroReflection() {
  // In the plane of incidence the back vector tilts by alpha / 2 and the cosines cancel:
  //   R_A(alpha) = sum rho / (4 pi a^2) / [cos^4(alpha/2) (1 + tan^2(alpha/2) / a^2)^2],
  // at angles of which none was fitted. (The lobes' four numbers are rounded: the table of the fit
  // before rounding, 85, 57, 11.4, 5.8, lies up to 2 % higher.)
  const auto closed_form = [](double alpha_deg) {
    double sum = 0.0;
    for (const auto& [a, rho] : {std::pair{0.0043, 0.109}, std::pair{0.0255, 0.075}}) {
      const double half = 0.5 * RadFromDeg(alpha_deg);
      const double bracket = 1.0 + std::pow(std::tan(half) / a, 2);
      sum += rho / (4.0 * kPi * a * a) / (std::pow(std::cos(half), 4) * bracket * bracket);
    }
    return sum;
  };
  std::vector<Check> checks;
  for (const double alpha_deg : {0.6, 0.72, 1.43, 2.0}) {
    const double expected = closed_form(alpha_deg);
    const MeasuringBench::Radiance measured = MeasureRa(kLobesOnly, alpha_deg, 5.0, false);
    checks.push_back({fmt::format("R_A at {} degrees", alpha_deg), measured.mean, expected,
                      2e-3 * expected + 4.0 * measured.standard_error, "1/sr",
                      "R_A of two GGX lobes about the back vector; 0.2 % for masking and the LED's "
                      "size, 4 standard errors"});
  }
  for (const auto& [alpha_deg, entrance_deg] :
       {std::pair{0.72, 5.0}, std::pair{2.0, 40.0}, std::pair{10.66, 30.0}}) {
    const std::string material = LibraryMaterial("retro_bead").spec.dump();
    const MeasuringBench::Radiance forward =
        MeasureRa(material.c_str(), alpha_deg, entrance_deg, false);
    const MeasuringBench::Radiance back =
        MeasureRa(material.c_str(), alpha_deg, entrance_deg, true);
    checks.push_back(
        {fmt::format("R_A at {} degrees, entrance {} degrees, light and camera exchanged",
                     alpha_deg, entrance_deg),
         back.mean, forward.mean,
         4.0 * std::hypot(forward.standard_error, back.standard_error) + 1e-3 * forward.mean,
         "1/sr", "reciprocity, 4 standard errors and 0.1 % for the discs' size"});
  }
  return checks;
}

}  // namespace retrolux
