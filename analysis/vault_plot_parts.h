// What the figures of the placement study share.
#pragma once

#include <string>
#include <vector>

#include "analysis/plotly_figure.h"
#include "analysis/vault_study.h"

namespace retrolux {

inline constexpr const char* kCostTitle = "cost (dm²)";

// As many digits as a reader can use; files keep them all.
double RoundedCost(double cost);

// Angles that differ by rounding only are one.
double RoundedAngle(double deg);

// What is shown where the mouse points at a placement.
std::string HoverOf(const PlacementResult& result);

// A placement that is marked in a figure.
struct PlacementMark {
  std::string name;
  const PlacementResult* result;
  nlohmann::json marker;
};

// Our optimum, then the thesis's placements. They point into the study.
std::vector<PlacementMark> MarksOf(const VaultStudy& study);

// The mark at (x, y) of a scatter plot.
nlohmann::json TraceOf(const PlacementMark& mark, double x, double y);

}  // namespace retrolux
