// What the study of hot spots says to a search for placements.
#pragma once

#include <filesystem>

namespace retrolux {

// The least separation of two cameras, degrees, at which a neighbour's ring changes nothing of what
// is measured: the largest limit of the study's criteria of `robust` (places, names, false
// detections), without variation, all rings on. From the summary.json of `study hotspot`;
// InputError if it is none, or if one of them still changes at the study's largest angle.
double HotspotLimit_deg(const std::filesystem::path& summary);

}  // namespace retrolux
