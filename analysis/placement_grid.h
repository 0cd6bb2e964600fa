// The placements that a search looks at: the grid of phase 1, its local optima, the finer grid
// around them of phase 2, and the nearest placement that a workshop can build.
#pragma once

#include <vector>

#include "scenes/rig_layout.h"

namespace retrolux {

// Every combination of the scenario's steps that can be built, by phi_b, theta_1, theta_2.
// InputError if there is none.
std::vector<Placement> PlacementGrid(const Scenario& scenario);

// The places in `placements` (a PlacementGrid) whose cost no neighbour exceeds, best first, at most
// `most`. Neighbours are one step away in one or more variables.
std::vector<size_t> LocalOptima(const Scenario& scenario, const std::vector<Placement>& placements,
                                const std::vector<double>& costs, size_t most);

// One step of the grid to every side of `centre`, in refined steps, as far as it is in the
// scenario's intervals and can be built.
std::vector<Placement> RefinedGrid(const Scenario& scenario, const Placement& centre);

// Whether b lies within one step of the grid of a, in every variable.
bool Near(const Scenario& scenario, const Placement& a, const Placement& b);

// phi_b to a multiple of snap_phi_b_deg, the heights of the rigs above the floor to multiples of
// snap_height_mm, to the nearest that can be built; the placement itself if none can.
Placement Snapped(const Scenario& scenario, const Placement& placement);

}  // namespace retrolux
