#include "analysis/placement_refinement.h"

#include <algorithm>
#include <limits>
#include <nlopt.hpp>

namespace retrolux {

namespace {

// A placement as the variables that the scenario leaves free.
class Variables {
 public:
  Variables(const Scenario& scenario, const Placement& start)
      : varies_phi_b_(scenario.cameras.arrangement == Arrangement::kBesideBeam),
        one_height_(scenario.rigs.same_height),
        start_(start) {}

  std::vector<double> From(const Placement& placement) const {
    std::vector<double> x;
    if (varies_phi_b_) x.push_back(placement.phi_b_deg);
    x.push_back(placement.theta1_deg);
    if (!one_height_) x.push_back(placement.theta2_deg);
    return x;
  }
  Placement To(const std::vector<double>& x) const {
    Placement placement = start_;
    size_t next = 0;
    if (varies_phi_b_) placement.phi_b_deg = x[next++];
    placement.theta1_deg = x[next++];
    placement.theta2_deg = one_height_ ? placement.theta1_deg : x[next];
    return placement;
  }

 private:
  bool varies_phi_b_, one_height_;
  Placement start_;
};

// What NLopt's C callback is handed.
struct Climb {
  const Scenario& scenario;
  const Variables& variables;
  const std::function<double(const Placement&)>& cost;
  Refinement best;
};

double CostAt(const std::vector<double>& x, std::vector<double>&, void* data) {
  Climb& climb = *static_cast<Climb*>(data);
  const Placement placement = climb.variables.To(x);
  if (!NotBuildable(climb.scenario, placement).empty()) return 0.0;
  ++climb.best.evaluations;
  const double cost = climb.cost(placement);
  if (cost > climb.best.cost) {
    climb.best.cost = cost;
    climb.best.placement = placement;
  }
  return cost;
}

}  // namespace

Refinement RefinePlacement(const Scenario& scenario, const Placement& start,
                           const std::function<double(const Placement&)>& cost,
                           double tolerance_deg, int most_evaluations) {
  const SearchSpec& spec = scenario.search;
  const Variables variables(scenario, start);
  Climb climb = {scenario, variables, cost, {start, -1.0, 0}};
  const auto at = [&](double phi_b, double theta) { return variables.From({phi_b, theta, theta}); };
  std::vector<double> x = variables.From(start);
  std::vector<double> low = at(spec.phi_b_deg.from, spec.theta_deg.from);
  std::vector<double> high = at(spec.phi_b_deg.to, spec.theta_deg.to);
  for (size_t i = 0; i < x.size(); ++i) {  // grid points are rounded
    low[i] = std::min(low[i], x[i]);
    high[i] = std::max(high[i], x[i]);
  }
  nlopt::opt optimiser(nlopt::LN_SBPLX, static_cast<unsigned>(x.size()));
  optimiser.set_max_objective(CostAt, &climb);
  optimiser.set_lower_bounds(low);
  optimiser.set_upper_bounds(high);
  optimiser.set_initial_step(at(spec.refined_phi_b_step_deg, 0.5 * spec.refined_theta_step_deg));
  optimiser.set_xtol_abs(tolerance_deg);
  optimiser.set_maxeval(most_evaluations);
  double value = 0.0;
  try {
    optimiser.optimize(x, value);
  } catch (const nlopt::roundoff_limited&) {
    // Steps smaller than doubles tell apart: as far as it gets.
  }
  return climb.best;
}

}  // namespace retrolux
