// The tables of a vault placement's hot spots (docs/file-formats.md).
#pragma once

#include "analysis/hotspot_placement.h"

namespace retrolux {

// What summary.json says of it.
nlohmann::json PlacementSummary(const HotspotPlacement& placement);

// placement.csv and placement_pairs.csv.
void WritePlacementFiles(const HotspotPlacement& placement, const std::filesystem::path& folder);

}  // namespace retrolux
