// Pictures of hot spots for people: what the camera records, and the neighbours' light in false
// colours.
#pragma once

#include <optional>
#include <string>

#include "analysis/hotspot_shot.h"
#include "analysis/report.h"

namespace retrolux {

// The part of the picture that shows the object, with a margin, PNG. The digital picture with dark
// levels raised (gamma 2.2).
std::string RecordedPng(const HotspotStage& stage, const HotspotMix& mix, uint64_t noise_key);
// Mean signal of all rings but the own one, in steps of a sixth of a decade.
std::string NeighboursPng(const HotspotStage& stage);
// What the colours of NeighboursPng mean, e-.
std::vector<OvalCategory> NeighboursScale();

}  // namespace retrolux
