#include <algorithm>
#include <cmath>

#include "analysis/vault_plot_parts.h"
#include "analysis/vault_plots.h"
#include "analysis/vault_text.h"

namespace retrolux {

using nlohmann::json;
using namespace plot_colour;

namespace {

// Two moves of one variable by the same step, to either side; one may not be possible.
struct MovePair {
  std::string name;
  double step_deg = 0.0;
  const NamedResult* less = nullptr;
  const NamedResult* more = nullptr;
};

std::vector<MovePair> MovesOf(const VaultStudy& study) {
  const Placement& best = study.best.result.Where();
  std::vector<MovePair> pairs;
  for (const NamedResult& moved : study.sensitivity) {
    const Placement& p = moved.result.Where();
    const std::pair<const char*, double> changes[] = {{"φb", p.phi_b_deg - best.phi_b_deg},
                                                      {"θ₁", p.theta1_deg - best.theta1_deg},
                                                      {"θ₂", p.theta2_deg - best.theta2_deg}};
    for (const auto& [name, change] : changes) {
      if (std::abs(change) < 1e-9) continue;
      const auto same = [&, n = name, c = change](const MovePair& pair) {
        return pair.name.starts_with(n) && std::abs(pair.step_deg - std::abs(c)) < 1e-9;
      };
      auto pair = std::find_if(pairs.begin(), pairs.end(), same);
      if (pair == pairs.end()) {
        pairs.push_back({fmt::format("{} ± {:g}°", name, std::abs(change)), std::abs(change)});
        pair = pairs.end() - 1;
      }
      (change < 0.0 ? pair->less : pair->more) = &moved;
      break;  // with both rigs at one height theta_2 moves along
    }
  }
  const auto most = [&](const MovePair& pair) {
    double change = 0.0;
    for (const NamedResult* moved : {pair.less, pair.more}) {
      if (moved)
        change = std::max(change, std::abs(moved->result.Cost() - study.best.result.Cost()));
    }
    return change;
  };
  std::stable_sort(pairs.begin(), pairs.end(),
                   [&](const MovePair& a, const MovePair& b) { return most(a) < most(b); });
  return pairs;
}

// By how much a moved rig hangs higher, or "".
std::string HeightChange(const VaultStudy& study, const Placement& moved) {
  const Placement& best = study.best.result.Where();
  const auto change = [&](double from_deg, double to_deg) {
    return RigHeight_mm(study.scenario, to_deg) - RigHeight_mm(study.scenario, from_deg);
  };
  double mm = change(best.theta1_deg, moved.theta1_deg);
  if (mm == 0.0) mm = change(best.theta2_deg, moved.theta2_deg);
  return mm == 0.0 ? "" : fmt::format("rig {}{:.0f} mm", mm < 0.0 ? "−" : "+", std::abs(mm));
}

}  // namespace

std::optional<PlotlyFigure> SensitivityBars(const VaultStudy& study) {
  if (study.sensitivity.empty()) return std::nullopt;
  const std::vector<MovePair> pairs = MovesOf(study);
  PlotlyFigure figure;
  double least = 0.0, greatest = 0.0;
  const auto add = [&](const char* name, const NamedResult* MovePair::*which, const char* colour) {
    json x = json::array(), y = json::array(), text = json::array();
    for (const MovePair& pair : pairs) {
      const NamedResult* moved = pair.*which;
      y.push_back(pair.name);
      const double change = moved ? moved->result.Cost() - study.best.result.Cost() : 0.0;
      least = std::min(least, change);
      greatest = std::max(greatest, change);
      x.push_back(moved ? json(RoundedCost(change)) : json(nullptr));
      text.push_back(moved ? HeightChange(study, moved->result.Where()) : "");
    }
    figure.traces.push_back({{"type", "bar"},
                             {"orientation", "h"},
                             {"name", name},
                             {"x", x},
                             {"y", y},
                             {"text", text},
                             {"textposition", "outside"},
                             {"cliponaxis", false},
                             {"marker", {{"color", colour}}}});
  };
  add("variable smaller", &MovePair::less, kBlue);
  add("variable larger", &MovePair::more, kOrange);
  const double room = 0.15 * (greatest - least) + 1e-3;  // for the labels
  figure.layout = {{"barmode", "group"},
                   {"xaxis",
                    {{"title", {{"text", "change of the cost (dm²)"}}},
                     {"range", {least - room, greatest + room}}}},
                   {"yaxis", {{"automargin", true}, {"type", "category"}}}};
  figure.height_px = 140 + 52 * static_cast<int>(pairs.size());
  return figure;
}

std::optional<PlotlyFigure> VariationLines(const VaultStudy& study) {
  if (study.variations.empty()) return std::nullopt;
  PlotlyFigure figure;
  json names = json::array(), best = json::array(), ours = json::array(), text = json::array();
  json link_x = json::array(), link_y = json::array();
  for (auto v = study.variations.rbegin(); v != study.variations.rend(); ++v) {
    names.push_back(v->name);
    best.push_back(RoundedCost(v->best.Cost()));
    ours.push_back(RoundedCost(v->cost_of_ours));
    text.push_back(fmt::format("   {}", TextOf(v->best.Where())));
    for (const json& x : {best.back(), ours.back(), json(nullptr)}) link_x.push_back(x);
    for (int i = 0; i < 3; ++i) link_y.push_back(v->name);
  }
  figure.traces.push_back({{"type", "scatter"},
                           {"mode", "lines"},
                           {"x", link_x},
                           {"y", link_y},
                           {"hoverinfo", "skip"},
                           {"showlegend", false},
                           {"line", {{"color", kGrey}, {"width", 3}}}});
  figure.traces.push_back(
      {{"type", "scatter"},
       {"mode", "markers+text"},
       {"name", "best placement under the variation"},
       {"x", best},
       {"y", names},
       {"text", text},
       {"textposition", "middle right"},
       {"textfont", {{"size", 11}}},
       {"cliponaxis", false},
       {"marker",
        {{"symbol", "circle-open"}, {"size", 16}, {"color", kGreen}, {"line", {{"width", 2.5}}}}}});
  figure.traces.push_back(
      {{"type", "scatter"},
       {"mode", "markers"},
       {"name", "our optimum there"},
       {"x", ours},
       {"y", names},
       {"marker", {{"symbol", "diamond"}, {"size", 11}, {"color", kVermillion}}}});
  const double base = RoundedCost(study.best.result.Cost());
  figure.layout = {{"xaxis", AxisTitle(kCostTitle)},
                   {"yaxis", {{"automargin", true}, {"type", "category"}}},
                   {"margin", {{"r", 190}}},
                   {"shapes",
                    {{{"type", "line"},
                      {"x0", base},
                      {"x1", base},
                      {"yref", "paper"},
                      {"y0", 0},
                      {"y1", 1},
                      {"line", {{"color", kBlack}, {"width", 1}, {"dash", "dot"}}}}}}};
  figure.height_px = 140 + 38 * static_cast<int>(study.variations.size());
  return figure;
}

}  // namespace retrolux
