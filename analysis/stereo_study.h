// The closed loop: how well do two cameras place markers, over their separation? Measured on our
// own rendered, noisy, identified pictures; beside the curve of Borghese and Ferrigno that the
// thesis cites, and the geometry of two rays.
#pragma once

#include <filesystem>

#include "analysis/stereo_statistics.h"
#include "core/task_manifest.h"

namespace retrolux {

struct StereoStudyOptions {
  std::vector<double> angles_deg = {15, 20, 25,  30,  37.5, 45,    60,
                                    75, 90, 105, 120, 135,  142.5, 150};
  std::vector<StereoTarget> targets = {StereoTarget::kPanel, StereoTarget::kOval};
  int placements = 4;          // of the target at each angle
  int budget_placements = 12;  // at the angle of the budget
  double budget_deg = 45.0;    // one of the angles
  StereoShotOptions shot;
};

// One target, separation, and kind of point.
struct StereoRow {
  StereoTarget target = StereoTarget::kPanel;
  double psi_deg = 0.0;
  MarkerPoint point = MarkerPoint::kCentre;
  double incidence_deg = 0.0;  // mean over markers and cameras
  int misnamed = 0;
  SpatialError error;
  PoseErrors pose;
};

// 1 sigma of a point over the separation, two rays with 1 sigma `e_mm` across each: depth
// e / (sqrt(2) sin(psi / 2)), across e / (sqrt(2) cos(psi / 2)), up e / sqrt(2).
Vec3d RaySigma_mm(double e_mm, double psi_deg);

struct StereoTargetLine {
  std::string name;
  double measured = 0.0, limit = 0.0;
  std::string unit;
  bool Met() const { return measured < limit; }
};

struct StereoStudy {
  StereoStudyOptions options;
  std::vector<StereoRow> rows;
  double mm_per_px = 0.0;  // at the distance of the target
  // By target: the budget of all markers, then of each number (0: standard).
  struct Budget {
    StereoTarget target;
    std::optional<int> number;
    std::vector<BudgetLine> lines;
  };
  std::vector<Budget> budgets;
  std::vector<StereoTargetLine> goals;
  TaskReport tasks;

  std::vector<const StereoRow*> Rows(StereoTarget target, MarkerPoint point) const;
  const StereoRow* Row(StereoTarget target, MarkerPoint point, double psi_deg) const;
};

// Renders into `folder`/tasks; an interrupted study goes on.
StereoStudy RunStereoStudy(const StereoStudyOptions& options, const std::filesystem::path& folder,
                           Progress& progress);

// stereo_error.csv, budget.csv, summary.json.
nlohmann::json StereoSummary(const StereoStudy& study);
void WriteStereoStudyFiles(const StereoStudy& study, const std::filesystem::path& folder);
void WriteStereoStudyReport(const StereoStudy& study, const std::filesystem::path& folder,
                            const std::string& command_line);

}  // namespace retrolux
