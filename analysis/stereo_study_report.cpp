#include <fmt/format.h>

#include "analysis/stereo_study_curves.h"

namespace retrolux {

namespace {

class StereoStudyReport {
 public:
  explicit StereoStudyReport(const StereoStudy& study)
      : study_(study),
        report_("How well do two cameras place markers?",
                fmt::format("Two cameras at {:g} mm, six identifiable markers and a standard one, "
                            "`robust`; {} exposures of each picture; retrolux {}",
                            study.options.shot.distance_mm, study.options.shot.exposures,
                            RETROLUX_VERSION)) {}

  Report Compose(const std::string& command_line) {
    Summary();
    AddErrorCurves(study_, report_);
    Budget();
    Poses();
    Goals();
    report_.HowMade(command_line);
    report_.Paragraph(fmt::format(
        "Seed {}. The target is moved by up to 20 mm along each axis and turned by up to 10 "
        "degrees "
        "about each (the panel first by any angle about its normal): {} placements an angle, {} at "
        "{:g} degrees. Light: both rings. Noise: the default sensor. All figures are in "
        "stereo_error.csv and budget.csv; docs/stereo.md says what they mean.",
        study_.options.shot.seed, study_.options.placements, study_.options.budget_placements,
        study_.options.budget_deg));
    return std::move(report_);
  }

 private:
  void Summary() {
    std::vector<KeyFigure> figures;
    for (const StereoTarget target : study_.options.targets) {
      const StereoRow* row = study_.Row(target, MarkerPoint::kCentre, study_.options.budget_deg);
      if (!row || row->error.found == 0) continue;
      figures.push_back(
          {fmt::format("Marker, {}", NameOf(target)), fmt::format("{:.3f}", row->error.rms), "mm",
           fmt::format("rms at {:g}°, fitted middle; asked: 0.1", study_.options.budget_deg)});
      if (row->pose.poses == 0) continue;
      figures.push_back(
          {fmt::format("Pose, {}", NameOf(target)),
           fmt::format("{:.3f}", row->pose.translation_rms_mm), "mm",
           fmt::format("and {:.4f}° rms; asked: 0.1 and 0.05", row->pose.rotation_rms_deg)});
    }
    report_.KeyFigures(figures);
    report_.Paragraph(
        "The error is that of the **middle of the marker's shape on its surface**: reconstructed "
        "minus true place. Two points of a marker's image are triangulated: the **fitted middle** "
        "(where the middle of the shape falls, by the fit of `robust`) and the **centroid** of its "
        "light, which systems use that know nothing of shapes.");
  }

  void Budget() {
    report_.Heading(
        fmt::format("Where the error comes from, at {:g} degrees", study_.options.budget_deg));
    report_.Paragraph(
        "The centroid's way: the middle of the shape on its surface, **geometry** (to the centroid "
        "of the projected outline: perspective, and a curved surface whose tilted parts are "
        "foreshortened), **illumination** (to the centroid of the light: sheeting that falls off "
        "with the angle), **detector** (to the mean of what is detected, fixed pattern included), "
        "**sensor** (to each detection). The fit goes to the middle of the shape at once. Steps "
        "are vectors: their squares need not add up.");
    std::vector<std::vector<std::string>> rows;
    for (const StereoStudy::Budget& budget : study_.budgets) {
      for (const BudgetLine& line : budget.lines) {
        rows.push_back({NameOf(budget.target),
                        !budget.number        ? "all"
                        : *budget.number == 0 ? "standard"
                                              : std::to_string(*budget.number),
                        line.stage, fmt::format("{:.4f}", line.rms_px),
                        fmt::format("{:.4f}", line.rms_mm), fmt::format("{:.4f}", line.bias_mm.x()),
                        fmt::format("{:.4f}", line.bias_mm.y()),
                        fmt::format("{:.4f}", line.bias_mm.z())});
      }
    }
    report_.Table("Error budget",
                  {"target", "marker", "step", "rms in a picture (px)", "rms in space (mm)",
                   "mean, depth (mm)", "mean, across (mm)", "mean, up (mm)"},
                  rows);
  }

  void Poses() {
    report_.Heading("The pose from six markers");
    std::vector<std::vector<std::string>> rows;
    for (const StereoRow& row : study_.rows) {
      if (row.pose.poses == 0) continue;
      rows.push_back({NameOf(row.target), fmt::format("{:g}", row.psi_deg),
                      row.point == MarkerPoint::kCentre ? "fitted middle" : "centroid",
                      fmt::format("{} of {}", row.pose.poses, row.pose.exposures),
                      fmt::format("{:.4f}", row.pose.translation_rms_mm),
                      fmt::format("{:.4f}", row.pose.rotation_rms_deg),
                      fmt::format("{:.4f}", row.pose.fre_rms_mm),
                      fmt::format("{:.4f}", row.pose.expected_tre_mm)});
    }
    report_.Table(
        "Poses from exposures in which both cameras named all six; at the target's origin",
        {"target", "ψ (°)", "point", "poses", "shift, rms (mm)", "turn, rms (°)", "FRE (mm)",
         "TRE expected of the FRE (mm)"},
        rows);
    report_.Paragraph(
        "The expected TRE takes errors for independent and equal in all directions. What all "
        "markers share, such as a bias in depth, leaves no FRE and is not in it.");
  }

  void Goals() {
    report_.Heading("Targets");
    std::vector<std::vector<std::string>> rows;
    for (const StereoTargetLine& goal : study_.goals) {
      rows.push_back({goal.Met() ? "met" : "MISSED", goal.name,
                      fmt::format("{:.4f}", goal.measured), fmt::format("below {:g}", goal.limit),
                      goal.unit});
    }
    report_.Table("What was asked and what was measured",
                  {"", "target", "measured", "asked", "unit"}, rows);
  }

  const StereoStudy& study_;
  Report report_;
};

}  // namespace

void WriteStereoStudyReport(const StereoStudy& study, const std::filesystem::path& folder,
                            const std::string& command_line) {
  StereoStudyReport(study).Compose(command_line).Write(folder / "report.html");
}

}  // namespace retrolux
