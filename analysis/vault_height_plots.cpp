#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "analysis/vault_plot_parts.h"
#include "analysis/vault_plots.h"
#include "analysis/vault_text.h"

namespace retrolux {

namespace {

using nlohmann::json;
using namespace plot_colour;

using Heights = std::pair<double, double>;  // theta_1, theta_2
using Map = std::map<Heights, double>;

std::map<double, Map> MapsByPhiB(const VaultStudy& study) {
  std::map<double, Map> maps;
  for (const PlacementResult& r : study.results) {
    if (r.phase != 1) continue;
    const Placement& p = r.Where();
    maps[RoundedAngle(p.phi_b_deg)][{RoundedAngle(p.theta1_deg), RoundedAngle(p.theta2_deg)}] =
        r.Cost();
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
    for (const PlacementMark& mark : MarksOf(study_)) {
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
      json trace = TraceOf(mark, p.theta1_deg, p.theta2_deg);
      trace.update({{"name", fmt::format("{}, φb {}", mark.name, Degrees(p.phi_b_deg))},
                    {"xaxis", AxisName("x", nearest)},
                    {"yaxis", AxisName("y", nearest)},
                    {"cliponaxis", false}});
      figure_.traces.push_back(std::move(trace));
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
  for (const PlacementMark& mark : MarksOf(study)) {
    const double height_mm = OverFloor_mm(study.scenario, mark.result->Where().theta1_deg);
    figure.traces.push_back(TraceOf(mark, std::round(height_mm), RoundedCost(mark.result->Cost())));
  }
  figure.layout = {{"xaxis", AxisTitle("height of the cameras over the floor (mm)")},
                   {"yaxis", AxisTitle(kCostTitle)}};
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

}  // namespace retrolux
