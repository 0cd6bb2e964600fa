#include <algorithm>
#include <map>
#include <numeric>

#include "analysis/report.h"
#include "analysis/vault_plots.h"
#include "analysis/vault_reading.h"
#include "analysis/vault_report.h"
#include "analysis/vault_table.h"
#include "analysis/vault_text.h"

namespace retrolux {

namespace {

// Rooms with two beams first, as the thesis's table.
using Rooms = std::map<size_t, std::vector<const VaultStudy*>, std::greater<>>;

Rooms ByBeams(const std::vector<VaultStudy>& studies) {
  Rooms rooms;
  for (const VaultStudy& study : studies) rooms[study.scenario.beams.size()].push_back(&study);
  return rooms;
}

std::string NameOfBeams(size_t beams) {
  return beams == 0   ? "No beam"
         : beams == 1 ? "One beam"
         : beams == 2 ? "Two beams"
                      : fmt::format("{} beams", beams);
}

std::vector<std::string> Separator(const std::string& name) {
  std::vector<std::string> row(SolutionColumns().size());
  row.front() = name;
  return row;
}

// The best search with each number of beams.
void AddKeyFigures(const Rooms& rooms, Report& report) {
  std::vector<KeyFigure> figures;
  for (const auto& [beams, studies] : rooms) {
    const auto best = std::max_element(studies.begin(), studies.end(),
                                       [](const VaultStudy* a, const VaultStudy* b) {
                                         return a->best.result.Cost() < b->best.result.Cost();
                                       });
    figures.push_back({fmt::format("{}, best room", NameOfBeams(beams)), (*best)->scenario.name, "",
                       (*best)->scenario.description});
    figures.push_back({"its cost", fmt::format("{:.3f}", (*best)->best.result.Cost()), "dm²",
                       TextOf((*best)->best.result.Where())});
  }
  report.KeyFigures(figures);
}

void AddTable(const Rooms& rooms, Report& report) {
  report.Heading("All solutions");
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> printed;
  std::string note = kSolutionNote;
  for (const auto& [beams, studies] : rooms) {
    rows.push_back(Separator(NameOfBeams(beams)));
    for (const VaultStudy* study : studies) {
      if (!study->options.placement) note += SolutionRemarks(*study);
      for (auto& row : SolutionRows(*study, printed)) rows.push_back(std::move(row));
    }
  }
  report.Table(
      "Table 4.9 of the thesis: each solution as printed, the same placement with our "
      "program, and the optimum of ours in that room",
      SolutionColumns(), rows);
  report.Paragraph(note);
}

void AddBars(const Rooms& rooms, Report& report) {
  nlohmann::json names = nlohmann::json::array(), ours = names, there = names, printed = names;
  for (const auto& [beams, studies] : rooms) {
    for (const VaultStudy* study : studies) {
      if (study->options.placement) continue;
      names.push_back(study->scenario.name);
      ours.push_back(study->best.result.Cost());
      const bool has = !study->thesis.empty();
      there.push_back(has ? nlohmann::json(study->thesis.front().result.Cost()) : nullptr);
      printed.push_back(has ? nlohmann::json(study->scenario.thesis.front().cost) : nullptr);
    }
  }
  if (names.size() < 2) return;
  const auto bars = [&](const char* name, const nlohmann::json& y, const char* colour) {
    return nlohmann::json{
        {"type", "bar"}, {"name", name}, {"x", names}, {"y", y}, {"marker", {{"color", colour}}}};
  };
  report.Plot(
      "Cost of each room's best placement: as the thesis prints it, that placement with our "
      "program, and our optimum",
      {bars("the thesis prints", printed, plot_colour::kGrey),
       bars("its placement here", there, plot_colour::kSky),
       bars("our optimum", ours, plot_colour::kBlue)},
      {{"barmode", "group"},
       {"xaxis", {{"type", "category"}, {"title", {{"text", "simulation"}}}}},
       {"yaxis", AxisTitle("cost (dm²)")}},
      380);
}

// Of the mask that decides.
std::vector<double> DecidingCosts(const VaultStudy& study, const NamedResult& named) {
  const size_t mask = study.best.result.WorstMask();
  if (mask >= named.orientations.size()) return {};
  return CostsOf(named.orientations[mask]);
}

void AddCurves(const Rooms& rooms, Report& report) {
  report.Heading("Cost of all orientations");
  const char* colours[] = {plot_colour::kBlue,   plot_colour::kVermillion, plot_colour::kGreen,
                           plot_colour::kPurple, plot_colour::kOrange,     plot_colour::kSky,
                           plot_colour::kBlack};
  for (const auto& [beams, studies] : rooms) {
    std::vector<CostCurve> curves;
    std::vector<std::string> drawn;
    size_t index = 0;
    for (const VaultStudy* study : studies) {
      const char* colour = colours[index++ % std::size(colours)];
      curves.push_back({study->scenario.name, DecidingCosts(*study, study->best), colour});
      for (const NamedResult& thesis : study->thesis) {
        if (std::find(drawn.begin(), drawn.end(), thesis.name) != drawn.end()) continue;
        drawn.push_back(thesis.name);
        curves.push_back({"thesis's " + thesis.name, DecidingCosts(*study, thesis),
                          study->thesis.size() > 1 && &thesis != &study->thesis.front()
                              ? plot_colour::kGrey
                              : colour,
                          "dot"});
      }
    }
    std::erase_if(curves, [](const CostCurve& curve) { return curve.costs.empty(); });
    if (curves.empty()) continue;
    const PlotlyFigure figure = SortedCosts(curves);
    report.Plot(
        fmt::format("{}: costs of all orientations, sorted (thesis figure 4.32). Solid: our "
                    "placements; dotted: the thesis's in the same rooms.",
                    NameOfBeams(beams)),
        figure.traces, figure.layout, 480);
  }
}

void AddSpread(const std::vector<VaultStudy>& studies, Report& report) {
  std::vector<std::vector<std::string>> rows;
  for (const VaultStudy& study : studies) {
    const auto add = [&](const std::string& name, const NamedResult& named) {
      std::vector<double> costs = DecidingCosts(study, named);
      if (costs.empty()) return;
      std::sort(costs.begin(), costs.end());
      rows.push_back({study.scenario.name, name, fmt::format("{:.3f}", costs.front()),
                      fmt::format("{:.3f}", costs[costs.size() / 2]),
                      fmt::format("{:.3f}", std::accumulate(costs.begin(), costs.end(), 0.0) /
                                                static_cast<double>(costs.size())),
                      fmt::format("{:.3f}", costs.back())});
    };
    add(study.options.placement ? "placement asked for" : "our optimum", study.best);
    for (const NamedResult& thesis : study.thesis) {
      if (!study.options.placement) add("thesis's " + thesis.name, thesis);
    }
  }
  report.Table(
      "Least, median, mean and greatest cost over the orientations (thesis 4.8: the least "
      "alone may mislead)",
      {"simulation", "placement", "least", "median", "mean", "greatest"}, rows);
}

}  // namespace

void WriteVaultSummary(const std::vector<VaultStudy>& studies, const std::filesystem::path& folder,
                       const std::string& command_line) {
  if (studies.empty()) return;
  Report report("Where the cameras see the mask best: all simulations",
                fmt::format("{} rooms; retrolux " RETROLUX_VERSION, studies.size()));
  const Rooms rooms = ByBeams(studies);
  AddKeyFigures(rooms, report);
  for (const std::string& paragraph : Reading(studies)) report.Paragraph(paragraph);
  AddBars(rooms, report);
  AddTable(rooms, report);
  AddCurves(rooms, report);
  AddSpread(studies, report);
  report.HowMade(command_line);
  report.Paragraph("Each simulation has a report of its own in the folder of its name.");
  report.Write(folder / "report.html");
}

}  // namespace retrolux
