// The number of straight edges of a closed outline.
#pragma once

#include <optional>
#include <vector>

#include "core/polygon.h"

namespace retrolux {

struct PolygonFitLimits {
  int max_edges = 8;
  double straight_px =
      0.15;  // an edge's rms distance from its line may be straight_px + bend * length
  double bend = 0.012;
  double min_edge_px = 2.5;
  double min_turn_rad = 0.26;  // change of direction at a corner
};

struct PolygonFit {
  Polygon corners;      // where the lines of neighbouring edges meet, in the order of the outline
  double misfit = 0.0;  // of the worst edge: rms distance over its limit; at most 1
  double gain = 0.0;    // the same with one edge less, over misfit
};

// Of all numbers of edges whose best fit keeps the limits and whose edges meet near the outline,
// the one that gains most over one edge less: the last true corner gains much, a corner put on an
// edge nothing. Nothing if there is none. On a disc k edges gain (k / (k - 1))^2, at most 1.8 for k
// > 3. `outline`: points at equal steps of `step_px`.
std::optional<PolygonFit> FitPolygon(const Polygon& outline, double step_px,
                                     const PolygonFitLimits& limits);

}  // namespace retrolux
