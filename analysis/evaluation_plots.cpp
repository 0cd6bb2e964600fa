#include "analysis/evaluation_plots.h"

#include <algorithm>
#include <cmath>

namespace retrolux {

using nlohmann::json;

namespace {

using namespace plot_colour;

// By the number of the method.
const char* ColourOf(size_t method) {
  constexpr const char* kColours[] = {kBlue, kVermillion, kGreen, kPurple};
  return kColours[method % std::size(kColours)];
}

// An axis of groups in their order.
json GroupAxis(const EvaluationVariable& variable) {
  json axis = AxisTitle(variable.title);
  axis["type"] = "category";
  axis["categoryorder"] = "array";
  axis["categoryarray"] = json::array();
  for (const EvaluationGroup& group : variable.groups)
    axis["categoryarray"].push_back(group.Label());
  return axis;
}

// Values that have an order are joined.
json Trace(const EvaluationVariable& variable, const std::string& name, const char* colour) {
  const bool ordered = !variable.groups.empty() && variable.groups.back().is_range;
  return {{"type", "scatter"},
          {"mode", ordered ? "lines+markers" : "markers"},
          {"name", name},
          {"x", json::array()},
          {"y", json::array()},
          {"text", json::array()},
          {"line", {{"color", colour}}},
          {"marker", {{"color", colour}}}};
}

}  // namespace

PlotlyFigure RecallFigure(const Evaluation& evaluation, const EvaluationVariable& variable) {
  PlotlyFigure figure;
  for (size_t m = 0; m < evaluation.methods.size(); ++m) {
    json trace = Trace(variable, evaluation.methods[m].method, ColourOf(m));
    json up = json::array(), down = json::array();
    for (const EvaluationGroup& group : variable.groups) {
      const Proportion share = ScoresOf(evaluation, evaluation.methods[m], group.choice).Recall();
      if (share.of == 0) continue;
      const Interval interval = share.Wilson();
      trace["x"].push_back(group.Label());
      trace["y"].push_back(100.0 * *share.Value());
      trace["text"].push_back(fmt::format("{} of {}", share.count, share.of));
      up.push_back(100.0 * (interval.high - *share.Value()));
      down.push_back(100.0 * (*share.Value() - interval.low));
    }
    trace["error_y"] = {
        {"type", "data"}, {"symmetric", false}, {"array", up}, {"arrayminus", down}};
    figure.traces.push_back(std::move(trace));
  }
  json y_axis = AxisTitle("found (%)");
  y_axis["range"] = {-3, 103};
  figure.layout = {{"xaxis", GroupAxis(variable)}, {"yaxis", y_axis}};
  figure.height_px = 320;
  return figure;
}

PlotlyFigure CentroidFigure(const Evaluation& evaluation, const EvaluationVariable& variable) {
  PlotlyFigure figure;
  for (size_t m = 0; m < evaluation.methods.size(); ++m) {
    const std::string& name = evaluation.methods[m].method;
    json rms = Trace(variable, name + ", rms", ColourOf(m));
    json bias = Trace(variable, name + ", bias", ColourOf(m));
    bias["line"]["dash"] = "dot";
    bias["marker"]["symbol"] = "diamond-open";
    json scatter = json::array();
    for (const EvaluationGroup& group : variable.groups) {
      const PlaceErrors errors = ScoresOf(evaluation, evaluation.methods[m], group.choice).centroid;
      if (errors.Count() == 0) continue;
      const std::string count = fmt::format("{} found", errors.Count());
      for (json* trace : {&rms, &bias}) {
        (*trace)["x"].push_back(group.Label());
        (*trace)["text"].push_back(count);
      }
      rms["y"].push_back(errors.rms);
      bias["y"].push_back(errors.Bias());
      scatter.push_back(errors.BiasError());
    }
    bias["error_y"] = {{"type", "data"}, {"array", scatter}};
    figure.traces.push_back(std::move(rms));
    figure.traces.push_back(std::move(bias));
  }
  json y_axis = AxisTitle("centroid error (px)");
  y_axis["rangemode"] = "tozero";
  figure.layout = {{"xaxis", GroupAxis(variable)}, {"yaxis", y_axis}};
  figure.height_px = 320;
  return figure;
}

PlotlyFigure ConfusionFigure(const Confusion& confusion) {
  json shares = json::array(), texts = json::array();
  for (const std::vector<int64_t>& row : confusion.counts) {
    int64_t sum = 0;
    for (const int64_t count : row) sum += count;
    json share_row = json::array(), text_row = json::array();
    for (const int64_t count : row) {
      share_row.push_back(sum > 0 ? 100.0 * static_cast<double>(count) / static_cast<double>(sum)
                                  : 0.0);
      text_row.push_back(count > 0 ? std::to_string(count) : "");
    }
    shares.push_back(std::move(share_row));
    texts.push_back(std::move(text_row));
  }
  json x_axis = AxisTitle("named"), y_axis = AxisTitle("is");
  x_axis["type"] = y_axis["type"] = "category";
  y_axis["autorange"] = "reversed";
  PlotlyFigure figure;
  figure.traces = {{{"type", "heatmap"},
                    {"x", confusion.named},
                    {"y", confusion.truth},
                    {"z", shares},
                    {"text", texts},
                    {"texttemplate", "%{text}"},
                    {"colorscale", {{0, "#ffffff"}, {1, kBlue}}},
                    {"colorbar", {{"title", {{"text", "% of the row"}}}}},
                    {"xgap", 1},
                    {"ygap", 1}}};
  figure.layout = {{"xaxis", x_axis}, {"yaxis", y_axis}};
  return figure;
}

PlotlyFigure ErrorHistogram(const Evaluation& evaluation, const MethodResult& method) {
  constexpr double kBin_px = 0.01;
  constexpr int kReach = 30;  // bins on each side
  struct Axis {
    const char *name, *colour;
    std::vector<int> counts = std::vector<int>(2 * kReach + 1, 0);
  };
  Axis axes[] = {{"along u", kBlue}, {"along v", kGreen}, {"along the tilt", kVermillion}};
  const auto add = [&](Axis& axis, double error) {
    const double bin = std::clamp<double>(std::round(error / kBin_px), -kReach, kReach);
    ++axis.counts[static_cast<size_t>(bin + kReach)];
  };
  for (size_t i = 0; i < method.markers.size(); ++i) {
    const auto& centroid = method.markers[i].centroid;
    if (!centroid || !evaluation.markers[i].shape.counts) continue;
    add(axes[0], centroid->error.x());
    add(axes[1], centroid->error.y());
    if (centroid->tilt) add(axes[2], centroid->error.dot(*centroid->tilt));
  }
  json places = json::array();
  for (int bin = -kReach; bin <= kReach; ++bin) places.push_back(kBin_px * bin);
  PlotlyFigure figure;
  for (const Axis& axis : axes) {
    figure.traces.push_back({{"type", "scatter"},
                             {"mode", "lines"},
                             {"name", axis.name},
                             {"x", places},
                             {"y", axis.counts},
                             {"line", {{"shape", "hvh"}, {"color", axis.colour}}}});
  }
  figure.layout = {{"xaxis", AxisTitle("centroid error (px); beyond the ends: in the last bins")},
                   {"yaxis", AxisTitle("markers")}};
  figure.height_px = 320;
  return figure;
}

}  // namespace retrolux
