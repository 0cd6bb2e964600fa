// Curves of the study of areas, and the figures they make.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/area_study.h"
#include "analysis/plotly_figure.h"

namespace retrolux {

struct PlotCurve {
  std::string name;
  std::vector<double> x, y;
  std::string colour = "";  // "": the next of the palette
  std::string mode = "lines+markers";
  std::string dash = "solid";
  std::string symbol = "circle";
};

PlotlyFigure FigureOf(const std::vector<PlotCurve>& curves, nlohmann::json x_axis,
                      nlohmann::json y_axis);

nlohmann::json LogAxisTitle(const std::string& title);

// One of the areas in units of the sphere's radius squared, over x, where a row has it.
PlotCurve AreasOver(const std::string& name, const AreaRows& rows,
                    std::optional<double> AreaRow::*which);

// Relative errors in % over the number in the group.
PlotCurve ErrorsOfGroup(const std::string& name, const AreaRows& rows);

// The RMS errors of `curve` in %; its colour tells the rule, dash and symbol the shape.
PlotCurve ErrorsOf(const AreaCurve& curve);

}  // namespace retrolux
