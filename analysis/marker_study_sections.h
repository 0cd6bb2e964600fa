// Sections of the marker study's report, a file each.
#pragma once

#include "analysis/marker_coverage.h"
#include "analysis/report.h"

namespace retrolux {

// What the study's method gains over `edges`; adds nothing if the method is `edges`.
void AddGain(const MarkerStudy& study, const StudyCoverage& coverage, Report& report);

// Maps of the oval: usable positions, how many cameras, and each camera's outcomes.
void AddMaps(const MarkerStudy& study, const StudyCoverage& coverage, Report& report);

// The room in three dimensions, the mask coloured by how many cameras identify a marker.
void AddRoom(const MarkerStudy& study, const StudyCoverage& coverage, const Scene& room,
             Report& report);

// 33015.4 -> "33,015"
std::string Grouped(double value);

}  // namespace retrolux
