// The treatment vault with a placement of cameras, drawn to scale from above and from the side.
#pragma once

#include "analysis/placement_cost.h"
#include "analysis/plotly_figure.h"
#include "scenes/nozzle.h"

namespace retrolux {

// What is drawn: a placement, and the orientation of the mask that it is drawn for.
struct VaultSetup {
  const Scenario& scenario;
  Placement placement;
  CameraSet combination = 0;  // cameras marked, with their lines of sight
  std::vector<PlacedNozzle> nozzles;
  std::vector<Vec3d> mask_points;  // world
};

// Two drawings side by side: from above (x to the right, y upwards) and from the side (x to the
// right, z upwards).
PlotlyFigure DrawVault(const VaultSetup& setup);

}  // namespace retrolux
