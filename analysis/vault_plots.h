// The figures of the placement study (thesis figures 4.24 to 4.32 and what goes beyond them).
#pragma once

#include <optional>

#include "analysis/plotly_figure.h"
#include "analysis/vault_study.h"

namespace retrolux {

// Cost over the heights of the rigs, for each phi_b of phase 1: maps of theta_1 and theta_2, or
// lines where all cameras hang at one height. Nothing where the study has no grid of heights.
std::optional<PlotlyFigure> CostOverHeights(const VaultStudy& study);

// The best cost of each phi_b (figures 4.25 to 4.31). Nothing where there is one phi_b only.
std::optional<PlotlyFigure> CostOverPhiB(const VaultStudy& study);

// Costs of all orientations of one placement, in ascending order (figure 4.32).
struct CostCurve {
  std::string name;
  std::vector<double> costs;
  std::string colour;  // "": the next of the palette
  std::string dash = "solid";
};
PlotlyFigure SortedCosts(const std::vector<CostCurve>& curves);

// Optimum and runner-up, orientation by orientation (figure 4.29), of the mask that decides.
std::optional<PlotlyFigure> OptimumAgainstRunnerUp(const VaultStudy& study);

// The cost of each mask at every placement, sorted by that of the mask which is worth most
// (figure 4.24). Nothing with one mask.
std::optional<PlotlyFigure> MasksCompared(const VaultStudy& study);

// What each single move of the optimum costs, the largest at the top.
std::optional<PlotlyFigure> SensitivityBars(const VaultStudy& study);

// The best placement under each variation and what our optimum is worth there.
std::optional<PlotlyFigure> VariationLines(const VaultStudy& study);

}  // namespace retrolux
