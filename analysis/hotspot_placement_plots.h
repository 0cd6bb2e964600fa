// The plots of a vault placement's hot spots.
#pragma once

#include "analysis/hotspot_placement.h"
#include "analysis/report.h"

namespace retrolux {

// Highlights over the separation, pairs by rotations, and the forecast against the render.
void AddPlacementPlots(const HotspotPlacement& placement, Report& report);

}  // namespace retrolux
