#include "analysis/hotspot_placement_report.h"

#include <algorithm>

#include "analysis/hotspot_picture.h"
#include "analysis/hotspot_placement_plots.h"
#include "analysis/hotspot_placement_verdict.h"
#include "analysis/hotspot_report_tables.h"
#include "analysis/vault_text.h"
#include "core/atomic_file.h"

namespace retrolux {

namespace {

constexpr size_t kPictures = 6;  // of the worst views
constexpr size_t kRows = 40;     // of the table of triples

std::string Amount(const HotspotChange& change) {
  return fmt::format("{:.0f} ({:.1f} σ)", change.change, change.Sigmas());
}

std::string Names(const HotspotMethodRow& row) {
  return fmt::format("−{} +{} of {}", row.lost, row.gained, row.hits.of);
}

std::vector<std::string> RowOf(const HotspotPlacement& placement, const PlacementTriple& triple) {
  const NeighbourChange& change = *triple.change;
  return {placement.cameras[triple.camera],
          placement.cameras[triple.ring],
          fmt::format("{:.1f}", triple.separation_deg),
          TextOf(placement.options.vault.rotations[triple.rotation]),
          change.Largest(),
          Amount(change.highlight),
          fmt::format("{:.0f}", triple.forecast.peak_e),
          Amount(change.tail),
          Amount(change.beam),
          Names(change.methods.at("robust")),
          Names(change.methods.at("edges"))};
}

const std::vector<std::string> kTripleColumns = {"camera",
                                                 "ring of",
                                                 "apart (°)",
                                                 "rotation",
                                                 "largest",
                                                 "highlight, peak (e-)",
                                                 "forecast",
                                                 "tail on markers (e-)",
                                                 "beam on mask (e-)",
                                                 "names by robust",
                                                 "by edges"};

void AddWorst(const HotspotPlacement& placement, Report& report) {
  std::vector<std::vector<std::string>> rows;
  for (const PlacementTriple& triple : placement.triples) {
    if (!triple.change || rows.size() == kRows) break;
    rows.push_back(RowOf(placement, triple));
  }
  report.Table(
      fmt::format("Worst first: the {} pictures that a neighbour's ring changes most, by the "
                  "largest of three changes in units of a pixel's noise (σ); lost (−) and gained "
                  "(+) names of markers x exposures",
                  rows.size()),
      kTripleColumns, rows);
}

// Of each kind of change the worst picture.
void AddWorstOfEach(const HotspotPlacement& placement, Report& report) {
  std::vector<std::vector<std::string>> rows;
  const auto add = [&](const std::string& kind, auto figure) {
    const PlacementTriple* worst = nullptr;
    for (const PlacementTriple& triple : placement.triples) {
      if (triple.change && (!worst || figure(*triple.change) > figure(*worst->change)))
        worst = &triple;
    }
    if (!worst) return;
    std::vector<std::string> row = RowOf(placement, *worst);
    row.insert(row.begin(), kind);
    rows.push_back(std::move(row));
  };
  add("highlight", [](const NeighbourChange& change) { return change.highlight.Sigmas(); });
  add("retro tail", [](const NeighbourChange& change) { return change.tail.Sigmas(); });
  add("beam", [](const NeighbourChange& change) { return change.beam.Sigmas(); });
  for (const std::string method : {"robust", "edges"}) {
    add("names lost by " + method, [&](const NeighbourChange& change) {
      const HotspotMethodRow& row = change.methods.at(method);
      return static_cast<double>(row.lost - row.gained);
    });
  }
  std::vector<std::string> columns = kTripleColumns;
  columns.insert(columns.begin(), "worst by");
  report.Table("The worst picture of each kind", columns, rows);
}

void AddPairs(const HotspotPlacement& placement, Report& report) {
  std::vector<std::vector<std::string>> rows;
  for (const PlacementPair& pair : PairsOf(placement)) {
    rows.push_back(
        {placement.cameras[pair.a] + " – " + placement.cameras[pair.b],
         fmt::format("{:.1f}", pair.separation_deg),
         fmt::format("{} of {}", pair.hot, pair.rendered),
         fmt::format("{} of {}", pair.forecast_hot, placement.options.vault.rotations.size()),
         Amount(pair.worst->change->highlight),
         TextOf(placement.options.vault.rotations[pair.worst->rotation]),
         fmt::format("{:.1f}", pair.tail_sigmas), fmt::format("{:.1f}", pair.beam_sigmas),
         fmt::format("−{} +{} of {}", pair.lost, pair.gained, pair.names)});
  }
  report.Table(
      "Pairs of cameras, each in the other's light, the brightest highlight first. Rotations with "
      "hot spots: of those rendered, and by the forecast of all",
      {"pair", "apart (°)", "rotations with hot spots", "by forecast", "highlight, peak (e-)",
       "at rotation", "tail (σ)", "beam (σ)", "names by robust"},
      rows);
}

void AddClasses(const HotspotPlacement& placement, Report& report) {
  std::vector<std::vector<std::string>> rows;
  for (const SeparationClass& one : ClassesOf(placement)) {
    if (one.pairs == 0) continue;
    rows.push_back({fmt::format("{:g}° to {:g}°", one.from_deg, one.to_deg),
                    std::to_string(one.pairs), std::to_string(one.triples), std::to_string(one.hot),
                    fmt::format("{:.0f}", one.median_e), fmt::format("{:.0f}", one.peak_e),
                    fmt::format("{:.1f}", one.tail_sigmas),
                    fmt::format("−{} +{} of {}", one.lost, one.gained, one.names)});
  }
  report.Table("Are near pairs worse? Rendered pictures by the separation of the pair",
               {"apart", "pairs", "pictures x rings", "with a hot spot", "highlight, median (e-)",
                "highlight, brightest (e-)", "tail, largest (σ)", "names by robust"},
               rows);
}

void AddPictures(const HotspotPlacement& placement, const std::filesystem::path& folder,
                 Report& report) {
  std::vector<LabelledPicture> grid;
  size_t shown = 0;
  for (const PlacementTriple& triple : placement.triples) {
    if (triple.pictures.empty() || shown == kPictures) continue;
    ++shown;
    for (const HotspotPicture& picture : triple.pictures)
      grid.push_back(
          {TextOf(placement, triple) + ": " + picture.kind, ReadTextFile(folder / picture.file)});
  }
  if (grid.empty()) return;
  report.PictureGrid(
      "The worst pictures: in the light of the own ring and of both (as recorded, gamma 2.2), and "
      "the neighbour's light in false colours (e-)",
      grid, 3, NeighboursScale());
}

void AddFigures(const HotspotPlacement& placement, Report& report) {
  const std::vector<PlacementPair> pairs = PairsOf(placement);
  const auto hot = std::count_if(pairs.begin(), pairs.end(),
                                 [](const PlacementPair& pair) { return pair.hot > 0; });
  const PlacementPair& first = pairs.front();
  report.KeyFigures({{"Pairs with hot spots", std::to_string(hot),
                      fmt::format("of {}", pairs.size()), "above three times the noise"},
                     {"Brightest highlight of a neighbour",
                      fmt::format("{:.0f}", first.worst->change->highlight.change), "e-",
                      fmt::format("{} and {}, {:.1f}° apart", placement.cameras[first.a],
                                  placement.cameras[first.b], first.separation_deg)},
                     {"Rotations rendered", std::to_string(placement.rendered.size()),
                      fmt::format("of {}", placement.options.vault.rotations.size()),
                      "of all there is a forecast"}});
}

}  // namespace

void AddHotspotPlacement(const HotspotPlacement& placement, const std::filesystem::path& folder,
                         Report& report) {
  const HotspotVault& vault = placement.options.vault;
  report.Heading(fmt::format("A vault placement: simulation {}, {}, {} mask", vault.scenario.name,
                             TextOf(vault.placement), vault.mask));
  AddFigures(placement, report);
  for (const std::string& sentence : VerdictOf(placement)) report.Paragraph(sentence);
  AddPictures(placement, folder, report);
  AddPlacementPlots(placement, report);
  AddPairs(placement, report);
  AddClasses(placement, report);
  AddWorst(placement, report);
  AddWorstOfEach(placement, report);
  AddHotspotRoomTables(placement.views, placement.all, report);
  report.Paragraph(fmt::format(
      "The paths' scatter on the mask is at most {:.0f} % of the sensor's noise of one picture. "
      "placement.csv has every camera, ring and rotation, placement_pairs.csv every pair.",
      100.0 * placement.render_noise));
}

}  // namespace retrolux
