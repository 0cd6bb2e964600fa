// Shots of the same separation put together: means over the placements, with their uncertainty.
#pragma once

#include "analysis/hotspot_shot.h"
#include "classifier/proportion.h"

namespace retrolux {

// What a method makes of one mix, beside its reference without neighbours (ReferenceOf).
struct HotspotMethodRow {
  Proportion hits;                // markers named rightly, of those wholly seen, in exposures
  int64_t lost = 0, gained = 0;   // of these, only the reference named, only this mix
  double false_detections = 0.0;  // a picture: wrong names, and patterns off every marker
  double false_error = 0.0;       // standard error of that, over pictures
  double wrong_names = 0.0;       // a picture
  int64_t more_false = 0, fewer_false = 0;  // pictures with more, with fewer than the reference
  // rms over markers, px; nothing was found in both: negative.
  double centroid_shift_px = -1.0, corner_shift_px = -1.0;  // without noise
  double noisy_shift_px = -1.0;       // of the mean over exposures, its own noise taken off
  double noisy_shift_error_px = 0.0;  // 1 sigma of that
  double centroid_noise_px = 0.0, corner_noise_px = 0.0;  // of one picture, u or v
};

struct HotspotMixRow {
  std::string mix;
  HotspotLevels mean, error;  // error: standard error over the placements, 0 of a single one
  std::map<std::string, HotspotMethodRow> methods;
};

struct HotspotRow {
  double psi_deg = 0.0;
  std::vector<HotspotShot> shots;  // by placement
  std::vector<HotspotMixRow> mixes;
  std::vector<RingLight> rings;  // mean over the placements; places are those of the first

  const HotspotMixRow& Mix(const std::string& name) const;
  double RenderNoise() const;  // the largest of the shots
};
HotspotRow RowOf(double psi_deg, std::vector<HotspotShot> shots,
                 const std::vector<HotspotMix>& mixes);

}  // namespace retrolux
