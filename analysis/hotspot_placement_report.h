// What the report on hot spots says of a vault placement.
#pragma once

#include "analysis/hotspot_placement.h"
#include "analysis/report.h"

namespace retrolux {

// Verdict, pictures of the worst, plots, tables. Pictures are read from `folder`.
void AddHotspotPlacement(const HotspotPlacement& placement, const std::filesystem::path& folder,
                         Report& report);

}  // namespace retrolux
