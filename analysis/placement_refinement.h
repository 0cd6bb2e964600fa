// The best placement between the grid's points.
#pragma once

#include <functional>

#include "scenes/rig_layout.h"

namespace retrolux {

struct Refinement {
  Placement placement;
  double cost = 0.0;  // what the cost function gives there
  int evaluations = 0;
};

// Climbs `cost` from `start` without derivatives (NLopt's Sbplx, a subspace Nelder-Mead: the worst
// of many orientations has kinks), within the intervals of the search, to where steps fall below
// `tolerance_deg` or after `most_evaluations`. Only placements that can be built are asked for.
// Never ends lower than it began.
Refinement RefinePlacement(const Scenario& scenario, const Placement& start,
                           const std::function<double(const Placement&)>& cost,
                           double tolerance_deg, int most_evaluations);

}  // namespace retrolux
