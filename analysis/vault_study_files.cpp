#include "analysis/vault_study.h"
#include "core/atomic_file.h"
#include "core/csv.h"
#include "core/json_reader.h"

namespace retrolux {

namespace {

const MaskRotation& RotationOf(const VaultStudy& study, const PlacementResult& result) {
  return study.rotations[result.WorstMask()][static_cast<size_t>(result.Worst().rotation)];
}

// Share of a mask's area, in percent.
double Percent(const VaultStudy& study, size_t mask, double area_mm2) {
  return 100.0 * area_mm2 / study.mask_area_mm2[mask];
}

std::vector<std::string> EvaluationRow(const VaultStudy& study, const PlacementResult& result,
                                       size_t mask) {
  const PlacementWorth& e = result.by_mask[mask];
  const MaskRotation& rotation = study.rotations[mask][static_cast<size_t>(e.rotation)];
  return {std::to_string(result.phase),
          CsvNumber(e.placement.phi_b_deg),
          CsvNumber(e.placement.theta1_deg),
          CsvNumber(e.placement.theta2_deg),
          CsvNumber(e.Cost()),
          CsvNumber(Percent(study, mask, e.worth.area_mm2)),
          CsvNumber(e.worth.area_mm2 / 100.0),
          CsvNumber(DegFromRad(e.min_angle_rad)),
          CsvNumber(DegFromRad(e.min_nominal_angle_rad)),
          CsvNumber(e.recon_error_mm),
          NameOf(e.worth.combination),
          CsvNumber(rotation.x_deg),
          CsvNumber(rotation.y_deg),
          CsvNumber(rotation.z_deg),
          study.options.masks[mask]};
}

const std::vector<std::string> kEvaluationColumns = {
    "phase",          "phi_b_deg",     "theta1_deg",
    "theta2_deg",     "cost",          "area_pct",
    "area_cm2",       "min_angle_deg", "min_angle_nominal_deg",
    "recon_error_mm", "combination",   "rot_x_deg",
    "rot_y_deg",      "rot_z_deg",     "mask"};

void WriteEvaluations(const VaultStudy& study, const std::filesystem::path& folder) {
  CsvWriter worst(kEvaluationColumns);
  for (const PlacementResult& result : study.results)
    worst.Row(EvaluationRow(study, result, result.WorstMask()));
  worst.Write(folder / "evaluations.csv");
  const size_t masks = study.options.masks.size();
  for (size_t mask = 0; masks > 1 && mask < masks; ++mask) {
    CsvWriter table(kEvaluationColumns);
    for (const PlacementResult& result : study.results)
      table.Row(EvaluationRow(study, result, mask));
    table.Write(folder / fmt::format("evaluations_{}.csv", study.options.masks[mask]));
  }
}

void WriteOrientations(const VaultStudy& study, const std::filesystem::path& folder) {
  CsvWriter table({"rot_x_deg", "rot_y_deg", "rot_z_deg", "cost", "combination", "mask"});
  for (size_t mask = 0; mask < study.options.masks.size(); ++mask) {
    for (size_t i = 0; i < study.rotations[mask].size(); ++i) {
      const MaskRotation& rotation = study.rotations[mask][i];
      const OrientationWorth& worth = study.best.orientations[mask][i];
      table.Row({CsvNumber(rotation.x_deg), CsvNumber(rotation.y_deg), CsvNumber(rotation.z_deg),
                 CsvNumber(worth.cost_mm2 / PlacementWorth::kCostUnit_mm2),
                 NameOf(worth.combination), study.options.masks[mask]});
    }
  }
  table.Write(folder / "orientations.csv");
}

nlohmann::json ToJson(const Placement& placement) {
  return {{"phi_b_deg", placement.phi_b_deg},
          {"theta1_deg", placement.theta1_deg},
          {"theta2_deg", placement.theta2_deg}};
}

nlohmann::json ToJson(const VaultStudy& study, const PlacementResult& result) {
  const PlacementWorth& e = result.Worst();
  const size_t mask = result.WorstMask();
  const MaskRotation& rotation = RotationOf(study, result);
  nlohmann::json cameras = nlohmann::json::array();
  for (const int camera : CamerasOf(e.worth.combination)) cameras.push_back(camera + 1);
  return {
      {"placement", ToJson(e.placement)},
      {"rig_heights_mm",
       {study.scenario.isocentre_height_mm + RigHeight_mm(study.scenario, e.placement.theta1_deg),
        study.scenario.isocentre_height_mm + RigHeight_mm(study.scenario, e.placement.theta2_deg)}},
      {"mask", study.options.masks[mask]},
      {"cost", e.Cost()},
      {"area_cm2", e.worth.area_mm2 / 100.0},
      {"area_pct", Percent(study, mask, e.worth.area_mm2)},
      {"min_angle_deg", DegFromRad(e.min_angle_rad)},
      {"min_angle_nominal_deg", DegFromRad(e.min_nominal_angle_rad)},
      {"consecutive_angle_nominal_deg", ConsecutiveAngle_deg(study.scenario, e.placement)},
      {"recon_error_mm", e.recon_error_mm},
      {"combination", cameras},
      {"rotation_deg", {rotation.x_deg, rotation.y_deg, rotation.z_deg}}};
}

nlohmann::json NamedToJson(const VaultStudy& study, const NamedResult& named) {
  nlohmann::json json = ToJson(study, named.result);
  json["name"] = named.name;
  json["cost_change"] = named.result.Cost() - study.best.result.Cost();
  return json;
}

nlohmann::json ThesisToJson(const VaultStudy& study) {
  nlohmann::json rows = nlohmann::json::array();
  for (size_t i = 0; i < study.thesis.size(); ++i) {
    const ThesisSolution& printed = study.scenario.thesis[i];
    nlohmann::json row = ToJson(study, study.thesis[i].result);
    row["name"] = printed.name;
    row["printed"] = {{"cost", printed.cost},
                      {"area_pct", printed.area_pct},
                      {"area_cm2", printed.area_cm2},
                      {"angle_deg", printed.angle_deg},
                      {"recon_error_mm", printed.error_mm}};
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

double ConsecutiveAngle_deg(const Scenario& scenario, const Placement& placement) {
  return DegFromRad(NominalSeparationRad(scenario, placement, 0, 1));
}

nlohmann::json VaultSolution(const VaultStudy& study) {
  nlohmann::json solution = ToJson(study, study.best.result);
  solution["schema"] = "retrolux/vault-solution-1";
  solution["version"] = RETROLUX_VERSION;
  solution["units"] = "mm, deg; cost in 1e4 mm2";
  solution["pixel_origin"] = "center";
  solution["simulation"] = study.scenario.name;
  solution["runner_up"] = study.runner_up ? NamedToJson(study, *study.runner_up) : nullptr;
  solution["sensitivity"] = nlohmann::json::array();
  for (const NamedResult& moved : study.sensitivity)
    solution["sensitivity"].push_back(NamedToJson(study, moved));
  solution["snapped"] = study.snapped ? NamedToJson(study, *study.snapped) : nullptr;
  solution["refined"] = nullptr;
  if (study.refined) {
    solution["refined"] = {{"placement", ToJson(study.refined->placement)},
                           {"cost", study.refined->cost},
                           {"cost_change", study.refined->cost - study.best.result.Cost()},
                           {"evaluations", study.refined->evaluations}};
  }
  solution["variations"] = nlohmann::json::array();
  for (const VariedOptimum& varied : study.variations) {
    solution["variations"].push_back({{"name", varied.name},
                                      {"placement", ToJson(varied.best.Where())},
                                      {"cost", varied.best.Cost()},
                                      {"cost_of_ours", varied.cost_of_ours}});
  }
  solution["thesis"] = ThesisToJson(study);
  solution["views"] = study.views;
  solution["views_cut"] = study.views_cut;
  solution["rotations_too_close"] = study.rotations_too_close;
  return solution;
}

void WriteVaultFiles(const VaultStudy& study, const std::filesystem::path& folder) {
  WriteEvaluations(study, folder);
  WriteOrientations(study, folder);
  WriteTextFile(folder / "solution.json", VaultSolution(study).dump(2) + "\n");
}

Placement ReadPlacement(const std::filesystem::path& file) {
  JsonReader json = JsonReader::FromFile(file);
  JsonReader node = json.Child("placement");
  const Placement placement = {node.Number("phi_b_deg", 0.0, 180.0),
                               node.Number("theta1_deg", 0.0, 180.0),
                               node.Number("theta2_deg", 0.0, 180.0)};
  node.Finish();
  return placement;
}

}  // namespace retrolux
