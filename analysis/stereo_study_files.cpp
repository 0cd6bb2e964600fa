#include <fmt/format.h>

#include "analysis/reconstruction_error.h"
#include "analysis/stereo_study.h"
#include "core/atomic_file.h"
#include "core/csv.h"

namespace retrolux {

namespace {

using nlohmann::json;

const char* NameOf(MarkerPoint point) {
  return point == MarkerPoint::kCentre ? "centre" : "light";
}

void Add(const Vec3d& v, std::vector<std::string>& cells) {
  for (Eigen::Index i = 0; i < 3; ++i) cells.push_back(CsvNumber(v[i]));
}

void WriteErrors(const StereoStudy& study, const std::filesystem::path& file) {
  CsvWriter table({"target",
                   "psi_deg",
                   "point",
                   "incidence_deg",
                   "expected",
                   "found",
                   "misnamed",
                   "rms_mm",
                   "rms_low_mm",
                   "rms_high_mm",
                   "rms_depth_mm",
                   "rms_across_mm",
                   "rms_up_mm",
                   "bias_depth_mm",
                   "bias_across_mm",
                   "bias_up_mm",
                   "noise_depth_mm",
                   "noise_across_mm",
                   "noise_up_mm",
                   "noise_px",
                   "model_depth_mm",
                   "model_across_mm",
                   "model_up_mm",
                   "borghese_ferrigno_mm",
                   "poses",
                   "pose_shift_rms_mm",
                   "pose_turn_rms_deg",
                   "pose_fre_rms_mm",
                   "pose_expected_tre_mm"});
  const Scenario scenario = LoadScenario("1a");
  const ReconstructionError curve(scenario.error_points, scenario.gamma_max_mm);
  for (const StereoRow& row : study.rows) {
    std::vector<std::string> cells = {NameOf(row.target),
                                      fmt::format("{:g}", row.psi_deg),
                                      NameOf(row.point),
                                      CsvNumber(row.incidence_deg),
                                      std::to_string(row.error.expected),
                                      std::to_string(row.error.found),
                                      std::to_string(row.misnamed)};
    if (row.error.found == 0) {
      cells.resize(23);
    } else {
      for (const double v : {row.error.rms, row.error.rms_low, row.error.rms_high})
        cells.push_back(CsvNumber(v));
      Add(row.error.axis_rms, cells);
      Add(row.error.bias, cells);
      Add(row.error.noise, cells);
      cells.push_back(CsvNumber(row.error.noise_px));
      Add(RaySigma_mm(row.error.noise_px * study.mm_per_px, row.psi_deg), cells);
    }
    cells.push_back(CsvNumber(curve.Error_mm(RadFromDeg(row.psi_deg))));
    cells.push_back(std::to_string(row.pose.poses));
    if (row.pose.poses == 0) {
      cells.resize(29);
    } else {
      for (const double v : {row.pose.translation_rms_mm, row.pose.rotation_rms_deg,
                             row.pose.fre_rms_mm, row.pose.expected_tre_mm})
        cells.push_back(CsvNumber(v));
    }
    table.Row(cells);
  }
  table.Write(file);
}

std::string MarkerName(const std::optional<int>& number) {
  if (!number) return "all";
  return *number == 0 ? "standard" : std::to_string(*number);
}

void WriteBudget(const StereoStudy& study, const std::filesystem::path& file) {
  CsvWriter table({"target", "marker", "stage", "rms_px", "rms_mm", "bias_depth_mm",
                   "bias_across_mm", "bias_up_mm"});
  for (const StereoStudy::Budget& budget : study.budgets) {
    for (const BudgetLine& line : budget.lines) {
      std::vector<std::string> cells = {NameOf(budget.target), MarkerName(budget.number),
                                        line.stage, CsvNumber(line.rms_px), CsvNumber(line.rms_mm)};
      Add(line.bias_mm, cells);
      table.Row(cells);
    }
  }
  table.Write(file);
}

}  // namespace

json StereoSummary(const StereoStudy& study) {
  json goals = json::array();
  for (const StereoTargetLine& goal : study.goals) {
    goals.push_back({{"target", goal.name},
                     {"measured", goal.measured},
                     {"limit", goal.limit},
                     {"unit", goal.unit},
                     {"pass", goal.Met()}});
  }
  json rows = json::array();
  for (const StereoRow& row : study.rows) {
    rows.push_back({{"target", NameOf(row.target)},
                    {"psi_deg", row.psi_deg},
                    {"point", NameOf(row.point)},
                    {"expected", row.error.expected},
                    {"found", row.error.found},
                    {"rms_mm", row.error.found > 0 ? json(row.error.rms) : json(nullptr)}});
  }
  const StereoStudyOptions& options = study.options;
  return {{"schema", "retrolux/stereo-study-1"},
          {"version", RETROLUX_VERSION},
          {"units", "mm, px, deg"},
          {"pixel_origin", "center"},
          {"seed", options.shot.seed},
          {"spp", options.shot.samples_per_pixel},
          {"exposures", options.shot.exposures},
          {"placements", options.placements},
          {"distance_mm", options.shot.distance_mm},
          {"material", options.shot.material},
          {"budget_deg", options.budget_deg},
          {"targets", goals},
          {"errors", rows}};
}

void WriteStereoStudyFiles(const StereoStudy& study, const std::filesystem::path& folder) {
  WriteErrors(study, folder / "stereo_error.csv");
  WriteBudget(study, folder / "budget.csv");
  WriteTextFile(folder / "summary.json", StereoSummary(study).dump(2) + "\n");
}

}  // namespace retrolux
