#include "analysis/vault_text.h"

#include <cmath>

namespace retrolux {

std::string Degrees(double deg) {
  std::string text = fmt::format("{:.2f}", std::abs(deg));
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  const bool negative = deg < 0.0 && text != "0";
  return (negative ? "−" : "") + text + "°";
}

std::string TextOf(const Placement& placement) {
  return fmt::format("φb {}, θ₁ {}, θ₂ {}", Degrees(placement.phi_b_deg),
                     Degrees(placement.theta1_deg), Degrees(placement.theta2_deg));
}

std::string TextOf(const MaskRotation& rotation) {
  return fmt::format("x {}, y {}, z {}", Degrees(rotation.x_deg), Degrees(rotation.y_deg),
                     Degrees(rotation.z_deg));
}

std::string SignedPercent(double fraction) {
  const double percent = 100.0 * fraction;
  if (std::abs(percent) < 0.05) return "0.0 %";
  return fmt::format("{}{:.1f} %", percent < 0.0 ? "−" : "+", std::abs(percent));
}

double OverFloor_mm(const Scenario& scenario, double theta_deg) {
  return scenario.isocentre_height_mm + RigHeight_mm(scenario, theta_deg);
}

std::vector<double> CostsOf(const std::vector<OrientationWorth>& orientations) {
  std::vector<double> costs;
  for (const OrientationWorth& worth : orientations)
    costs.push_back(worth.cost_mm2 / PlacementWorth::kCostUnit_mm2);
  return costs;
}

const MaskRotation& WorstRotation(const VaultStudy& study, const PlacementResult& result) {
  return study.rotations[result.WorstMask()][static_cast<size_t>(result.Worst().rotation)];
}

}  // namespace retrolux
