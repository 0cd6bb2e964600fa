#include "analysis/hotspot_verdict.h"

#include <cmath>

namespace retrolux {

namespace {

// Side of a marker in a picture at 1600 mm.
constexpr double kMarker_px = 28.0;

struct Pair {
  const HotspotMixRow &here, &reference;
};
Pair PairOf(const HotspotRow& row, const HotspotMix& mix) {
  return {row.Mix(mix.name), row.Mix(ReferenceOf(mix))};
}

HotspotChange LevelChange(const HotspotRow& row, const HotspotMix& mix,
                          double HotspotLevels::*level, double HotspotLevels::*noise,
                          double scale = 1.0) {
  const auto [here, reference] = PairOf(row, mix);
  return {scale * (here.mean.*level - reference.mean.*level), reference.mean.*noise, {}};
}

// The largest of the neighbours' rings by one of its parts, as bright as in the mix.
template <typename Part>
double OfNeighbours(const HotspotRow& row, const HotspotMix& mix, Part part) {
  double largest = 0.0;
  for (const RingLight& ring : row.rings) {
    if (ring.separation_deg > 0.0) largest = std::max(largest, part(ring));
  }
  return mix.neighbours * largest;
}

HotspotChange Saturation(const HotspotRow& row, const HotspotMix& mix) {
  const auto [here, reference] = PairOf(row, mix);
  const double more = here.mean.saturated_px - reference.mean.saturated_px;
  // Wells do not fill by chance: one pixel more is a change.
  return {more, 1.0 / kHotspotSigmas, {}};
}

HotspotChange HighlightChange(const HotspotRow& row, const HotspotMix& mix) {
  const double peak = mix.polarised ? 0.0 : OfNeighbours(row, mix, [](const RingLight& ring) {
    return ring.highlight.peak_e;
  });
  return {peak, PairOf(row, mix).reference.mean.background_noise_e, {}};
}

HotspotChange Background(const HotspotRow& row, const HotspotMix& mix) {
  return LevelChange(row, mix, &HotspotLevels::background_e, &HotspotLevels::background_noise_e);
}

HotspotChange Gradient(const HotspotRow& row, const HotspotMix& mix) {
  return LevelChange(row, mix, &HotspotLevels::gradient_e_px, &HotspotLevels::background_noise_e,
                     kMarker_px);
}

HotspotChange MarkerSignal(const HotspotRow& row, const HotspotMix& mix) {
  return LevelChange(row, mix, &HotspotLevels::marker_e, &HotspotLevels::marker_noise_e);
}

HotspotChange Lobe(const HotspotRow& row, const HotspotMix& mix) {
  return {OfNeighbours(row, mix, [](const RingLight& ring) { return ring.lobe_e; }),
          PairOf(row, mix).reference.mean.marker_noise_e,
          {}};
}

// d(M / B) = dM / B - M dB / B^2, with means over as many pixels as a marker has.
HotspotChange Contrast(const HotspotRow& row, const HotspotMix& mix) {
  const auto [here, reference] = PairOf(row, mix);
  const HotspotLevels& own = reference.mean;
  const double b = own.background_e;
  const double noise =
      b > 0.0 ? std::hypot(own.marker_noise_e / b, own.marker_e * own.background_noise_e / (b * b))
              : 0.0;
  return {here.mean.contrast - own.contrast, noise / std::sqrt(std::max(1.0, own.marker_px)), {}};
}

HotspotChange PlaceChange(const HotspotRow& row, const HotspotMix& mix, const char* method,
                          double HotspotMethodRow::*shift, double HotspotMethodRow::*noise) {
  const HotspotMethodRow& found = row.Mix(mix.name).methods.at(method);
  return {std::max(0.0, found.*shift), found.*noise, {}};
}

HotspotChange FalseChange(const HotspotRow& row, const HotspotMix& mix, const char* method) {
  const auto [here, reference] = PairOf(row, mix);
  const HotspotMethodRow& found = here.methods.at(method);
  return {found.false_detections - reference.methods.at(method).false_detections, 0.0,
          McNemarExactP(found.more_false, found.fewer_false)};
}

HotspotChange HitChange(const HotspotRow& row, const HotspotMix& mix, const char* method) {
  const HotspotMethodRow& found = row.Mix(mix.name).methods.at(method);
  const auto of = static_cast<double>(std::max<int64_t>(1, found.hits.of));
  return {100.0 * static_cast<double>(found.gained - found.lost) / of, 0.0,
          McNemarExactP(found.lost, found.gained)};
}

}  // namespace

double HotspotChange::Sigmas() const {
  return noise > 0.0 ? std::abs(change) / noise : 0.0;
}

bool HotspotChange::Changed() const {
  return p ? *p < kHotspotP : Sigmas() > kHotspotSigmas;
}

const std::vector<HotspotCriterion>& HotspotCriteria() {
  static const std::vector<HotspotCriterion> criteria = {
      {"saturation", "px", "more pixels at the full well", Saturation},
      {"highlight", "e-", "peak of the neighbour's highlight on the bare mask", HighlightChange},
      {"background", "e-", "level of the mask around markers", Background},
      {"gradient", "e-", "change of that level over a marker's side (28 px)", Gradient},
      {"marker", "e-", "level of the markers", MarkerSignal},
      {"retro tail", "e-", "of it, the retro-reflective lobe", Lobe},
      {"contrast", "1", "of markers to the mask around them", Contrast},
      {"centroid, edges", "px", "shift of the centroids that edges gives, rms",
       [](const HotspotRow& row, const HotspotMix& mix) {
         return PlaceChange(row, mix, "edges", &HotspotMethodRow::centroid_shift_px,
                            &HotspotMethodRow::centroid_noise_px);
       }},
      {"centroid, robust", "px", "shift of the centroids that robust gives, rms",
       [](const HotspotRow& row, const HotspotMix& mix) {
         return PlaceChange(row, mix, "robust", &HotspotMethodRow::centroid_shift_px,
                            &HotspotMethodRow::centroid_noise_px);
       }},
      {"corners, edges", "px", "shift of the corners that edges gives, rms",
       [](const HotspotRow& row, const HotspotMix& mix) {
         return PlaceChange(row, mix, "edges", &HotspotMethodRow::corner_shift_px,
                            &HotspotMethodRow::corner_noise_px);
       }},
      {"corners, robust", "px", "shift of the corners that robust gives, rms",
       [](const HotspotRow& row, const HotspotMix& mix) {
         return PlaceChange(row, mix, "robust", &HotspotMethodRow::corner_shift_px,
                            &HotspotMethodRow::corner_noise_px);
       }},
      {"false detections, edges", "a picture",
       "of edges: wrong names, and patterns off every marker",
       [](const HotspotRow& row, const HotspotMix& mix) { return FalseChange(row, mix, "edges"); }},
      {"false detections, robust", "a picture",
       "of robust: wrong names, and patterns off every marker",
       [](const HotspotRow& row, const HotspotMix& mix) {
         return FalseChange(row, mix, "robust");
       }},
      {"hits, edges", "%", "markers that edges names rightly",
       [](const HotspotRow& row, const HotspotMix& mix) { return HitChange(row, mix, "edges"); }},
      {"hits, robust", "%", "markers that robust names rightly",
       [](const HotspotRow& row, const HotspotMix& mix) { return HitChange(row, mix, "robust"); }},
  };
  return criteria;
}

std::vector<HotspotLimit> LimitsOf(const std::vector<HotspotRow>& rows, const HotspotMix& mix) {
  std::vector<HotspotLimit> limits;
  for (const HotspotCriterion& criterion : HotspotCriteria()) {
    HotspotLimit limit{&criterion, {}, std::nullopt, true};
    for (const HotspotRow& row : rows) {
      limit.changes.push_back(criterion.measure(row, mix));
      const bool changed = limit.changes.back().Changed();
      limit.never_changed = limit.never_changed && !changed;
      if (changed) {
        limit.limit_deg.reset();
      } else if (!limit.limit_deg) {
        limit.limit_deg = row.psi_deg;
      }
    }
    limits.push_back(std::move(limit));
  }
  return limits;
}

std::string LimitText(const HotspotLimit& limit, const std::vector<HotspotRow>& rows) {
  if (limit.never_changed) return fmt::format("unchanged from {:g}° on", rows.front().psi_deg);
  if (limit.limit_deg) return fmt::format("{:g}°", *limit.limit_deg);
  return fmt::format("none up to {:g}°", rows.back().psi_deg);
}

}  // namespace retrolux
