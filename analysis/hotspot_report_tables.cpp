#include "analysis/hotspot_report_tables.h"

#include <cmath>

namespace retrolux {

namespace {

std::string ChangeText(const HotspotChange& change) {
  if (change.p) return fmt::format("{:+.3g} (p = {:.2g})", change.change, *change.p);
  return fmt::format("{:+.3g} ({:.1f} σ)", change.change, change.Sigmas());
}

void AddLimits(const HotspotStudy& study, Report& report) {
  std::vector<std::string> columns = {"series", "rings"};
  for (const HotspotCriterion& criterion : HotspotCriteria()) columns.emplace_back(criterion.name);
  std::vector<std::vector<std::string>> rows;
  for (const HotspotSeries& series : study.series) {
    for (const HotspotMix& mix : study.mixes) {
      if (mix.own == 0.0 || mix.neighbours == 0.0) continue;
      if (series.name != "default" && mix.name != "both") continue;
      std::vector<std::string> cells = {series.name, mix.name};
      for (const HotspotLimit& limit : LimitsOf(series.rows, mix))
        cells.push_back(LimitText(limit, series.rows));
      rows.push_back(std::move(cells));
    }
  }
  std::vector<std::string> strobed = {"any", "strobed in turn"};
  strobed.resize(columns.size(), "unchanged");
  rows.push_back(strobed);
  report.Table(
      "The smallest separation from which on the neighbour changes nothing (3 sigma of one "
      "picture; rates p < 0.0027). Strobed in turn, a camera exposes in its own light only: by "
      "definition nothing changes",
      columns, rows);
}

// At the thesis's limit, or the nearest angle below.
void AddAtTheLimit(const HotspotStudy& study, Report& report) {
  const HotspotSeries& series = study.series.front();
  size_t at = 0;
  for (size_t i = 0; i < series.rows.size(); ++i) {
    if (series.rows[i].psi_deg <= kThesisLimit_deg) at = i;
  }
  std::vector<std::vector<std::string>> rows;
  for (const HotspotLimit& limit : LimitsOf(series.rows, study.Mix("both"))) {
    const HotspotChange& first = limit.changes.front();
    const HotspotChange& here = limit.changes[at];
    const HotspotChange& last = limit.changes.back();
    rows.push_back({limit.criterion->name, limit.criterion->meaning, limit.criterion->unit,
                    ChangeText(first), ChangeText(here), ChangeText(last),
                    LimitText(limit, series.rows)});
  }
  report.Table("Both rings on against the own ring alone",
               {"criterion", "what", "unit", fmt::format("{:g}°", series.rows.front().psi_deg),
                fmt::format("{:g}°", series.rows[at].psi_deg),
                fmt::format("{:g}°", series.rows.back().psi_deg), "nothing changes from"},
               rows);
}

void AddVariations(const HotspotStudy& study, Report& report) {
  if (study.series.size() == 1) return;
  std::vector<std::vector<std::string>> rows;
  for (size_t i = 1; i < study.series.size(); ++i)
    rows.push_back({study.series[i].name, study.series[i].description});
  report.Table("Variations: what is different", {"series", "what"}, rows);
}

// What the limits say of the thesis's one.
void InWords(const HotspotStudy& study, Report& report) {
  const HotspotSeries& series = study.series.front();
  std::string ends, stays, never;
  const auto add = [](std::string& list, const std::string& name) {
    list += (list.empty() ? "" : "; ") + name;
  };
  double last_deg = 0.0;
  for (const HotspotLimit& limit : LimitsOf(series.rows, study.Mix("both"))) {
    const std::string name = limit.criterion->name;
    if (limit.never_changed) {
      add(never, name);
    } else if (limit.limit_deg) {
      add(ends, fmt::format("{} from {:g}° on", name, *limit.limit_deg));
      last_deg = std::max(last_deg, *limit.limit_deg);
    } else {
      add(stays, name);
    }
  }
  const auto or_none = [](const std::string& list) { return list.empty() ? "none" : list; };
  report.Paragraph(fmt::format(
      "**Of what the neighbour changes, this ends with the angle**: {}. **This does not**, up to "
      "{:g}°: {}. **This it never changes**: {}.",
      or_none(ends), series.rows.back().psi_deg, or_none(stays), or_none(never)));
  report.Paragraph(fmt::format(
      "What ends has ended at {:g}°. What has not ended at {:g}° is not avoided by keeping cameras "
      "the thesis's {:g}° apart. All of this holds for a coat of roughness {:g}; the variations "
      "say "
      "how it changes, and no measurement of a real mask's gloss exists.",
      last_deg, series.rows.back().psi_deg, kThesisLimit_deg, series.setup.roughness));
}

// The names of the criteria by which something has changed.
std::string ChangedBy(const HotspotRow& row, const HotspotMix& mix) {
  std::string names;
  for (const HotspotCriterion& criterion : HotspotCriteria()) {
    const HotspotChange change = criterion.measure(row, mix);
    if (!change.Changed()) continue;
    names += fmt::format("{}{} {}", names.empty() ? "" : "; ", criterion.name, ChangeText(change));
  }
  return names.empty() ? "nothing" : names;
}

}  // namespace

void AddHotspotVerdict(const HotspotStudy& study, Report& report) {
  report.Heading("Verdict");
  InWords(study, report);
  AddAtTheLimit(study, report);
  AddLimits(study, report);
  AddVariations(study, report);
}

void AddHotspotRoomTables(const std::vector<HotspotRoomView>& room, const HotspotMix& all,
                          Report& report) {
  std::vector<std::vector<std::string>> rows;
  for (const HotspotRoomView& view : room) {
    for (const RingLight& ring : view.row.rings) {
      rows.push_back({view.camera, ring.name, fmt::format("{:.2f}", ring.separation_deg),
                      fmt::format("{:.0f}", ring.highlight.peak_e),
                      fmt::format("{:.0f}", ring.highlight.area_px),
                      fmt::format("{:.0f}", ring.beam_e), fmt::format("{:.0f}", ring.lobe_e),
                      fmt::format("{:.0f}", ring.sheet_e), fmt::format("{:.0f}", ring.cover_e),
                      fmt::format("{:.0f}", ring.direct_px)});
    }
  }
  report.Table(
      "Light of each ring in each camera's picture (e-; means over markers and over the "
      "mask around them)",
      {"camera", "ring of", "apart (°)", "highlight, peak", "its area (px)", "beam on mask", "lobe",
       "sheeting's body", "its cover", "direct view (px)"},
      rows);
  rows.clear();
  for (const HotspotRoomView& view : room) {
    const HotspotMixRow &own = view.row.Mix("own"), &both = view.row.Mix(all.name);
    const auto hits = [](const HotspotMixRow& row, const char* method) {
      const Proportion& p = row.methods.at(method).hits;
      return fmt::format("{} of {}", p.count, p.of);
    };
    rows.push_back(
        {view.camera, fmt::format("{:.0f}", own.mean.background_e),
         fmt::format("{:.0f}", both.mean.background_e), fmt::format("{:.1f}", own.mean.contrast),
         fmt::format("{:.1f}", both.mean.contrast), hits(own, "edges"), hits(both, "edges"),
         hits(own, "robust"), hits(both, "robust"), ChangedBy(view.row, all)});
  }
  report.Table(
      "Own ring alone against all rings; what they change by more than three times the "
      "noise",
      {"camera", "mask, own (e-)", "mask, all", "contrast, own", "contrast, all",
       "named by edges, own", "all", "by robust, own", "all", "changed"},
      rows);
}

}  // namespace retrolux
