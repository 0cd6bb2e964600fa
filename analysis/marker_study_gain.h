// What the method of a marker study gains over `edges`, on the same pictures.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "analysis/marker_coverage.h"

namespace retrolux {

// One set of cells (StudyCoverage) as both methods have it.
struct SetGain {
  CellSet set;             // of the study's method
  double edges_pct = 0.0;  // of the face half
  int won = 0, lost = 0;   // cells of the half that only the method has, that only `edges` has
};

struct MethodGain {
  // Pictures that name the marker.
  int64_t both = 0, only_method = 0, only_edges = 0;
  std::vector<SetGain> sets;  // in the order of StudyCoverage::Sets
};

// Nothing for a study whose method is `edges`.
std::optional<MethodGain> GainOverEdges(const MarkerStudy& study, const StudyCoverage& coverage);

// As in summary.json.
nlohmann::json ToJson(const MethodGain& gain);

}  // namespace retrolux
