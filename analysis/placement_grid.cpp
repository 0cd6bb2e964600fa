#include "analysis/placement_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace retrolux {

namespace {

// Grid values are multiples of a step; two of them are the same within this part of it.
constexpr double kSlack = 1e-6;

void AddBuildable(const Scenario& scenario, const Placement& placement,
                  std::vector<Placement>& placements) {
  if (scenario.rigs.same_height && placement.theta1_deg != placement.theta2_deg) return;
  if (NotBuildable(scenario, placement).empty()) placements.push_back(placement);
}

std::vector<Placement> Buildable(const Scenario& scenario, const std::vector<double>& phi_b_deg,
                                 const std::vector<double>& theta1_deg,
                                 const std::vector<double>& theta2_deg) {
  std::vector<Placement> placements;
  for (const double phi_b : phi_b_deg) {
    for (const double theta1 : theta1_deg) {
      for (const double theta2 : theta2_deg)
        AddBuildable(scenario, {phi_b, theta1, theta2}, placements);
    }
  }
  return placements;
}

// Multiples of `step` around `centre` of a step, up to one step of the interval to either side,
// within it.
std::vector<double> Around(const Steps& interval, double centre, double step) {
  const int count = static_cast<int>(std::floor(interval.step / step + kSlack));
  std::vector<double> values;
  for (int i = -count; i <= count; ++i) {
    const double value = centre + i * step;
    if (value >= interval.from - kSlack * step && value <= interval.to + kSlack * step)
      values.push_back(value);
  }
  return values;
}

}  // namespace

std::vector<Placement> PlacementGrid(const Scenario& scenario) {
  const std::vector<double> theta_deg = scenario.search.theta_deg.Values();
  std::vector<Placement> placements =
      Buildable(scenario, scenario.search.phi_b_deg.Values(), theta_deg, theta_deg);
  if (placements.empty()) {
    const Placement first = {scenario.search.phi_b_deg.from, theta_deg.front(), theta_deg.front()};
    throw InputError::At(scenario.file, "/search",
                         fmt::format("no placement that can be built; the first has {}",
                                     NotBuildable(scenario, first)),
                         "intervals within the bounds of /rigs");
  }
  return placements;
}

bool Near(const Scenario& scenario, const Placement& a, const Placement& b) {
  const double phi_b_step = scenario.search.phi_b_deg.step * (1.0 + kSlack);
  const double theta_step = scenario.search.theta_deg.step * (1.0 + kSlack);
  return std::abs(a.phi_b_deg - b.phi_b_deg) <= phi_b_step &&
         std::abs(a.theta1_deg - b.theta1_deg) <= theta_step &&
         std::abs(a.theta2_deg - b.theta2_deg) <= theta_step;
}

std::vector<size_t> LocalOptima(const Scenario& scenario, const std::vector<Placement>& placements,
                                const std::vector<double>& costs, size_t most) {
  std::vector<size_t> optima;
  for (size_t i = 0; i < placements.size(); ++i) {
    bool highest = true;
    for (size_t j = 0; j < placements.size() && highest; ++j) {
      // On a plateau the first of equals stands for it.
      const bool exceeds = costs[j] > costs[i] || (costs[j] == costs[i] && j < i);
      highest = !(exceeds && Near(scenario, placements[i], placements[j]));
    }
    if (highest) optima.push_back(i);
  }
  std::stable_sort(optima.begin(), optima.end(),
                   [&](size_t a, size_t b) { return costs[a] > costs[b]; });
  optima.resize(std::min(optima.size(), most));
  return optima;
}

std::vector<Placement> RefinedGrid(const Scenario& scenario, const Placement& centre) {
  const SearchSpec& search = scenario.search;
  return Buildable(scenario,
                   Around(search.phi_b_deg, centre.phi_b_deg, search.refined_phi_b_step_deg),
                   Around(search.theta_deg, centre.theta1_deg, search.refined_theta_step_deg),
                   Around(search.theta_deg, centre.theta2_deg, search.refined_theta_step_deg));
}

namespace {

// The polar angles of the rig heights around `theta_deg` that a workshop can build.
std::vector<double> SnappedThetas(const Scenario& scenario, double theta_deg) {
  const double step = scenario.search.snap_height_mm;
  const double above_floor = scenario.isocentre_height_mm + RigHeight_mm(scenario, theta_deg);
  std::vector<double> thetas;
  for (const double height : {std::floor(above_floor / step), std::ceil(above_floor / step)})
    thetas.push_back(ThetaAtHeight_deg(scenario, height * step - scenario.isocentre_height_mm));
  return thetas;
}

}  // namespace

Placement Snapped(const Scenario& scenario, const Placement& placement) {
  const double step = scenario.search.snap_phi_b_deg;
  double phi_b = step * std::round(placement.phi_b_deg / step);
  if (scenario.cameras.arrangement == Arrangement::kEven) phi_b = placement.phi_b_deg;
  Placement nearest = placement;
  double least = std::numeric_limits<double>::infinity();
  for (const Placement& candidate :
       Buildable(scenario, {phi_b}, SnappedThetas(scenario, placement.theta1_deg),
                 SnappedThetas(scenario, placement.theta2_deg))) {
    const double distance = std::abs(candidate.theta1_deg - placement.theta1_deg) +
                            std::abs(candidate.theta2_deg - placement.theta2_deg);
    if (distance < least) nearest = candidate;
    least = std::min(least, distance);
  }
  return nearest;
}

}  // namespace retrolux
