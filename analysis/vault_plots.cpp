#include "analysis/vault_plots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "analysis/vault_text.h"

namespace retrolux {

namespace {

using nlohmann::json;
using namespace plot_colour;

// Angles that differ by rounding only are one.
double Rounded(double deg) {
  return std::round(1e6 * deg) / 1e6;
}

double RoundedCost(double cost) {
  return std::round(1e4 * cost) / 1e4;
}

json Title(const std::string& text) {
  return {{"title", {{"text", text}}}};
}

const char* const kCostTitle = "cost (dm²)";

std::string HoverOf(const PlacementResult& result) {
  return fmt::format("{}: {:.3f}", TextOf(result.Where()), result.Cost());
}

json StarMarker(const char* colour, const char* symbol = "star", int size = 15) {
  return {{"symbol", symbol},
          {"size", size},
          {"color", colour},
          {"line", {{"color", "#ffffff"}, {"width", 1.5}}}};
}

// The placements that are marked in a figure: our optimum, the thesis's.
struct Mark {
  std::string name;
  const PlacementResult* result;
  json marker;
};

std::vector<Mark> MarksOf(const VaultStudy& study) {
  std::vector<Mark> marks;
  marks.push_back({"our optimum", &study.best.result, StarMarker(kVermillion)});
  for (const NamedResult& thesis : study.thesis) {
    marks.push_back({fmt::format("placement of the thesis's {}", thesis.name), &thesis.result,
                     StarMarker(kSky, marks.size() == 1 ? "diamond" : "square", 10)});
  }
  return marks;
}

// --- cost over the heights ---

using Heights = std::pair<double, double>;  // theta_1, theta_2
using Map = std::map<Heights, double>;

std::map<double, Map> MapsByPhiB(const VaultStudy& study) {
  std::map<double, Map> maps;
  for (const PlacementResult& r : study.results) {
    if (r.phase != 1) continue;
    const Placement& p = r.Where();
    maps[Rounded(p.phi_b_deg)][{Rounded(p.theta1_deg), Rounded(p.theta2_deg)}] = r.Cost();
  }
  return maps;
}

std::vector<double> ValuesOf(const std::map<double, Map>& maps, double Heights::*which) {
  std::vector<double> values;
  for (const auto& [phi_b, map] : maps) {
    for (const auto& [heights, cost] : map) values.push_back(heights.*which);
  }
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

std::pair<double, double> CostRange(const std::map<double, Map>& maps) {
  std::pair<double, double> range = {1e300, -1e300};
  for (const auto& [phi_b, map] : maps) {
    for (const auto& [heights, cost] : map)
      range = {std::min(range.first, cost), std::max(range.second, cost)};
  }
  return range;
}

// Small multiples, in rows.
class HeightMaps {
 public:
  HeightMaps(const VaultStudy& study, const std::map<double, Map>& maps)
      : study_(study),
        maps_(maps),
        theta1_(ValuesOf(maps, &Heights::first)),
        theta2_(ValuesOf(maps, &Heights::second)),
        columns_(std::min<int>(static_cast<int>(maps.size()), kMostColumns)),
        rows_((static_cast<int>(maps.size()) + columns_ - 1) / columns_) {}

  PlotlyFigure Draw() {
    const auto [least, greatest] = CostRange(maps_);
    figure_.layout = {{"annotations", json::array()},
                      {"coloraxis",
                       {{"colorscale", "Cividis"},
                        {"cmin", RoundedCost(least)},
                        {"cmax", RoundedCost(greatest)},
                        {"colorbar",
                         {{"title", {{"text", kCostTitle}, {"side", "right"}}},
                          {"x", columns_ * (PanelWidth() + kGap)},
                          {"outlinewidth", 0},
                          {"thickness", 14}}}}},
                      {"legend", {{"y", 1.0 + 45.0 / (kRowHeight_px * rows_)}}},
                      {"margin", {{"t", 80}}},
                      {"hovermode", "closest"}};
    figure_.height_px = kRowHeight_px * rows_ + 140;
    int index = 0;
    for (const auto& [phi_b, map] : maps_) AddPanel(index++, phi_b, map);
    AddMarks();
    return std::move(figure_);
  }

 private:
  static constexpr int kMostColumns = 5;
  static constexpr int kRowHeight_px = 235;
  static constexpr double kGap = 0.03;  // between panels, of the figure's width

  // A few maps are not stretched over the whole page.
  double PanelWidth() const { return (1.0 + kGap) / std::max(3, columns_) - kGap; }

  static std::string AxisName(const char* letter, int index) {
    return index == 0 ? letter : fmt::format("{}{}", letter, index + 1);
  }

  json Axis(const std::vector<double>& thetas, bool labelled, const std::string& title) const {
    json axis = {
        {"tickvals", json::array()},  {"ticktext", json::array()}, {"tickangle", 0},
        {"tickfont", {{"size", 11}}}, {"showgrid", false},         {"showticklabels", labelled}};
    // Three labels fit a panel.
    const size_t every = std::max<size_t>(1, (thetas.size() + 1) / 3);
    for (size_t i = 0; i < thetas.size(); i += every) {
      axis["tickvals"].push_back(thetas[i]);
      axis["ticktext"].push_back(fmt::format("{:.1f}°", thetas[i]));
    }
    if (labelled) axis["title"] = {{"text", title}, {"standoff", 6}};
    return axis;
  }

  void AddPanel(int index, double phi_b, const Map& map) {
    const int column = index % columns_, row = index / columns_;
    const bool lowest = index + columns_ >= static_cast<int>(maps_.size());
    const double width = PanelWidth();
    const double gap = 0.22 / rows_, height = (1.0 + gap) / rows_ - gap;
    const double left = column * (width + kGap), top = 1.0 - row * (height + gap);
    const std::string x = AxisName("x", index), y = AxisName("y", index);
    json x_axis = Axis(theta1_, lowest, "θ₁"), y_axis = Axis(theta2_, column == 0, "θ₂");
    x_axis.update({{"domain", {left, std::min(1.0, left + width)}}, {"anchor", y}});
    y_axis.update({{"domain", {std::max(0.0, top - height), top}}, {"anchor", x}});
    figure_.layout["xaxis" + x.substr(1)] = x_axis;
    figure_.layout["yaxis" + y.substr(1)] = y_axis;
    const auto best = std::max_element(
        map.begin(), map.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    figure_.layout["annotations"].push_back(
        {{"text",
          fmt::format("<b>φ<sub>b</sub> {}</b>  best {:.2f}", Degrees(phi_b), best->second)},
         {"font", {{"size", 12}}},
         {"x", left},
         {"y", top},
         {"xref", "paper"},
         {"yref", "paper"},
         {"xanchor", "left"},
         {"yanchor", "bottom"},
         {"showarrow", false}});
    figure_.traces.push_back(
        {{"type", "heatmap"},
         {"x", theta1_},
         {"y", theta2_},
         {"z", Rows(map)},
         {"xaxis", x},
         {"yaxis", y},
         {"coloraxis", "coloraxis"},
         {"xgap", 1},
         {"ygap", 1},
         {"hovertemplate",
          "φb " + Degrees(phi_b) + ", θ₁ %{x:.2f}°, θ₂ %{y:.2f}°: %{z:.3f}<extra></extra>"}});
  }

  json Rows(const Map& map) const {
    json rows = json::array();
    for (const double theta2 : theta2_) {
      json row = json::array();
      for (const double theta1 : theta1_) {
        const auto at = map.find({theta1, theta2});
        row.push_back(at == map.end() ? json(nullptr) : json(RoundedCost(at->second)));
      }
      rows.push_back(std::move(row));
    }
    return rows;
  }

  // In the panel whose phi_b is nearest.
  void AddMarks() {
    for (const Mark& mark : MarksOf(study_)) {
      const Placement& p = mark.result->Where();
      int nearest = 0, index = 0;
      double least = 1e300;
      for (const auto& [phi_b, map] : maps_) {
        if (std::abs(phi_b - p.phi_b_deg) < least) {
          least = std::abs(phi_b - p.phi_b_deg);
          nearest = index;
        }
        ++index;
      }
      figure_.traces.push_back({{"type", "scatter"},
                                {"mode", "markers"},
                                {"name", fmt::format("{}, φb {}", mark.name, Degrees(p.phi_b_deg))},
                                {"x", {p.theta1_deg}},
                                {"y", {p.theta2_deg}},
                                {"text", {HoverOf(*mark.result)}},
                                {"hoverinfo", "text"},
                                {"xaxis", AxisName("x", nearest)},
                                {"yaxis", AxisName("y", nearest)},
                                {"cliponaxis", false},
                                {"marker", mark.marker}});
    }
  }

  const VaultStudy& study_;
  const std::map<double, Map>& maps_;
  std::vector<double> theta1_, theta2_;
  int columns_, rows_;
  PlotlyFigure figure_;
};

// Cividis from dark to light, short of its palest end, for lines in order.
std::string OrderedColour(double place) {
  constexpr std::array<std::array<double, 3>, 4> kStops = {
      {{0, 32, 77}, {76, 83, 110}, {140, 134, 118}, {219, 194, 64}}};
  const double at = std::clamp(place, 0.0, 1.0) * (kStops.size() - 1);
  const size_t stop = std::min(kStops.size() - 2, static_cast<size_t>(at));
  const double weight = at - static_cast<double>(stop);
  std::array<int, 3> rgb{};
  for (size_t k = 0; k < 3; ++k) {
    rgb[k] = static_cast<int>(
        std::lround((1.0 - weight) * kStops[stop][k] + weight * kStops[stop + 1][k]));
  }
  return fmt::format("rgb({},{},{})", rgb[0], rgb[1], rgb[2]);
}

PlotlyFigure HeightLines(const VaultStudy& study, const std::map<double, Map>& maps) {
  PlotlyFigure figure;
  size_t index = 0;
  for (const auto& [phi_b, map] : maps) {
    json x = json::array(), y = json::array();
    for (const auto& [heights, cost] : map) {
      x.push_back(std::round(OverFloor_mm(study.scenario, heights.first)));
      y.push_back(RoundedCost(cost));
    }
    const double place =
        maps.size() < 2 ? 0.0 : static_cast<double>(index) / static_cast<double>(maps.size() - 1);
    figure.traces.push_back({{"type", "scatter"},
                             {"mode", "lines+markers"},
                             {"name", "φb " + Degrees(phi_b)},
                             {"line", {{"color", OrderedColour(place)}}},
                             {"x", x},
                             {"y", y}});
    ++index;
  }
  for (const Mark& mark : MarksOf(study)) {
    figure.traces.push_back(
        {{"type", "scatter"},
         {"mode", "markers"},
         {"name", mark.name},
         {"x", {std::round(OverFloor_mm(study.scenario, mark.result->Where().theta1_deg))}},
         {"y", {RoundedCost(mark.result->Cost())}},
         {"text", {HoverOf(*mark.result)}},
         {"hoverinfo", "text"},
         {"marker", mark.marker}});
  }
  figure.layout = {{"xaxis", Title("height of the cameras over the floor (mm)")},
                   {"yaxis", Title(kCostTitle)}};
  return figure;
}

}  // namespace

std::optional<PlotlyFigure> CostOverHeights(const VaultStudy& study) {
  const std::map<double, Map> maps = MapsByPhiB(study);
  const size_t most =
      maps.empty() ? 0
                   : std::max_element(maps.begin(), maps.end(), [](const auto& a, const auto& b) {
                       return a.second.size() < b.second.size();
                     })->second.size();
  if (most < 2) return std::nullopt;
  if (study.scenario.rigs.same_height) return HeightLines(study, maps);
  return HeightMaps(study, maps).Draw();
}

std::optional<PlotlyFigure> CostOverPhiB(const VaultStudy& study) {
  std::map<double, const PlacementResult*> best;
  for (const PlacementResult& result : study.results) {
    const PlacementResult*& at = best[Rounded(result.Where().phi_b_deg)];
    if (!at || at->Cost() < result.Cost()) at = &result;
  }
  if (best.size() < 2) return std::nullopt;
  json x = json::array(), y = json::array(), text = json::array(), symbols = json::array();
  for (const auto& [phi_b, result] : best) {
    x.push_back(phi_b);
    y.push_back(RoundedCost(result->Cost()));
    text.push_back(HoverOf(*result));
    symbols.push_back(result->phase == 1 ? "circle" : "circle-open");
  }
  PlotlyFigure figure;
  figure.traces.push_back({{"type", "scatter"},
                           {"mode", "lines+markers"},
                           {"name", "best of all heights"},
                           {"x", x},
                           {"y", y},
                           {"text", text},
                           {"hoverinfo", "text"},
                           {"marker", {{"symbol", symbols}, {"color", kBlue}}},
                           {"line", {{"color", kBlue}}}});
  for (const Mark& mark : MarksOf(study)) {
    figure.traces.push_back({{"type", "scatter"},
                             {"mode", "markers"},
                             {"name", mark.name},
                             {"x", {mark.result->Where().phi_b_deg}},
                             {"y", {RoundedCost(mark.result->Cost())}},
                             {"text", {HoverOf(*mark.result)}},
                             {"hoverinfo", "text"},
                             {"marker", mark.marker}});
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
  figure.layout = {{"xaxis", Title("φ<sub>b</sub> (degrees)")}, {"yaxis", Title(kCostTitle)}};
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
  figure.layout = {{"xaxis", Title("orientations of the mask, those that are worth least first")},
                   {"yaxis", Title(kCostTitle)},
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
  figure.layout = {{"xaxis", Title("number of the orientation, as in orientations.csv")},
                   {"yaxis", Title(kCostTitle)},
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
                   {"yaxis", Title(kCostTitle)}};
  return figure;
}

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
  figure.layout = {{"xaxis", Title(kCostTitle)},
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
