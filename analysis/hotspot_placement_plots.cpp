#include "analysis/hotspot_placement_plots.h"

#include <cmath>
#include <limits>

#include "analysis/area_plots.h"
#include "analysis/hotspot_placement_verdict.h"
#include "analysis/vault_text.h"

namespace retrolux {

namespace {

using nlohmann::json;
using namespace plot_colour;

// Logarithmic axes begin here: below a photo-electron nothing is anything.
constexpr double kLeast_e = 1.0;

// By separation, the nearest at the top.
std::vector<PlacementPair> BySeparation(const HotspotPlacement& placement) {
  std::vector<PlacementPair> pairs = PairsOf(placement);
  std::stable_sort(pairs.begin(), pairs.end(), [](const PlacementPair& a, const PlacementPair& b) {
    return a.separation_deg < b.separation_deg;
  });
  return pairs;
}

class PlacementPlots {
 public:
  PlacementPlots(const HotspotPlacement& placement, Report& report)
      : placement_(placement), report_(report), pairs_(BySeparation(placement)) {
    for (size_t row = 0; row < pairs_.size(); ++row) row_of_[{pairs_[row].a, pairs_[row].b}] = row;
  }

  void Add() {
    OverSeparation();
    PairsByRotations();
    ForecastAgainstRender();
  }

 private:
  double Threshold_e() const { return kHotspotSigmas * placement_.mask_noise_e; }

  std::string RotationName(size_t rotation) const {
    return TextOf(placement_.options.vault.rotations[rotation]);
  }
  std::string PairName(const PlacementPair& pair) const {
    return fmt::format("{} – {}, {:.1f}°", placement_.cameras[pair.a], placement_.cameras[pair.b],
                       pair.separation_deg);
  }

  static json Line(const char* along, double from, double to, double at, const char* colour) {
    const bool x = *along == 'x';
    return {{"type", "line"},
            {"x0", x ? from : at},
            {"x1", x ? to : at},
            {"y0", x ? at : from},
            {"y1", x ? at : to},
            {x ? "xref" : "yref", "paper"},
            {"line", {{"color", colour}, {"dash", "dash"}, {"width", 1}}}};
  }

  void OverSeparation() {
    PlotCurve highlight{"highlight", {}, {}, kVermillion, "markers"};
    PlotCurve forecast{"forecast of those not rendered", {}, {}, kGrey, "markers"};
    PlotCurve beam{"beam", {}, {}, kBlue, "markers"};
    PlotCurve tail{"retro tail", {}, {}, kGreen, "markers"};
    const auto add = [](PlotCurve& curve, double x, double y) {
      if (y < kLeast_e) return;
      curve.x.push_back(x);
      curve.y.push_back(y);
    };
    for (const PlacementTriple& triple : placement_.triples) {
      const double psi_deg = triple.separation_deg;
      if (!triple.change) {
        add(forecast, psi_deg, triple.forecast.peak_e);
        continue;
      }
      add(highlight, psi_deg, triple.change->highlight.change);
      add(beam, psi_deg, triple.change->beam.change);
      add(tail, psi_deg, triple.change->tail.change);
    }
    json traces =
        FigureOf({forecast, beam, tail, highlight}, json::object(), json::object()).traces;
    for (json& trace : traces) trace["marker"]["size"] = 5;
    traces.front()["marker"]["opacity"] = 0.25;
    json x_axis = AxisTitle("separation of the cameras ψ (degrees)");
    x_axis["range"] = {0, 180};
    report_.Plot(
        "Light of one neighbour's ring in one picture, over the true separation of the pair: peak "
        "of its highlight, beam on the mask's body, retro-reflective tail on markers. "
        "Vertical: the thesis's limit; horizontal: three times the noise of a pixel of the mask",
        traces,
        {{"xaxis", std::move(x_axis)},
         {"yaxis", LogAxisTitle("e-")},
         {"shapes",
          {Line("y", 0, 1, kThesisLimit_deg, kVermillion), Line("x", 0, 1, Threshold_e(), kGrey)}}},
        460);
  }

