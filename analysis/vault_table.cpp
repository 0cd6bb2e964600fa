#include "analysis/vault_table.h"

#include <algorithm>

#include "analysis/vault_text.h"

namespace retrolux {

const char* const kSolutionNote =
    "Area, in cm² and in per cent of the mask: that seen by two or more cameras. Compare it in "
    "cm², not in per cent: the thesis's per cents are of a mask of 1,529 cm², "
    "which fits a closed mesh with an inner and an outer side, ours of the outer side that a "
    "camera can see. Angle 4.12 is the thesis's: of cameras 1 and 2 after its eq. 4.12, nominal. "
    "The "
    "other angle is the least true one between two cameras of the combination that decides; our "
    "reconstruction error is the one at it.";

std::string SolutionRemarks(const VaultStudy& study) {
  std::string remarks;
  for (const ThesisSolution& printed : study.scenario.thesis) {
    if (!printed.remark.empty())
      remarks += fmt::format(" Solution {}: {}.", printed.name, printed.remark);
  }
  return remarks;
}

std::vector<std::string> SolutionColumns() {
  return {"solution",   "cost", "cm²", "%",  "angle 4.12", "angle",
          "error / mm", "φb",   "θ₁",  "θ₂", "cameras"};
}

std::vector<std::string> SolutionRow(const std::string& name, const ThesisSolution& printed) {
  return {name,
          fmt::format("{:.3f}", printed.cost),
          fmt::format("{:.1f}", printed.area_cm2),
          fmt::format("{:.1f}", printed.area_pct),
          fmt::format("{:.2f}", printed.angle_deg),
          "–",
          fmt::format("{:.2f}", printed.error_mm),
          fmt::format("{:g}", printed.phi_b_deg),
          fmt::format("{:.2f}", printed.theta1_deg),
          fmt::format("{:.2f}", printed.theta2_deg),
          "–"};
}

std::vector<std::string> SolutionRow(const std::string& name, const VaultStudy& study,
                                     const PlacementResult& result) {
  const PlacementWorth& e = result.Worst();
  const bool counts = e.worth.combination != 0;
  const double mask_area = study.mask_area_mm2[result.WorstMask()];
  return {name,
          fmt::format("{:.3f}", e.Cost()),
          fmt::format("{:.1f}", e.worth.area_mm2 / 100.0),
          fmt::format("{:.1f}", 100.0 * e.worth.area_mm2 / mask_area),
          fmt::format("{:.2f}", ConsecutiveAngle_deg(study.scenario, e.placement)),
          counts ? fmt::format("{:.2f}", DegFromRad(e.min_angle_rad)) : "–",
          counts ? fmt::format("{:.2f}", e.recon_error_mm) : "–",
          fmt::format("{:.4g}", e.placement.phi_b_deg),
          fmt::format("{:.2f}", e.placement.theta1_deg),
          fmt::format("{:.2f}", e.placement.theta2_deg),
          counts ? NameOf(e.worth.combination) : "–"};
}

std::vector<std::vector<std::string>> SolutionRows(const VaultStudy& study,
                                                   std::vector<std::string>& printed_before) {
  std::vector<std::vector<std::string>> rows;
  for (size_t i = 0; i < study.thesis.size(); ++i) {
    const ThesisSolution& printed = study.scenario.thesis[i];
    if (std::find(printed_before.begin(), printed_before.end(), printed.name) !=
        printed_before.end())
      continue;
    printed_before.push_back(printed.name);
    rows.push_back(SolutionRow(fmt::format("{}, the thesis prints", printed.name), printed));
    rows.push_back(SolutionRow(fmt::format("{}, same placement here", printed.name), study,
                               study.thesis[i].result));
  }
  const char* ours = study.options.placement ? "{}, the placement asked for" : "{}, our optimum";
  rows.push_back(
      SolutionRow(fmt::format(fmt::runtime(ours), study.scenario.name), study, study.best.result));
  return rows;
}

}  // namespace retrolux
