#include "analysis/vault_plots.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "analysis/vault_plot_parts.h"
#include "analysis/vault_text.h"

namespace retrolux {

using nlohmann::json;
using namespace plot_colour;

namespace {

using BestByPhiB = std::map<double, const PlacementResult*>;

BestByPhiB BestOfEachPhiB(const VaultStudy& study, int phase) {
  BestByPhiB best;
  for (const PlacementResult& result : study.results) {
    if (result.phase != phase) continue;
    const PlacementResult*& at = best[RoundedAngle(result.Where().phi_b_deg)];
    if (!at || at->Cost() < result.Cost()) at = &result;
  }
  return best;
}

json TraceOf(const BestByPhiB& best, const char* name, const char* mode, const char* symbol) {
  json x = json::array(), y = json::array(), text = json::array();
  for (const auto& [phi_b, result] : best) {
    x.push_back(phi_b);
    y.push_back(RoundedCost(result->Cost()));
    text.push_back(HoverOf(*result));
  }
  return {{"type", "scatter"},
          {"mode", mode},
          {"name", name},
          {"x", x},
          {"y", y},
          {"text", text},
          {"hoverinfo", "text"},
          {"marker", {{"symbol", symbol}, {"color", kBlue}}},
          {"line", {{"color", kBlue}}}};
}

}  // namespace

std::optional<PlotlyFigure> CostOverPhiB(const VaultStudy& study) {
  const BestByPhiB coarse = BestOfEachPhiB(study, 1), fine = BestOfEachPhiB(study, 2);
  if (coarse.size() + fine.size() < 2) return std::nullopt;
  PlotlyFigure figure;
  figure.traces.push_back(TraceOf(coarse, "phase 1, all heights", "lines+markers", "circle"));
  // No line: between its patches phase 2 has not looked at all heights.
  if (!fine.empty()) {
    figure.traces.push_back(
        TraceOf(fine, "phase 2, around the best of phase 1", "markers", "circle-open"));
  }
  for (const PlacementMark& mark : MarksOf(study)) {
    figure.traces.push_back(
        TraceOf(mark, mark.result->Where().phi_b_deg, RoundedCost(mark.result->Cost())));
  }
  for (const ThesisSolution& printed : study.scenario.thesis) {
    figure.traces.push_back(
        {{"type", "scatter"},
         {"mode", "markers"},
         {"name", fmt::format("{} as the thesis prints it", printed.name)},
         {"x", {printed.phi_b_deg}},
         {"y", {printed.cost}},
         {"marker", {{"symbol", "x-thin"}, {"size", 11}, {"line", {{"width", 2.5}}}}}});
  }
  figure.layout = {{"xaxis", AxisTitle("φ<sub>b</sub> (degrees)")},
                   {"yaxis", AxisTitle(kCostTitle)}};
  return figure;
}

PlotlyFigure SortedCosts(const std::vector<CostCurve>& curves) {
  PlotlyFigure figure;
  for (const CostCurve& curve : curves) {
    std::vector<double> costs = curve.costs;
    std::sort(costs.begin(), costs.end());
    for (double& cost : costs) cost = RoundedCost(cost);
    json line = {{"dash", curve.dash}};
    if (!curve.colour.empty()) line["color"] = curve.colour;
    figure.traces.push_back({{"type", "scatter"},
                             {"mode", "lines"},
                             {"name", curve.name},
                             {"x0", 1},
                             {"y", costs},
                             {"line", line}});
  }
  figure.layout = {
      {"xaxis", AxisTitle("orientations of the mask, those that are worth least first")},
      {"yaxis", AxisTitle(kCostTitle)},
      {"hovermode", "x unified"}};
  return figure;
}

std::optional<PlotlyFigure> OptimumAgainstRunnerUp(const VaultStudy& study) {
  if (!study.runner_up || study.runner_up->orientations.empty() || study.best.orientations.empty())
    return std::nullopt;
  const size_t mask = study.best.result.WorstMask();
  json text = json::array();
  for (const MaskRotation& rotation : study.rotations[mask]) text.push_back(TextOf(rotation));
  PlotlyFigure figure;
  const auto add = [&](const NamedResult& named, const std::string& name, const char* colour) {
    json y = json::array();
    for (const double cost : CostsOf(named.orientations[mask])) y.push_back(RoundedCost(cost));
    figure.traces.push_back({{"type", "scatter"},
                             {"mode", "lines"},
                             {"name", name},
                             {"x0", 1},
                             {"y", y},
                             {"text", text},
                             {"hovertemplate", "%{text}: %{y:.3f}"},
                             {"line", {{"color", colour}, {"width", 1.6}}}});
  };
  add(study.best, "optimum", kBlue);
  add(*study.runner_up, "runner-up", kOrange);
  figure.layout = {{"xaxis", AxisTitle("number of the orientation, as in orientations.csv")},
                   {"yaxis", AxisTitle(kCostTitle)},
                   {"hovermode", "x unified"}};
  return figure;
}

std::optional<PlotlyFigure> MasksCompared(const VaultStudy& study) {
  const size_t masks = study.options.masks.size();
  if (masks < 2 || study.results.size() < 2) return std::nullopt;
  const auto sum = [&](size_t mask) {
    return std::accumulate(
        study.results.begin(), study.results.end(), 0.0,
        [&](double s, const PlacementResult& r) { return s + r.by_mask[mask].Cost(); });
  };
  size_t top = 0;
  for (size_t mask = 1; mask < masks; ++mask) top = sum(mask) > sum(top) ? mask : top;
  std::vector<const PlacementResult*> order;
  for (const PlacementResult& result : study.results) order.push_back(&result);
  std::stable_sort(order.begin(), order.end(), [&](const auto* a, const auto* b) {
    return a->by_mask[top].Cost() < b->by_mask[top].Cost();
  });
  PlotlyFigure figure;
  for (size_t mask = 0; mask < masks; ++mask) {
    json y = json::array(), text = json::array();
    for (const PlacementResult* result : order) {
      y.push_back(RoundedCost(result->by_mask[mask].Cost()));
      text.push_back(TextOf(result->Where()));
    }
    figure.traces.push_back({{"type", "scatter"},
                             {"mode", mask == top ? "lines" : "markers"},
                             {"name", study.options.masks[mask]},
                             {"x0", 1},
                             {"y", y},
                             {"text", text},
                             {"hovertemplate", "%{text}: %{y:.3f}"},
                             {"marker", {{"size", 4}}}});
  }
  figure.layout = {{"xaxis",
                    {{"title",
                      {{"text", fmt::format("placements, sorted by the cost of the {} mask",
                                            study.options.masks[top])}}},
                     {"range", {0, study.results.size() + 1}}}},
                   {"yaxis", AxisTitle(kCostTitle)}};
  return figure;
}

}  // namespace retrolux