  // The brighter of the two pictures' forecasts; crosses: hot spots of the render.
  void PairsByRotations() {
    const size_t rotations = placement_.options.vault.rotations.size();
    std::vector<std::vector<double>> peaks(pairs_.size(), std::vector<double>(rotations, 0.0));
    PlotCurve hot{"rendered: a hot spot", {}, {}, kVermillion, "markers", "solid", "x"};
    PlotCurve calm{"rendered: none", {}, {}, kBlack, "markers", "solid", "circle-open"};
    std::vector<std::vector<int>> rendered(pairs_.size(), std::vector<int>(rotations, 0));
    for (const PlacementTriple& triple : placement_.triples) {
      const size_t row = row_of_.at(std::minmax(triple.camera, triple.ring));
      double& peak = peaks[row][triple.rotation];
      peak = std::max(peak, triple.forecast.peak_e);
      int& state = rendered[row][triple.rotation];
      if (triple.change) state = std::max(state, triple.change->IsHotSpot() ? 2 : 1);
    }
    json z = json::array(), names = json::array(), labels = json::array();
    for (size_t row = 0; row < pairs_.size(); ++row) {
      json levels = json::array();
      for (size_t rotation = 0; rotation < rotations; ++rotation) {
        levels.push_back(std::log10(std::max(kLeast_e, peaks[row][rotation])));
        if (rendered[row][rotation] == 0) continue;
        PlotCurve& curve = rendered[row][rotation] == 2 ? hot : calm;
        curve.x.push_back(static_cast<double>(rotation));
        curve.y.push_back(static_cast<double>(row));
      }
      z.push_back(levels);
      names.push_back(PairName(pairs_[row]));
    }
    for (size_t rotation = 0; rotation < rotations; ++rotation)
      labels.push_back(RotationName(rotation));
    json traces = FigureOf({hot, calm}, json::object(), json::object()).traces;
    for (json& trace : traces) trace["marker"]["size"] = 5;
    const json map = {{"type", "heatmap"},
                      {"z", z},
                      {"colorscale", "Viridis"},
                      {"colorbar",
                       {{"title", {{"text", "e-"}}},
                        {"tickvals", {0, 1, 2, 3, 4}},
                        {"ticktext", {"≤ 1", "10", "100", "1,000", "10,000"}}}}};
    traces.insert(traces.begin(), map);
    json x_axis = AxisTitle("rotation of the mask"), y_axis = json::object();
    x_axis["tickvals"] = Counting(rotations, 9);
    x_axis["ticktext"] = Every(labels, 9);
    x_axis["tickangle"] = -60;
    y_axis["tickvals"] = Counting(pairs_.size(), 1);
    y_axis["ticktext"] = names;
    y_axis["autorange"] = "reversed";
    report_.Plot(
        "Forecast of the brighter highlight of each pair at each rotation, the nearest pair at the "
        "top",
        traces,
        {{"xaxis", x_axis},
         {"yaxis", y_axis},
         {"margin", {{"l", 190}, {"b", 140}}},
         {"legend", {{"orientation", "h"}, {"y", 1.06}}}},
        300 + 16 * static_cast<int>(pairs_.size()));
  }

  static json Counting(size_t count, size_t step) {
    json numbers = json::array();
    for (size_t i = 0; i < count; i += step) numbers.push_back(i);
    return numbers;
  }
  static json Every(const json& labels, size_t step) {
    json some = json::array();
    for (size_t i = 0; i < labels.size(); i += step) some.push_back(labels[i]);
    return some;
  }

  void ForecastAgainstRender() {
    PlotCurve points{"picture and ring", {}, {}, kBlue, "markers"};
    double most = kLeast_e;
    for (const PlacementTriple& triple : placement_.triples) {
      if (!triple.change || triple.forecast.peak_e < kLeast_e) continue;
      points.x.push_back(triple.forecast.peak_e);
      points.y.push_back(std::max(kLeast_e, triple.change->highlight.change));
      most = std::max(most, triple.forecast.peak_e);
    }
    const PlotCurve equal{"equal", {kLeast_e, most}, {kLeast_e, most}, kGrey, "lines", "dash"};
    json traces = FigureOf({points, equal}, json::object(), json::object()).traces;
    traces.front()["marker"]["size"] = 5;
    report_.Plot(
        "Peak of a highlight: render against forecast. Below the line: edges and silhouettes, "
        "where a highlight is narrower than three pixels",
        traces, {{"xaxis", LogAxisTitle("forecast (e-)")}, {"yaxis", LogAxisTitle("render (e-)")}},
        440);
  }

  const HotspotPlacement& placement_;
  Report& report_;
  std::vector<PlacementPair> pairs_;
  std::map<std::pair<size_t, size_t>, size_t> row_of_;
};

}  // namespace

void AddPlacementPlots(const HotspotPlacement& placement, Report& report) {
  PlacementPlots(placement, report).Add();
}

}  // namespace retrolux
