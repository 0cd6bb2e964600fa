#include "analysis/hotspot_placement_verdict.h"

#include <algorithm>
#include <map>
#include <set>

#include "analysis/vault_text.h"

namespace retrolux {

namespace {

constexpr double kClasses_deg[] = {0, kThesisLimit_deg, 30, 60, 90, 120, 180};

double Threshold_e(const HotspotPlacement& placement) {
  return kHotspotSigmas * placement.mask_noise_e;
}

// Adds what robust makes of a neighbour.
template <typename Counts>
void AddNames(const NeighbourChange& change, Counts& counts) {
  const HotspotMethodRow& robust = change.methods.at("robust");
  counts.names += robust.hits.of;
  counts.lost += robust.lost;
  counts.gained += robust.gained;
}

// What of a pair counts rotations: those of either picture.
struct PairRotations {
  std::set<size_t> rendered, hot, forecast_hot;
};

void Add(const HotspotPlacement& placement, const PlacementTriple& triple, PlacementPair& pair,
         PairRotations& rotations) {
  pair.forecast_peak_e = std::max(pair.forecast_peak_e, triple.forecast.peak_e);
  if (placement.mask_noise_e > 0.0 && triple.forecast.peak_e > Threshold_e(placement))
    rotations.forecast_hot.insert(triple.rotation);
  if (!triple.change) return;
  rotations.rendered.insert(triple.rotation);
  if (triple.change->IsHotSpot()) rotations.hot.insert(triple.rotation);
  if (!pair.worst || triple.change->highlight.change > pair.worst->change->highlight.change)
    pair.worst = &triple;
  pair.highlight_sigmas = std::max(pair.highlight_sigmas, triple.change->highlight.Sigmas());
  pair.tail_sigmas = std::max(pair.tail_sigmas, triple.change->tail.Sigmas());
  pair.beam_sigmas = std::max(pair.beam_sigmas, triple.change->beam.Sigmas());
  AddNames(*triple.change, pair);
}

double Share(int64_t part, int64_t of) {
  return of > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(of) : 0.0;
}

std::string PairsInWords(const HotspotPlacement& placement) {
  const std::vector<PlacementPair> pairs = PairsOf(placement);
  const auto hot = std::count_if(pairs.begin(), pairs.end(),
                                 [](const PlacementPair& pair) { return pair.hot > 0; });
  const auto forecast_hot = std::count_if(
      pairs.begin(), pairs.end(), [](const PlacementPair& pair) { return pair.forecast_hot > 0; });
  std::string text = fmt::format(
      "**{} of {} pairs of cameras have hot spots** in what was rendered, a highlight of more than "
      "{:g} times the noise of a pixel of the mask ({:.0f} e-); by the forecast {} have some at "
      "one "
      "rotation at least",
      hot, pairs.size(), kHotspotSigmas, placement.mask_noise_e, forecast_hot);
  const PlacementPair& first = pairs.front();
  if (hot == 0) return text + ".";
  const auto brighter = std::count_if(pairs.begin(), pairs.end(), [&](const PlacementPair& pair) {
    return pair.worst->change->highlight.change > 2.0 * placement.own_highlight_e;
  });
  return text +
         fmt::format(
             ". The own ring's highlight, which is there with one camera already, has {:.0f} e-; "
             "{} "
             "pairs have one of more than twice that. The brightest is {}, {:.1f}° apart: {:.0f} "
             "e-, {:.1f} times the noise.",
             placement.own_highlight_e, brighter, TextOf(placement, *first.worst),
             first.separation_deg, first.worst->change->highlight.change, first.highlight_sigmas);
}

std::string LimitInWords(const HotspotPlacement& placement) {
  const std::vector<SeparationClass> classes = ClassesOf(placement);
  const SeparationClass& below = classes.front();
  if (below.pairs == 0) {
    const std::vector<PlacementPair> pairs = PairsOf(placement);
    const auto nearest = std::min_element(pairs.begin(), pairs.end(),
                                          [](const PlacementPair& a, const PlacementPair& b) {
                                            return a.separation_deg < b.separation_deg;
                                          });
    return fmt::format(
        "**No pair is closer than the thesis's limit of {:g}°** (the nearest, {} and {}, are "
        "{:.1f}° "
        "apart), so that the limit forbids none of these hot spots.",
        kThesisLimit_deg, placement.cameras[nearest->a], placement.cameras[nearest->b],
        nearest->separation_deg);
  }
  SeparationClass above;
  double brightest_e = 0.0;
  for (const SeparationClass& other : classes) {
    if (&other == &below) continue;
    above.triples += other.triples;
    above.hot += other.hot;
    above.names += other.names;
    above.lost += other.lost;
    brightest_e = std::max(brightest_e, other.peak_e);
  }
  const bool worse = below.peak_e > brightest_e;
  return fmt::format(
      "**The {} pairs closer than the thesis's limit of {:g}° are {} than the others**: highlights "
      "up to {:.0f} e- against {:.0f}, hot spots in {:.0f} % of their pictures against {:.0f} %, "
      "names lost by `robust` {:.1f} % against {:.1f} %; their retro-reflective tail on markers is "
      "{:.1f} times the noise at most.",
      below.pairs, kThesisLimit_deg, worse ? "worse" : "no worse", below.peak_e, brightest_e,
      Share(below.hot, below.triples), Share(above.hot, above.triples),
      Share(below.lost, below.names), Share(above.lost, above.names), below.tail_sigmas);
}

std::string NamesInWords(const HotspotPlacement& placement) {
  int64_t names = 0, lost = 0, gained = 0, all = 0, all_lost = 0, all_gained = 0;
  for (const PlacementPair& pair : PairsOf(placement)) {
    names += pair.names;
    lost += pair.lost;
    gained += pair.gained;
  }
  for (const HotspotRoomView& view : placement.views) {
    const HotspotMethodRow& robust = view.row.Mix(placement.all.name).methods.at("robust");
    all += robust.hits.of;
    all_lost += robust.lost;
    all_gained += robust.gained;
  }
  return fmt::format(
      "One neighbour's ring beside the own one costs `robust` {:.1f} % of the markers that are "
      "wholly seen (and gains {:.1f} %); all rings at once {:.1f} % (and {:.1f} %).",
      Share(lost, names), Share(gained, names), Share(all_lost, all), Share(all_gained, all));
}

std::string CoverageInWords(const HotspotPlacement& placement) {
  int hot = 0;
  for (const PlacementTriple& triple : placement.triples) {
    if (!triple.change && triple.forecast.peak_e > Threshold_e(placement)) ++hot;
  }
  const size_t rotations = placement.options.vault.rotations.size();
  std::string text = fmt::format("**Rendered: {} of {} rotations**, with all {} cameras. ",
                                 placement.rendered.size(), rotations, placement.cameras.size());
  if (placement.rendered.size() < rotations) {
    text += fmt::format(
        "They are those in which pairs have their worst forecast. Of the other {} there is the "
        "forecast of highlights only; it has {} more (camera, ring, rotation) above the "
        "threshold. ",
        rotations - placement.rendered.size(), hot);
  }
  const ForecastQuality quality = QualityOf(placement);
  if (quality.triples == 0) return text;
  return text + fmt::format(
                    "Where both are known, of {} highlights the render's peak is {:.2f} times the "
                    "forecast (nine of ten: {:.2f} to {:.2f}).",
                    quality.triples, quality.median, quality.low, quality.high);
}

}  // namespace

std::vector<PlacementPair> PairsOf(const HotspotPlacement& placement) {
  std::map<std::pair<size_t, size_t>, std::pair<PlacementPair, PairRotations>> by_cameras;
  for (const PlacementTriple& triple : placement.triples) {
    const auto [a, b] = std::minmax(triple.camera, triple.ring);
    auto& [pair, rotations] = by_cameras[{a, b}];
    pair.a = a;
    pair.b = b;
    pair.separation_deg = triple.separation_deg;
    Add(placement, triple, pair, rotations);
  }
  std::vector<PlacementPair> pairs;
  for (auto& [cameras, counted] : by_cameras) {
    auto& [pair, rotations] = counted;
    pair.rendered = static_cast<int>(rotations.rendered.size());
    pair.hot = static_cast<int>(rotations.hot.size());
    pair.forecast_hot = static_cast<int>(rotations.forecast_hot.size());
    pairs.push_back(pair);
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const PlacementPair& a, const PlacementPair& b) {
    return std::make_pair(a.highlight_sigmas, a.forecast_peak_e) >
           std::make_pair(b.highlight_sigmas, b.forecast_peak_e);
  });
  return pairs;
}

