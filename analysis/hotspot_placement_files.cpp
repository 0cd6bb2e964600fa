#include "analysis/hotspot_placement_files.h"

#include "analysis/hotspot_placement_verdict.h"
#include "core/csv.h"

namespace retrolux {

namespace {

using nlohmann::json;

const std::vector<std::string> kChangeColumns = {"change_sigmas",
                                                 "changed_by",
                                                 "hot_spot",
                                                 "highlight_e",
                                                 "highlight_sigmas",
                                                 "highlight_area_px",
                                                 "highlight_x_mm",
                                                 "highlight_y_mm",
                                                 "highlight_z_mm",
                                                 "tail_e",
                                                 "tail_sigmas",
                                                 "beam_e",
                                                 "beam_sigmas",
                                                 "mask_noise_e",
                                                 "marker_noise_e",
                                                 "exposures",
                                                 "names",
                                                 "names_lost",
                                                 "names_gained",
                                                 "wrong_names",
                                                 "names_lost_edges",
                                                 "names_gained_edges",
                                                 "wrong_names_edges"};

void AddChange(const NeighbourChange& change, std::vector<std::string>& cells) {
  AddNumbers({change.Sigmas()}, cells);
  cells.emplace_back(change.Largest());
  cells.emplace_back(change.IsHotSpot() ? "1" : "0");
  const Highlight& highlight = change.light.highlight;
  AddNumbers({highlight.peak_e, change.highlight.Sigmas(), highlight.area_px}, cells);
  for (const double mm : highlight.at_mm)
    cells.push_back(highlight.peak_e > 0.0 ? CsvNumber(mm) : "");
  AddNumbers({change.tail.change, change.tail.Sigmas(), change.beam.change, change.beam.Sigmas(),
              change.highlight.noise, change.tail.noise},
             cells);
  cells.push_back(std::to_string(change.pictures));
  const HotspotMethodRow &robust = change.methods.at("robust"), &edges = change.methods.at("edges");
  cells.push_back(std::to_string(robust.hits.of));
  for (const HotspotMethodRow* row : {&robust, &edges}) {
    cells.push_back(std::to_string(row->lost));
    cells.push_back(std::to_string(row->gained));
    cells.push_back(CsvNumber(row->wrong_names));
  }
}

void WriteTriples(const HotspotPlacement& placement, const std::filesystem::path& file) {
  std::vector<std::string> columns = {
      "camera",     "ring",          "separation_deg", "rot_x_deg",     "rot_y_deg", "rot_z_deg",
      "forecast_e", "forecast_x_mm", "forecast_y_mm",  "forecast_z_mm", "rendered"};
  columns.insert(columns.end(), kChangeColumns.begin(), kChangeColumns.end());
  CsvWriter table(columns);
  for (const PlacementTriple& triple : placement.triples) {
    const MaskRotation& rotation = placement.options.vault.rotations[triple.rotation];
    std::vector<std::string> cells = {placement.cameras[triple.camera],
                                      placement.cameras[triple.ring]};
    AddNumbers({triple.separation_deg, rotation.x_deg, rotation.y_deg, rotation.z_deg,
                triple.forecast.peak_e},
               cells);
    for (const double mm : triple.forecast.at_mm)
      cells.push_back(triple.forecast.peak_e > 0.0 ? CsvNumber(mm) : "");
    cells.emplace_back(triple.change ? "1" : "0");
    if (triple.change) AddChange(*triple.change, cells);
    cells.resize(columns.size());
    table.Row(cells);
  }
  table.Write(file);
}

json RotationJson(const MaskRotation& rotation) {
  return {rotation.x_deg, rotation.y_deg, rotation.z_deg};
}

void WritePairs(const HotspotPlacement& placement, const std::filesystem::path& file) {
  CsvWriter table({"camera_a", "camera_b", "separation_deg", "below_thesis_limit",
                   "rotations_rendered", "rotations_hot", "highlight_e", "highlight_sigmas",
                   "worst_rot_x_deg", "worst_rot_y_deg", "worst_rot_z_deg", "tail_sigmas",
                   "beam_sigmas", "names", "names_lost", "names_gained", "rotations_forecast",
                   "rotations_forecast_hot", "forecast_e"});
  for (const PlacementPair& pair : PairsOf(placement)) {
    std::vector<std::string> cells = {placement.cameras[pair.a], placement.cameras[pair.b]};
    AddNumbers({pair.separation_deg}, cells);
    cells.emplace_back(pair.separation_deg < kThesisLimit_deg ? "1" : "0");
    for (const int count : {pair.rendered, pair.hot}) cells.push_back(std::to_string(count));
    const MaskRotation& worst = placement.options.vault.rotations[pair.worst->rotation];
    AddNumbers({pair.worst->change->highlight.change, pair.highlight_sigmas, worst.x_deg,
                worst.y_deg, worst.z_deg, pair.tail_sigmas, pair.beam_sigmas},
               cells);
    for (const int64_t count : {pair.names, pair.lost, pair.gained})
      cells.push_back(std::to_string(count));
    cells.push_back(std::to_string(placement.options.vault.rotations.size()));
    cells.push_back(std::to_string(pair.forecast_hot));
    AddNumbers({pair.forecast_peak_e}, cells);
    table.Row(cells);
  }
  table.Write(file);
}

}  // namespace

json PlacementSummary(const HotspotPlacement& placement) {
  const HotspotVault& vault = placement.options.vault;
  json rendered = json::array(), pairs = json::array();
  for (const size_t rotation : placement.rendered)
    rendered.push_back(RotationJson(vault.rotations[rotation]));
  for (const PlacementPair& pair : PairsOf(placement)) {
    pairs.push_back({{"cameras", {placement.cameras[pair.a], placement.cameras[pair.b]}},
                     {"separation_deg", pair.separation_deg},
                     {"rotations_hot", pair.hot},
                     {"rotations_forecast_hot", pair.forecast_hot},
                     {"highlight_e", pair.worst->change->highlight.change},
                     {"highlight_sigmas", pair.highlight_sigmas}});
  }
  return {{"simulation", vault.scenario.name},
          {"placement",
           {{"phi_b_deg", vault.placement.phi_b_deg},
            {"theta1_deg", vault.placement.theta1_deg},
            {"theta2_deg", vault.placement.theta2_deg}}},
          {"mask", vault.mask},
          {"rotations", vault.rotations.size()},
          {"rotations_rendered_deg", rendered},
          {"indirect", placement.options.indirect},
          {"mask_noise_e", placement.mask_noise_e},
          {"own_highlight_e", placement.own_highlight_e},
          {"pairs", pairs},
          {"verdict", VerdictOf(placement)}};
}

void WritePlacementFiles(const HotspotPlacement& placement, const std::filesystem::path& folder) {
  WriteTriples(placement, folder / "placement.csv");
  WritePairs(placement, folder / "placement_pairs.csv");
}

}  // namespace retrolux
