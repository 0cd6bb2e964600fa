#include "analysis/marker_study_gain.h"

#include <nlohmann/json.hpp>

namespace retrolux {

namespace {

using Json = nlohmann::json;

// The study as `edges` would have it.
MarkerStudy SeenByEdges(MarkerStudy study) {
  for (PictureResult& r : study.results) {
    if (r.edges_hit) {
      r.outcome = Outcome::kHit;
    } else if (r.outcome == Outcome::kHit) {
      r.outcome = Outcome::kNotDetected;
    }
  }
  return study;
}

}  // namespace

std::optional<MethodGain> GainOverEdges(const MarkerStudy& study, const StudyCoverage& coverage) {
  if (study.options.method == kEdgesMethod) return std::nullopt;
  MethodGain gain;
  for (const PictureResult& r : study.results) {
    const bool hit = r.outcome == Outcome::kHit;
    gain.both += hit && r.edges_hit;
    gain.only_method += hit && !r.edges_hit;
    gain.only_edges += !hit && r.edges_hit;
  }
  const MarkerStudy by_edges = SeenByEdges(study);
  const StudyCoverage edges(by_edges);
  for (const CellSet& set : coverage.Sets()) {
    const CellSet& other = *edges.Set(set.name, set.marker, set.pose);
    SetGain of_set{set, other.percent};
    for (size_t i = 0; i < set.cells.size(); ++i) {
      of_set.won += set.cells[i] > other.cells[i];
      of_set.lost += set.cells[i] < other.cells[i];
    }
    gain.sets.push_back(std::move(of_set));
  }
  return gain;
}

Json ToJson(const MethodGain& gain) {
  Json sets = Json::array();
  for (const SetGain& g : gain.sets) {
    sets.push_back({{"marker", g.set.marker},
                    {"pose", g.set.pose.empty() ? Json(nullptr) : Json(g.set.pose)},
                    {"set", g.set.name},
                    {"edges_area_pct", g.edges_pct},
                    {"area_pct", g.set.percent},
                    {"cells_won", g.won},
                    {"cells_lost", g.lost}});
  }
  return {
      {"pictures",
       {{"both", gain.both}, {"only_method", gain.only_method}, {"only_edges", gain.only_edges}}},
      {"sets", sets}};
}

}  // namespace retrolux