std::vector<SeparationClass> ClassesOf(const HotspotPlacement& placement) {
  const std::vector<PlacementPair> pairs = PairsOf(placement);
  std::vector<SeparationClass> classes;
  for (size_t i = 0; i + 1 < std::size(kClasses_deg); ++i) {
    SeparationClass one{kClasses_deg[i], kClasses_deg[i + 1]};
    const auto holds = [&](double deg) {
      return deg >= one.from_deg && (deg < one.to_deg || one.to_deg == 180.0);
    };
    for (const PlacementPair& pair : pairs) one.pairs += holds(pair.separation_deg) ? 1 : 0;
    std::vector<double> peaks;
    for (const PlacementTriple& triple : placement.triples) {
      if (!triple.change || !holds(triple.separation_deg)) continue;
      ++one.triples;
      one.hot += triple.change->IsHotSpot() ? 1 : 0;
      one.tail_sigmas = std::max(one.tail_sigmas, triple.change->tail.Sigmas());
      peaks.push_back(triple.change->highlight.change);
      AddNames(*triple.change, one);
    }
    std::sort(peaks.begin(), peaks.end());
    if (!peaks.empty()) {
      one.median_e = peaks[peaks.size() / 2];
      one.peak_e = peaks.back();
    }
    classes.push_back(one);
  }
  return classes;
}

ForecastQuality QualityOf(const HotspotPlacement& placement) {
  std::vector<double> quotients;
  for (const PlacementTriple& triple : placement.triples) {
    if (triple.change && triple.forecast.peak_e > Threshold_e(placement))
      quotients.push_back(triple.change->highlight.change / triple.forecast.peak_e);
  }
  if (quotients.empty()) return {};
  std::sort(quotients.begin(), quotients.end());
  const size_t last = quotients.size() - 1;
  return {static_cast<int>(quotients.size()), quotients[last / 20], quotients[last / 2],
          quotients[last - last / 20]};
}

std::vector<std::string> VerdictOf(const HotspotPlacement& placement) {
  return {PairsInWords(placement), LimitInWords(placement), NamesInWords(placement),
          CoverageInWords(placement)};
}

std::string TextOf(const HotspotPlacement& placement, const PlacementTriple& triple) {
  return fmt::format("{} lit by {}, {}", placement.cameras[triple.camera],
                     placement.cameras[triple.ring],
                     TextOf(placement.options.vault.rotations[triple.rotation]));
}

}  // namespace retrolux
