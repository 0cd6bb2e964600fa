// The figures of an evaluation.
#pragma once

#include "analysis/evaluation_groups.h"
#include "analysis/plotly_figure.h"

namespace retrolux {

// Share found over a variable, with its 95 % intervals, a trace for each method.
PlotlyFigure RecallFigure(const Evaluation& evaluation, const EvaluationVariable& variable);

// Centroid errors over a variable: rms with crosses, length of the mean with its standard error.
PlotlyFigure CentroidFigure(const Evaluation& evaluation, const EvaluationVariable& variable);

// Rows: what is there; columns: what is said of it; the numbers written in, coloured by their share
// of the row.
PlotlyFigure ConfusionFigure(const Confusion& confusion);

// Histograms of the centroids' errors along u and v and the tilt, px.
PlotlyFigure ErrorHistogram(const Evaluation& evaluation, const MethodResult& method);

}  // namespace retrolux
