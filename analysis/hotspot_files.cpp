#include <fmt/format.h>

#include "analysis/hotspot_placement_files.h"
#include "analysis/hotspot_study.h"
#include "core/atomic_file.h"
#include "core/csv.h"

namespace retrolux {

namespace {

using nlohmann::json;

// What has not been found has no place.
std::string Place(double px) {
  return px < 0.0 ? "" : CsvNumber(px);
}

const std::vector<std::string> kLevelColumns = {"peak_e",
                                                "saturated_px",
                                                "background_e",
                                                "marker_contrast",
                                                "false_detections",
                                                "hit_rate",
                                                "centroid_shift_px",
                                                "peak_error_e",
                                                "saturated_mask_px",
                                                "background_error_e",
                                                "gradient_e_px",
                                                "gradient_error_e_px",
                                                "marker_e",
                                                "marker_error_e",
                                                "contrast_error",
                                                "background_noise_e",
                                                "marker_noise_e",
                                                "hit_rate_low",
                                                "hit_rate_high",
                                                "hit_rate_edges",
                                                "hit_rate_edges_low",
                                                "hit_rate_edges_high",
                                                "false_detections_error",
                                                "false_detections_edges",
                                                "false_detections_edges_error",
                                                "wrong_names",
                                                "wrong_names_edges",
                                                "corner_shift_px",
                                                "centroid_noise_px",
                                                "corner_noise_px",
                                                "noisy_centroid_shift_px",
                                                "noisy_centroid_shift_error_px",
                                                "centroid_shift_edges_px",
                                                "corner_shift_edges_px",
                                                "centroid_noise_edges_px",
                                                "corner_noise_edges_px"};

void AddRate(const Proportion& rate, std::vector<std::string>& cells) {
  cells.push_back(CsvNumber(rate.Wilson().low));
  cells.push_back(CsvNumber(rate.Wilson().high));
}

std::string Rate(const Proportion& rate) {
  const std::optional<double> value = rate.Value();
  return value ? CsvNumber(*value) : "";
}

// First the columns that others read (the contract of the command), then more.
void AddMix(const HotspotMixRow& row, std::vector<std::string>& cells) {
  const HotspotLevels &mean = row.mean, &error = row.error;
  const HotspotMethodRow &robust = row.methods.at("robust"), &edges = row.methods.at("edges");
  AddNumbers(
      {mean.peak_e, mean.saturated_px, mean.background_e, mean.contrast, robust.false_detections},
      cells);
  cells.push_back(Rate(robust.hits));
  cells.push_back(Place(robust.centroid_shift_px));
  AddNumbers({error.peak_e, mean.saturated_mask_px, error.background_e, mean.gradient_e_px,
              error.gradient_e_px, mean.marker_e, error.marker_e, error.contrast,
              mean.background_noise_e, mean.marker_noise_e},
             cells);
  AddRate(robust.hits, cells);
  cells.push_back(Rate(edges.hits));
  AddRate(edges.hits, cells);
  AddNumbers({robust.false_error, edges.false_detections, edges.false_error, robust.wrong_names,
              edges.wrong_names},
             cells);
  cells.push_back(Place(robust.corner_shift_px));
  AddNumbers({robust.centroid_noise_px, robust.corner_noise_px}, cells);
  cells.push_back(Place(robust.noisy_shift_px));
  cells.push_back(CsvNumber(robust.noisy_shift_error_px));
  cells.push_back(Place(edges.centroid_shift_px));
  cells.push_back(Place(edges.corner_shift_px));
  AddNumbers({edges.centroid_noise_px, edges.corner_noise_px}, cells);
}

std::vector<std::string> Columns(std::vector<std::string> first,
                                 const std::vector<std::string>& rest) {
  first.insert(first.end(), rest.begin(), rest.end());
  return first;
}

void AddSeries(const HotspotSeries& series, const std::vector<std::string>& first,
               CsvWriter& table) {
  for (const HotspotRow& row : series.rows) {
    for (const HotspotMixRow& mix : row.mixes) {
      std::vector<std::string> cells = first;
      cells.insert(cells.end(), {fmt::format("{:g}", row.psi_deg), mix.mix});
      AddMix(mix, cells);
      table.Row(cells);
    }
  }
}

void WriteSeries(const std::vector<HotspotSeries>& series, const std::filesystem::path& folder) {
  CsvWriter table(Columns({"psi_deg", "rings"}, kLevelColumns));
  AddSeries(series.front(), {}, table);
  table.Write(folder / "hotspot.csv");
  if (series.size() == 1) return;
  CsvWriter variations(Columns({"series", "psi_deg", "rings"}, kLevelColumns));
  for (size_t i = 1; i < series.size(); ++i) AddSeries(series[i], {series[i].name}, variations);
  variations.Write(folder / "variations.csv");
}

void WriteRoom(const std::vector<HotspotRoomView>& room, const std::filesystem::path& file) {
  CsvWriter table(Columns({"camera", "rings"}, kLevelColumns));
  for (const HotspotRoomView& view : room) {
    for (const HotspotMixRow& mix : view.row.mixes) {
      std::vector<std::string> cells = {view.camera, mix.mix};
      AddMix(mix, cells);
      table.Row(cells);
    }
  }
  table.Write(file);
}

void AddRings(const std::string& name, double psi_deg, const HotspotRow& row, CsvWriter& table) {
  for (const RingLight& ring : row.rings) {
    std::vector<std::string> cells = {name, fmt::format("{:g}", psi_deg), ring.name};
    AddNumbers(
        {ring.separation_deg, ring.beam_e, ring.gloss_e, ring.lobe_e, ring.sheet_e, ring.cover_e,
         ring.direct_px, ring.direct_peak_e, ring.highlight.peak_e, ring.highlight.area_px},
        cells);
    const bool seen = ring.highlight.peak_e > 0.0;
    for (const double v : ring.highlight.at_px) cells.push_back(seen ? CsvNumber(v) : "");
    for (const double v : ring.highlight.at_mm) cells.push_back(seen ? CsvNumber(v) : "");
    const HighlightDepths& depths = row.shots.front().depths;
    for (const double v : {depths.apart_mm, depths.cross_mm, depths.own_mm})
      cells.push_back(depths.known ? CsvNumber(v) : "");
    table.Row(cells);
  }
}

void WriteRings(const HotspotStudy& study, const std::filesystem::path& file) {
  CsvWriter table({"view",
                   "psi_deg",
                   "ring",
                   "separation_deg",
                   "beam_e",
                   "gloss_e",
                   "lobe_e",
                   "sheet_e",
                   "cover_e",
                   "direct_px",
                   "direct_peak_e",
                   "highlight_peak_e",
                   "highlight_area_px",
                   "highlight_u_px",
                   "highlight_v_px",
                   "highlight_x_mm",
                   "highlight_y_mm",
                   "highlight_z_mm",
                   "highlights_apart_mm",
                   "cross_depth_mm",
                   "own_depth_mm"});
  for (const HotspotRoomView& view : study.room) AddRings(view.camera, 0.0, view.row, table);
  for (const HotspotSeries& series : study.series) {
    for (const HotspotRow& row : series.rows) AddRings(series.name, row.psi_deg, row, table);
  }
  table.Write(file);
}

void WriteVerdict(const HotspotStudy& study, const std::filesystem::path& file) {
  CsvWriter table({"series", "rings", "criterion", "unit", "psi_deg", "change", "noise", "sigmas",
                   "p", "changed"});
  for (const HotspotSeries& series : study.series) {
    for (const HotspotMix& mix : study.mixes) {
      if (mix.own == 0.0 || mix.neighbours == 0.0) continue;
      for (const HotspotLimit& limit : LimitsOf(series.rows, mix)) {
        for (size_t i = 0; i < limit.changes.size(); ++i) {
          const HotspotChange& change = limit.changes[i];
          table.Row({series.name, mix.name, limit.criterion->name, limit.criterion->unit,
                     fmt::format("{:g}", series.rows[i].psi_deg), CsvNumber(change.change),
                     change.p ? "" : CsvNumber(change.noise),
                     change.p ? "" : CsvNumber(change.Sigmas()),
                     change.p ? CsvNumber(*change.p) : "", change.Changed() ? "1" : "0"});
        }
      }
    }
  }
  table.Write(file);
}

}  // namespace

json HotspotSummary(const HotspotStudy& study) {
  json limits = json::array();
  for (const HotspotSeries& series : study.series) {
    for (const HotspotMix& mix : study.mixes) {
      if (mix.own == 0.0 || mix.neighbours == 0.0 || series.rows.empty()) continue;
      for (const HotspotLimit& limit : LimitsOf(series.rows, mix)) {
        limits.push_back({{"series", series.name},
                          {"rings", mix.name},
                          {"criterion", limit.criterion->name},
                          {"limit_deg", limit.limit_deg ? json(*limit.limit_deg) : json(nullptr)},
                          {"never_changed", limit.never_changed}});
      }
    }
  }
  const HotspotStudyOptions& options = study.options;
  json summary = {{"schema", "retrolux/hotspot-study-1"},
                  {"version", RETROLUX_VERSION},
                  {"units", "e-, px, mm, deg"},
                  {"pixel_origin", "center"},
                  {"seed", options.shot.seed},
                  {"noise_seed", options.shot.noise_seed},
                  {"spp", options.shot.samples.mask},
                  {"exposures", options.shot.exposures},
                  {"placements", options.placements},
                  {"setup", options.setup.ToJson()},
                  {"angles_deg", options.angles_deg},
                  {"thesis_limit_deg", kThesisLimit_deg},
                  {"limits", limits}};
  if (study.placement) summary["placement"] = PlacementSummary(*study.placement);
  return summary;
}

void WriteHotspotStudyFiles(const HotspotStudy& study, const std::filesystem::path& folder) {
  const bool angles = !study.series.front().rows.empty();
  if (angles) {
    WriteSeries(study.series, folder);
    WriteVerdict(study, folder / "verdict.csv");
  }
  if (angles || !study.room.empty()) WriteRings(study, folder / "rings.csv");
  if (!study.room.empty()) WriteRoom(study.room, folder / "room.csv");
  if (study.placement) WritePlacementFiles(*study.placement, folder);
  WriteTextFile(folder / "summary.json", HotspotSummary(study).dump(2) + "\n");
}

}  // namespace retrolux
