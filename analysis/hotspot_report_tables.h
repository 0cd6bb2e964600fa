// The tables of the report on hot spots: verdict, and the room.
#pragma once

#include "analysis/hotspot_study.h"
#include "analysis/report.h"

namespace retrolux {

void AddHotspotVerdict(const HotspotStudy& study, Report& report);
void AddHotspotRoomTables(const HotspotStudy& study, Report& report);

}  // namespace retrolux
