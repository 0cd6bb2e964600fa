// The camera placement study of the thesis (chapter 4): where in the treatment vault do the cameras
// see a patient's mask best, in the worst case?
#pragma once

#include <optional>

#include "analysis/placement_grid.h"
#include "analysis/placement_tasks.h"

namespace retrolux {

struct VaultStudyOptions {
  std::vector<std::string> masks = {"face"};  // of the scenario; the worst of them decides
  bool refine = true;                         // phase 2, after phase 1
  bool extras = true;                         // sensitivity, variations, continuous refinement
  std::optional<Placement> placement;         // only this one (with `refine`: and those around it)
};

// A placement and all that is told of it beside its worst case.
struct NamedResult {
  std::string name;
  PlacementResult result;
  std::vector<std::vector<OrientationWorth>> orientations;  // by mask; empty where not asked for
};

struct VariedOptimum {
  std::string name;
  PlacementResult best;       // of phase 1 under the variation
  double cost_of_ours = 0.0;  // what the study's own optimum (nearest on the grid) costs there
};

struct VaultStudy {
  Scenario scenario;
  VaultStudyOptions options;
  std::vector<double> mask_area_mm2;                 // by mask
  std::vector<std::vector<MaskRotation>> rotations;  // by mask
  std::vector<PlacementResult> results;              // every placement once, phase 1 first
  NamedResult best;                                  // with its orientations
  std::optional<NamedResult> runner_up;              // best of those not Near it; with orientations
  std::vector<NamedResult> thesis;                   // table 4.9's placements in this room
  std::vector<NamedResult> sensitivity;              // one variable moved, "phi_b +1 deg"
  std::optional<NamedResult> snapped;
  std::optional<Refinement> refined;
  std::vector<VariedOptimum> variations;
  int views = 0, views_cut = 0;  // at the best placement: in how many the picture cuts the mask
  int rotations_too_close = 0;   // in which a nozzle can't keep its gap
  struct Rates {
    int64_t placements = 0;  // evaluated in this run, of all masks and orientations
    int64_t orientations = 0;
    int64_t buffers_made = 0, buffers_asked = 0;
    double seconds = 0.0;
  } rates;
  TaskReport tasks;
};

// Tasks go to folder/tasks; a study that was interrupted goes on where it was.
VaultStudy RunVaultStudy(const Scenario& scenario, const VaultStudyOptions& options,
                         MaskStores& stores, const std::filesystem::path& folder,
                         Progress& progress);

// solution.json's content; evaluations.csv, orientations.csv and solution.json into `folder`.
nlohmann::json VaultSolution(const VaultStudy& study);
void WriteVaultFiles(const VaultStudy& study, const std::filesystem::path& folder);

// The separation of cameras 1 and 2 after eq. 4.12: the column "Angle" of the thesis's table 4.9.
double ConsecutiveAngle_deg(const Scenario& scenario, const Placement& placement);

// A placement from a solution.json, or any JSON file with a "placement" like it. InputError.
Placement ReadPlacement(const std::filesystem::path& file);

}  // namespace retrolux
