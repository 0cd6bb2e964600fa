#include "analysis/marker_study_gain.h"
#include "analysis/marker_study_sections.h"

namespace retrolux {

void AddGain(const MarkerStudy& study, const StudyCoverage& coverage, Report& report) {
  const std::optional<MethodGain> gain = GainOverEdges(study, coverage);
  if (!gain) return;
  report.Heading(fmt::format("What {} gains over edges", study.options.method));
  report.Paragraph(fmt::format(
      "Both methods saw the same pictures. {} named the marker in **{}** of them, edges in "
      "**{}**; only edges in {}.",
      study.options.method, gain->both + gain->only_method, gain->both + gain->only_edges,
      gain->only_edges));
  std::vector<std::vector<std::string>> rows;
  for (const SetGain& g : gain->sets) {
    if (study.poses.size() > 3 && !g.set.pose.empty()) continue;
    rows.push_back({std::to_string(g.set.marker), g.set.pose, g.set.name,
                    fmt::format("{:.1f}", g.edges_pct), fmt::format("{:.1f}", g.set.percent),
                    fmt::format("{:+.1f}", g.set.percent - g.edges_pct), std::to_string(g.won),
                    std::to_string(g.lost)});
  }
  report.Table("Usable area of the face half, %, and cells of one half won and lost",
               {"marker", "pose", "set", "edges / %", study.options.method + " / %", "gain / %",
                "cells won", "cells lost"},
               rows);
}

}  // namespace retrolux
