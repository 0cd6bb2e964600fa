// The tables of the report on hot spots: verdict, and the room.
#pragma once

#include "analysis/hotspot_study.h"
#include "analysis/report.h"

namespace retrolux {

void AddHotspotVerdict(const HotspotStudy& study, Report& report);
// `all`: the mix of all rings that the views have.
void AddHotspotRoomTables(const std::vector<HotspotRoomView>& room, const HotspotMix& all,
                          Report& report);

}  // namespace retrolux
