// From which separation on does a neighbour change nothing, by each criterion?
//
// A level, a slope or a place has changed if it differs from that without neighbours by more than
// three times its noise in one picture (normal noise does so once in 370 pictures): of levels and
// slopes that of a pixel, of the contrast that of means over a marker's pixels, of places that of
// the method. A rate has
// changed if the exact paired test (McNemar) of the same pictures with and without the neighbours
// gives p < 0.0027, the same significance. The limit is the smallest angle of the study from which
// on nothing has changed at any larger one.
#pragma once

#include <optional>

#include "analysis/hotspot_rows.h"

namespace retrolux {

inline constexpr double kHotspotSigmas = 3.0;
inline constexpr double kHotspotP = 0.0027;
inline constexpr double kThesisLimit_deg = 15.0;  // thesis, section 4.3.2

// One criterion at one separation. Of a rate: `p` instead of `noise`.
struct HotspotChange {
  double change = 0.0;
  double noise = 0.0;
  std::optional<double> p;

  double Sigmas() const;  // change over noise; 0 of a rate
  bool Changed() const;
};

struct HotspotCriterion {
  const char* name;
  const char* unit;
  const char* meaning;
  HotspotChange (*measure)(const HotspotRow& row, const HotspotMix& mix);
};
// To add one: a row in the table of hotspot_verdict.cpp.
const std::vector<HotspotCriterion>& HotspotCriteria();

struct HotspotLimit {
  const HotspotCriterion* criterion;
  std::vector<HotspotChange> changes;  // by row
  std::optional<double> limit_deg;     // nothing: changed at the largest angle still
  bool never_changed = false;          // at no angle of the study
};
std::vector<HotspotLimit> LimitsOf(const std::vector<HotspotRow>& rows, const HotspotMix& mix);

// "12°", "none up to 40°", "unchanged from 2° on".
std::string LimitText(const HotspotLimit& limit, const std::vector<HotspotRow>& rows);

}  // namespace retrolux
