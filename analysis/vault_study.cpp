#include "analysis/vault_study.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace retrolux {

namespace {

const PlacementResult& BestOf(const std::vector<PlacementResult>& results) {
  return *std::max_element(results.begin(), results.end(),
                           [](const auto& a, const auto& b) { return a.Cost() < b.Cost(); });
}

std::vector<double> CostsOf(const std::vector<PlacementResult>& results) {
  std::vector<double> costs;
  for (const PlacementResult& result : results) costs.push_back(result.Cost());
  return costs;
}

std::vector<Placement> PlacesOf(const std::vector<PlacementResult>& results) {
  std::vector<Placement> places;
  for (const PlacementResult& result : results) places.push_back(result.Where());
  return places;
}

// What phase 2 looks at: around the centres, without what `known` holds.
std::vector<Placement> AroundAll(const Scenario& scenario, const std::vector<Placement>& centres,
                                 std::vector<Placement> known) {
  const auto same = [](const Placement& a, const Placement& b) {
    constexpr double kSlack_deg = 1e-9;
    return std::abs(a.phi_b_deg - b.phi_b_deg) < kSlack_deg &&
           std::abs(a.theta1_deg - b.theta1_deg) < kSlack_deg &&
           std::abs(a.theta2_deg - b.theta2_deg) < kSlack_deg;
  };
  std::vector<Placement> found;
  for (const Placement& centre : centres) {
    for (const Placement& p : RefinedGrid(scenario, centre)) {
      if (std::any_of(known.begin(), known.end(), [&](const Placement& k) { return same(k, p); }))
        continue;
      known.push_back(p);
      found.push_back(p);
    }
  }
  return found;
}

// The optimum with one variable moved to either side, as far as it can be built.
std::vector<std::pair<std::string, Placement>> Moved(const Scenario& scenario,
                                                     const Placement& best) {
  const SearchSpec& spec = scenario.search;
  std::vector<std::pair<std::string, Placement>> moved;
  const auto add = [&](const char* variable, double Placement::*which, double by) {
    Placement placement = best;
    placement.*which += by;
    if (scenario.rigs.same_height) placement.theta2_deg = placement.theta1_deg;
    const bool again = std::any_of(moved.begin(), moved.end(),
                                   [&](const auto& other) { return other.second == placement; });
    const bool beside = placement.phi_b_deg < spec.phi_b_deg.from ||
                        placement.phi_b_deg > spec.phi_b_deg.to;  // of what is searched
    if (!again && !beside && NotBuildable(scenario, placement).empty())
      moved.emplace_back(fmt::format("{} {:+g} deg", variable, by), placement);
  };
  for (const double sign : {-1.0, 1.0}) {
    if (scenario.cameras.arrangement == Arrangement::kBesideBeam) {
      for (const double step : {spec.refined_phi_b_step_deg, spec.snap_phi_b_deg})
        add("phi_b", &Placement::phi_b_deg, sign * step);
    }
    for (const double step : {spec.refined_theta_step_deg, spec.theta_deg.step}) {
      add("theta_1", &Placement::theta1_deg, sign * step);
      if (!scenario.rigs.same_height) add("theta_2", &Placement::theta2_deg, sign * step);
    }
  }
  return moved;
}

void CountCutViews(const Room& room, VaultStudy& study) {
  for (size_t m = 0; m < room.searches.size(); ++m) {
    const PlacementSearch& search = room.searches[m];
    for (const Vec3d& centre : CameraCentres(room.scenario, study.best.result.Where())) {
      const CameraModel camera = VaultCamera(room.scenario, "", centre);
      for (const MaskRotation& rotation : search.Rotations()) {
        CameraModel from_mask = camera;
        from_mask.camera_from_world =
            camera.camera_from_world * RigidTransform{rotation.world_from_mask, Vec3d::Zero()};
        ++study.views;
        if (search.TheMask().AreaOutsidePicture(from_mask) > 0.0) ++study.views_cut;
      }
    }
    study.rotations_too_close += search.RotationsTooClose();
  }
}

// One name for the placements that a study looks at beside its grid.
std::vector<NamedResult> EvaluateNamed(PlacementTasks& tasks, const std::string& stage,
                                       const Room& room,
                                       const std::vector<std::pair<std::string, Placement>>& named,
                                       const Placement& hint) {
  std::vector<NamedResult> results;
  if (named.empty()) return results;
  Slice slice;
  slice.hint = hint;
  for (const auto& [name, placement] : named) slice.placements.push_back(placement);
  std::vector<PlacementResult> evaluated = tasks.Evaluate(stage, 0, room, {slice});
  for (size_t i = 0; i < named.size(); ++i)
    results.push_back({named[i].first, std::move(evaluated[i]), {}});
  return results;
}

void EvaluateVariations(PlacementTasks& tasks, const Scenario& scenario, MaskStores& stores,
                        VaultStudy& study) {
  for (const Variation& variation : scenario.variations) {
    const Room room(scenario.With(variation), study.options.masks, stores);
    const std::vector<PlacementResult> results =
        tasks.Evaluate(variation.name, 1, room, SlicesOf(PlacementGrid(room.scenario), {}));
    const Placement& ours = study.best.result.Where();
    const auto distance = [&](const Placement& p) {
      return std::abs(p.phi_b_deg - ours.phi_b_deg) + std::abs(p.theta1_deg - ours.theta1_deg) +
             std::abs(p.theta2_deg - ours.theta2_deg);
    };
    const auto nearest = std::min_element(results.begin(), results.end(),
                                          [&](const PlacementResult& a, const PlacementResult& b) {
                                            return distance(a.Where()) < distance(b.Where());
                                          });
    study.variations.push_back({variation.name, BestOf(results), nearest->Cost()});
  }
}

// The mean over all orientations, of the mask that is worse off.
double MeanCost(const NamedResult& named) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::vector<OrientationWorth>& mask : named.orientations) {
    double sum = 0.0;
    for (const OrientationWorth& worth : mask) sum += worth.cost_mm2;
    least = std::min(least, sum / static_cast<double>(mask.size()));
  }
  return least;
}

