#include "analysis/hotspot_rows.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"

namespace retrolux {

namespace {

constexpr double HotspotLevels::*kLevels[] = {&HotspotLevels::peak_e,
                                              &HotspotLevels::saturated_px,
                                              &HotspotLevels::saturated_mask_px,
                                              &HotspotLevels::background_e,
                                              &HotspotLevels::gradient_e_px,
                                              &HotspotLevels::marker_e,
                                              &HotspotLevels::contrast,
                                              &HotspotLevels::marker_px,
                                              &HotspotLevels::background_noise_e,
                                              &HotspotLevels::marker_noise_e};

struct Sample {
  double count = 0.0, sum = 0.0, squares = 0.0;
  void Add(double x) {
    ++count;
    sum += x;
    squares += x * x;
  }
  double Mean() const { return count > 0.0 ? sum / count : 0.0; }
  // Standard error of the mean.
  double Error() const {
    if (count < 2.0) return 0.0;
    return std::sqrt(std::max(0.0, squares - sum * sum / count) / (count * (count - 1.0)));
  }
  double Rms() const { return count > 0.0 ? std::sqrt(squares / count) : -1.0; }
};

const MixResult& ResultOf(const HotspotShot& shot, const std::string& mix) {
  const auto found = std::find_if(shot.mixes.begin(), shot.mixes.end(),
                                  [&](const MixResult& result) { return result.mix == mix; });
  RETROLUX_CHECK(found != shot.mixes.end(), "no mix {}", mix);
  return *found;
}

void AddHits(const MixDetections& here, const MixDetections& there, HotspotMethodRow& row) {
  for (size_t m = 0; m < here.found.size(); ++m) {
    for (size_t k = 0; k < here.found[m].size(); ++k) {
      const bool now = here.found[m][k] != 0, before = there.found[m][k] != 0;
      ++row.hits.of;
      row.hits.count += now ? 1 : 0;
      row.gained += now && !before ? 1 : 0;
      row.lost += before && !now ? 1 : 0;
    }
  }
}

HotspotMethodRow MethodRow(const std::vector<HotspotShot>& shots, const HotspotMix& mix,
                           const std::string& method) {
  HotspotMethodRow row;
  Sample false_detections, wrong_names, centroid, corner, centroid_noise, corner_noise;
  double squares = 0.0, freedoms = 0.0, noise_squares = 0.0;
  for (const HotspotShot& shot : shots) {
    const MixDetections& here = ResultOf(shot, mix.name).methods.at(method);
    const MixDetections& there = ResultOf(shot, ReferenceOf(mix)).methods.at(method);
    AddHits(here, there, row);
    for (size_t k = 0; k < here.wrong_names.size(); ++k) {
      const int now = here.wrong_names[k] + here.strays[k];
      const int before = there.wrong_names[k] + there.strays[k];
      false_detections.Add(now);
      wrong_names.Add(here.wrong_names[k]);
      row.more_false += now > before ? 1 : 0;
      row.fewer_false += now < before ? 1 : 0;
    }
    for (const PlaceShift& shift : here.shifts) {
      if (shift.centroid_px >= 0.0) {
        centroid.Add(shift.centroid_px);
        corner.Add(shift.corners_px);
      }
      if (shift.pairs == 0) continue;
      centroid_noise.Add(shift.centroid_noise_px);
      corner_noise.Add(shift.corner_noise_px);
      squares += Vec2d(shift.mean_px.data()).squaredNorm();
      // Both pictures of a pair have noise of their own.
      noise_squares += 4.0 * std::pow(shift.centroid_noise_px, 2) / shift.pairs;
      ++freedoms;
    }
  }
  row.false_detections = false_detections.Mean();
  row.false_error = false_detections.Error();
  row.wrong_names = wrong_names.Mean();
  row.centroid_shift_px = centroid.Rms();
  row.corner_shift_px = corner.Rms();
  row.centroid_noise_px = std::max(0.0, centroid_noise.Rms());
  row.corner_noise_px = std::max(0.0, corner_noise.Rms());
  if (freedoms > 0.0) {
    row.noisy_shift_px = std::sqrt(std::max(0.0, squares - noise_squares) / freedoms);
    row.noisy_shift_error_px = std::sqrt(noise_squares) / freedoms;
  }
  return row;
}

HotspotMixRow MixRowOf(const std::vector<HotspotShot>& shots, const HotspotMix& mix) {
  HotspotMixRow row;
  row.mix = mix.name;
  for (const auto level : kLevels) {
    Sample sample;
    for (const HotspotShot& shot : shots) sample.Add(ResultOf(shot, mix.name).levels.*level);
    row.mean.*level = sample.Mean();
    row.error.*level = sample.Error();
  }
  for (const auto& [method, detections] : ResultOf(shots.front(), mix.name).methods)
    row.methods[method] = MethodRow(shots, mix, method);
  return row;
}

std::vector<RingLight> MeanRings(const std::vector<HotspotShot>& shots) {
  std::vector<RingLight> rings = shots.front().rings;
  constexpr double RingLight::*kParts[] = {
      &RingLight::beam_e,  &RingLight::gloss_e,   &RingLight::lobe_e,       &RingLight::sheet_e,
      &RingLight::cover_e, &RingLight::direct_px, &RingLight::direct_peak_e};
  for (size_t r = 0; r < rings.size(); ++r) {
    const auto mean = [&](auto get) {
      double sum = 0.0;
      for (const HotspotShot& shot : shots) sum += get(shot.rings[r]);
      return sum / static_cast<double>(shots.size());
    };
    for (const auto part : kParts)
      rings[r].*part = mean([part](const RingLight& ring) { return ring.*part; });
    rings[r].highlight.peak_e = mean([](const RingLight& ring) { return ring.highlight.peak_e; });
    rings[r].highlight.area_px = mean([](const RingLight& ring) { return ring.highlight.area_px; });
  }
  return rings;
}

}  // namespace

const HotspotMixRow& HotspotRow::Mix(const std::string& name) const {
  const auto found = std::find_if(mixes.begin(), mixes.end(),
                                  [&](const HotspotMixRow& row) { return row.mix == name; });
  RETROLUX_CHECK(found != mixes.end(), "no mix {}", name);
  return *found;
}

double HotspotRow::RenderNoise() const {
  double largest = 0.0;
  for (const HotspotShot& shot : shots) largest = std::max(largest, shot.render_noise);
  return largest;
}

HotspotRow RowOf(double psi_deg, std::vector<HotspotShot> shots,
                 const std::vector<HotspotMix>& mixes) {
  HotspotRow row;
  row.psi_deg = psi_deg;
  row.rings = MeanRings(shots);
  for (const HotspotMix& mix : mixes) row.mixes.push_back(MixRowOf(shots, mix));
  row.shots = std::move(shots);
  return row;
}

}  // namespace retrolux
