// The plots over the angle of the report on hot spots.
#pragma once

#include "analysis/hotspot_study.h"
#include "analysis/report.h"

namespace retrolux {

// Light by mechanism, levels, places, names, and where highlights triangulate.
void AddHotspotPlots(const HotspotSeries& series, Report& report);

}  // namespace retrolux
