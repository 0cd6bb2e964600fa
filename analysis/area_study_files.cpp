#include "analysis/area_study.h"
#include "core/atomic_file.h"
#include "core/csv.h"

namespace retrolux {

namespace {

using nlohmann::json;

std::string Number(const std::optional<double>& value) {
  return value ? fmt::format("{:.8g}", *value) : "";
}

void WriteTable(const AreaStudy& study, const std::filesystem::path& file) {
  CsvWriter table(
      {"test", "case", "psi_deg", "rendered_mm2", "analytic_mm2", "analytic_far_mm2", "rel_error"});
  for (const AreaRow& row : study.rows) {
    table.Row({row.test, row.Case(), Number(row.psi_deg), Number(row.rendered_mm2),
               Number(row.analytic_mm2), Number(row.far_mm2), Number(row.RelError())});
  }
  table.Write(file);
}

json ToJson(const AreaTarget& target) {
  return {{"target", target.name},         {"measured", target.measured}, {"expected", target.aim},
          {"tolerance", target.tolerance}, {"unit", target.unit},         {"pass", target.Met()}};
}

json ToJson(const LineFit& fit) {
  return {{"offset_r2", fit.offset}, {"gradient_r2_per_rad", fit.gradient}};
}

json ToJson(const BeamThresholds& thresholds) {
  return {{"all_hidden_up_to_deg", thresholds.all_hidden_up_to},
          {"part_hidden_up_to_deg", thresholds.part_hidden_up_to}};
}

json Optima(const AreaStudy& study) {
  json over_gamma = json::array();
  for (size_t i = 0; i < study.gammas_mm.size(); ++i) {
    over_gamma.push_back({{"gamma_max_mm", study.gammas_mm[i]},
                          {"thesis_sphere_deg", study.optimum_unit_deg[i]},
                          {"sphere_deg", study.optimum_deg[i]}});
  }
  return {{"gamma_max_mm", study.gamma_max_mm},
          {"thesis_sphere_deg", study.calibrated_unit_deg},
          {"sphere_deg", study.calibrated_deg},
          {"sphere_measured_deg", study.rendered_deg},
          {"over_gamma_max", over_gamma}};
}

// The error at each setting, over the rotations.
json Convergence(const AreaStudy& study) {
  json settings = json::array();
  for (const AreaCurve& curve : AreaCurves(study)) {
    for (const AreaCurve::Point& point : curve.points) {
      settings.push_back({{"shape", curve.shape},
                          {"visibility", curve.rule},
                          {"axis", curve.axis},
                          {"value", point.x},
                          {"rms_rel_error", point.rms},
                          {"largest_rel_error", point.largest}});
    }
  }
  return settings;
}

}  // namespace

json AreaSummary(const AreaStudy& study) {
  json targets = json::array();
  for (const AreaTarget& target : study.targets) targets.push_back(ToJson(target));
  const AreaStudyOptions& options = study.options;
  return {{"schema", "retrolux/area-study-1"},
          {"version", RETROLUX_VERSION},
          {"units", "mm, deg"},
          {"pixel_origin", "center"},
          {"size", {options.width_px, options.height_px}},
          {"visibility", NameOf(options.rule)},
          {"triangles", options.Triangles()},
          {"part_area_mm2", options.part_area_mm2},
          {"rotations", options.rotations},
          {"seed", options.seed},
          {"targets", targets},
          {"far_pairs", ToJson(study.far)},
          {"nozzles",
           {{"camera_1", ToJson(study.camera_1)},
            {"camera_2", ToJson(study.camera_2)},
            {"far", ToJson(study.beam_far)}}},
          {"optimal_angle", Optima(study)},
          {"convergence", Convergence(study)}};
}

void WriteAreaFiles(const AreaStudy& study, const std::filesystem::path& folder) {
  WriteTable(study, folder / "areas.csv");
  WriteTextFile(folder / "summary.json", AreaSummary(study).dump(2) + "\n");
}

}  // namespace retrolux
