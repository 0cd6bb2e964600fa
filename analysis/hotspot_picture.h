// Pictures of hot spots for people: what the camera records, and the neighbours' light in false
// colours.
#pragma once

#include <filesystem>
#include <string>

#include "analysis/hotspot_view.h"
#include "analysis/report.h"

namespace retrolux {

// The part of the picture that shows the object, with a margin, PNG. The digital picture with dark
// levels raised (gamma 2.2).
std::string RecordedPng(const HotspotStage& stage, const HotspotMix& mix, uint64_t noise_key);
// Mean signal of the rings that the mix adds to the own one, in steps of a sixth of a decade.
std::string NeighboursPng(const HotspotStage& stage, const HotspotMix& mix);
// What the colours of NeighboursPng mean, e-.
std::vector<OvalCategory> NeighboursScale();

// Writes a stage as `folder`/pictures/NAME_KIND.png in the own ring's light ("own"), in that of the
// mix ("both"), and what the mix adds ("neighbours"), and tells their files and hashes; the noise
// is that of the first exposure of ShootHotspots. The "kept" of a task's result
// (KeptPicturesAreThere).
nlohmann::json KeepHotspotPictures(const HotspotStage& stage, const HotspotMix& mix,
                                   const std::string& name, uint64_t noise_seed,
                                   const std::filesystem::path& folder);
std::vector<HotspotPicture> KeptHotspotPictures(const nlohmann::json& result);

}  // namespace retrolux