// The highest cost. Where the worst orientation is seen best by cameras of one rig alone, the
// height of the other rig does not matter to it and several placements are equal: then the one that
// is best in the mean.
NamedResult Optimum(PlacementTasks& tasks, const Room& room,
                    const std::vector<PlacementResult>& results) {
  const double highest = BestOf(results).Cost();
  std::optional<NamedResult> best;
  for (const PlacementResult& result : results) {
    if (result.Cost() < highest) continue;
    NamedResult tied = {"optimum", result, {}};
    const Placement& at = result.Where();
    tied.orientations = tasks.Orientations(fmt::format("all orientations at {:g} {:g} {:g}",
                                                       at.phi_b_deg, at.theta1_deg, at.theta2_deg),
                                           room, at);
    if (!best || MeanCost(tied) > MeanCost(*best)) best = std::move(tied);
  }
  return *best;
}

void Search(PlacementTasks& tasks, const Room& room, VaultStudy& study) {
  const Scenario& scenario = room.scenario;
  std::vector<Placement> centres;
  if (study.options.placement) {
    centres = {*study.options.placement};
    study.results = tasks.Evaluate("placement", 1, room, {{centres, centres.front()}});
  } else {
    study.results = tasks.Evaluate("phase 1", 1, room, SlicesOf(PlacementGrid(scenario), {}));
    const std::vector<Placement> grid = PlacesOf(study.results);
    for (const size_t i : LocalOptima(scenario, grid, CostsOf(study.results),
                                      static_cast<size_t>(scenario.search.refined_optima)))
      centres.push_back(grid[i]);
  }
  if (study.options.refine) {
    const std::vector<Placement> around = AroundAll(scenario, centres, PlacesOf(study.results));
    for (PlacementResult& result : tasks.Evaluate("phase 2", 2, room, SlicesOf(around, centres)))
      study.results.push_back(std::move(result));
  }
  if (BestOf(study.results).Worst().worth.combination == 0) {
    throw InputError::At(scenario.file, "/combinations",
                         fmt::format("no combination with {} degrees between any two cameras, at "
                                     "any placement",
                                     scenario.combinations.min_separation_deg),
                         "a smaller min_separation_deg");
  }
  study.best = Optimum(tasks, room, study.results);
  std::vector<PlacementResult> far;
  for (const PlacementResult& result : study.results) {
    if (!Near(scenario, result.Where(), study.best.result.Where())) far.push_back(result);
  }
  if (far.empty()) return;
  study.runner_up = NamedResult{"best away from the optimum", BestOf(far), {}};
  study.runner_up->orientations =
      tasks.Orientations("runner-up, all orientations", room, study.runner_up->result.Where());
}

void AddThesis(PlacementTasks& tasks, const Room& room, VaultStudy& study) {
  std::vector<std::pair<std::string, Placement>> rows;
  for (const ThesisSolution& row : room.scenario.thesis)
    rows.push_back({row.name, {row.phi_b_deg, row.theta1_deg, row.theta2_deg}});
  if (rows.empty()) return;
  study.thesis = EvaluateNamed(tasks, "the thesis's placements", room, rows, rows.front().second);
  for (NamedResult& row : study.thesis)
    row.orientations = tasks.Orientations(fmt::format("thesis {}, all orientations", row.name),
                                          room, row.result.Where());
}

}  // namespace

VaultStudy RunVaultStudy(const Scenario& scenario, const VaultStudyOptions& options,
                         MaskStores& stores, const std::filesystem::path& folder,
                         Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const int64_t made = stores.Made(), asked = stores.Asked();
  VaultStudy study;
  study.scenario = scenario;
  study.options = options;
  const Room room(scenario, options.masks, stores);
  for (const PlacementSearch& search : room.searches) {
    study.mask_area_mm2.push_back(search.TheMask().Samples().area_mm2);
    study.rotations.push_back(search.Rotations());
  }
  PlacementTasks tasks(folder, {{"rule", NameOf(room.searches.front().TheMask().Rule())}},
                       progress);
  Search(tasks, room, study);
  AddThesis(tasks, room, study);
  if (options.extras && !options.placement) {
    const Placement& best = study.best.result.Where();
    study.sensitivity = EvaluateNamed(tasks, "sensitivity", room, Moved(scenario, best), best);
    study.snapped =
        EvaluateNamed(tasks, "snapped", room, {{"snapped", Snapped(scenario, best)}}, best).front();
    study.refined = tasks.Refine(room, best);
    EvaluateVariations(tasks, scenario, stores, study);
  }
  CountCutViews(room, study);
  study.tasks = tasks.Report();
  study.rates = {tasks.Placements(), tasks.OrientationsSeen(), stores.Made() - made,
                 stores.Asked() - asked,
                 std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
  return study;
}

}  // namespace retrolux
