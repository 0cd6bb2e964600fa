// What a placement's triples say: by pair of cameras, by how far the cameras stand apart, and in
// words.
#pragma once

#include "analysis/hotspot_placement.h"

namespace retrolux {

// Two cameras, each in the other's light.
struct PlacementPair {
  size_t a = 0, b = 0;  // a < b
  double separation_deg = 0.0;
  int rendered = 0, hot = 0;  // rotations: rendered; with a hot spot in one of the two pictures
  int forecast_hot = 0;       // rotations, of all, with a forecast above three times the noise
  double forecast_peak_e = 0.0;
  const PlacementTriple* worst = nullptr;  // the rendered one with the brightest highlight
  double highlight_sigmas = 0.0, tail_sigmas = 0.0, beam_sigmas = 0.0;  // the largest
  int64_t names = 0, lost = 0, gained = 0;  // by robust: markers x exposures
};
// The brightest highlight first. Points into the placement.
std::vector<PlacementPair> PairsOf(const HotspotPlacement& placement);

// The rendered triples of pairs from `from_deg` up to `to_deg` apart.
struct SeparationClass {
  double from_deg = 0.0, to_deg = 0.0;
  int pairs = 0, triples = 0, hot = 0;
  double median_e = 0.0, peak_e = 0.0;  // of their highlights
  double tail_sigmas = 0.0;             // the largest
  int64_t names = 0, lost = 0, gained = 0;
};
// The first one ends at the thesis's limit.
std::vector<SeparationClass> ClassesOf(const HotspotPlacement& placement);

// How the render's highlights compare with the forecast of those above three times the noise: the
// middle one of their quotients, and those that nine of ten lie between.
struct ForecastQuality {
  int triples = 0;
  double low = 0.0, median = 0.0, high = 0.0;
};
ForecastQuality QualityOf(const HotspotPlacement& placement);

// A sentence each; **bold** as in Report::Paragraph.
std::vector<std::string> VerdictOf(const HotspotPlacement& placement);

// "camera-1 lit by camera-4, x 0°, y 10°, z 40°"
std::string TextOf(const HotspotPlacement& placement, const PlacementTriple& triple);

}  // namespace retrolux
