#include "analysis/area_plots.h"

#include "analysis/area_tests.h"

namespace retrolux {

namespace {

using nlohmann::json;
using namespace plot_colour;

json TraceOf(const PlotCurve& curve) {
  json trace = {{"type", "scatter"},
                {"mode", curve.mode},
                {"name", curve.name},
                {"x", curve.x},
                {"y", curve.y},
                {"line", {{"dash", curve.dash}}},
                {"marker", {{"symbol", curve.symbol}}}};
  if (!curve.colour.empty()) {
    trace["line"]["color"] = curve.colour;
    trace["marker"]["color"] = curve.colour;
  }
  return trace;
}

const char* ColourOf(const std::string& rule) {
  if (rule == "ids") return kBlue;
  return rule == "rays" ? kVermillion : kGreen;
}

const char* SymbolOf(const std::string& shape) {
  if (shape == "cap") return "circle";
  return shape == "half-hidden disc" ? "diamond" : "square";
}

const char* DashOf(const std::string& shape) {
  if (shape == "cap") return "solid";
  return shape == "half-hidden disc" ? "dot" : "dash";
}

}  // namespace

PlotlyFigure FigureOf(const std::vector<PlotCurve>& curves, json x_axis, json y_axis) {
  PlotlyFigure figure;
  for (const PlotCurve& curve : curves) figure.traces.push_back(TraceOf(curve));
  figure.layout = {{"xaxis", std::move(x_axis)}, {"yaxis", std::move(y_axis)}};
  return figure;
}

json LogAxisTitle(const std::string& title) {
  json axis = AxisTitle(title);
  axis["type"] = "log";
  axis["exponentformat"] = "power";
  return axis;
}

PlotCurve AreasOver(const std::string& name, const AreaRows& rows,
                    std::optional<double> AreaRow::*which) {
  PlotCurve curve{name, {}, {}};
  for (const AreaRow* row : rows) {
    if (!(row->*which)) continue;
    curve.x.push_back(row->x);
    curve.y.push_back(*(row->*which) / (kAreaSphereRadius_mm * kAreaSphereRadius_mm));
  }
  return curve;
}

PlotCurve ErrorsOfGroup(const std::string& name, const AreaRows& rows) {
  PlotCurve curve{name, {}, {}};
  for (const AreaRow* row : rows) {
    if (!row->RelError()) continue;
    curve.x.push_back(static_cast<double>(curve.x.size() + 1));
    curve.y.push_back(100.0 * *row->RelError());
  }
  return curve;
}

PlotCurve ErrorsOf(const AreaCurve& curve) {
  PlotCurve errors{curve.shape + ", " + curve.rule, {}, {}, ColourOf(curve.rule)};
  errors.dash = DashOf(curve.shape);
  errors.symbol = SymbolOf(curve.shape);
  for (const AreaCurve::Point& point : curve.points) {
    errors.x.push_back(point.x);
    errors.y.push_back(100.0 * point.rms);
  }
  return errors;
}

}  // namespace retrolux
