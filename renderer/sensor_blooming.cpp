#include "renderer/sensor_blooming.h"

#include <algorithm>

namespace retrolux {

namespace {

// Slopes of the greatest convex function below the points (i, g[i]), between i and i + 1.
std::vector<double> HullSlopes(const std::vector<double>& g) {
  std::vector<size_t> corners;
  for (size_t i = 0; i < g.size(); ++i) {
    while (corners.size() > 1) {
      const size_t b = corners.back(), a = corners[corners.size() - 2];
      const double before = (g[b] - g[a]) * static_cast<double>(i - b);
      const double after = (g[i] - g[b]) * static_cast<double>(b - a);
      if (before < after) break;  // b is below the line from a to i
      corners.pop_back();
    }
    corners.push_back(i);
  }
  std::vector<double> slopes;
  for (size_t c = 1; c < corners.size(); ++c) {
    const size_t a = corners[c - 1], b = corners[c];
    slopes.insert(slopes.end(), b - a, (g[b] - g[a]) / static_cast<double>(b - a));
  }
  return slopes;
}

// Let u_i be what well i gave to either neighbour in all, and g a function whose second difference
// is the room, g'' = W - s. Then the charge at the end is s + u'' = W - (g - u)''. It is at most W,
// and W where u > 0. So h = g - u is convex, nowhere above g, and straight where it is below g: the
// greatest convex function below g. Walls that nothing crosses give u the slope 0 at both ends, so
// h has the slopes there that g has, 0 and `end`, and none beyond them.
void LevelColumn(std::vector<double>& charge_e, double full_well_e) {
  std::vector<double> g;
  double value = 0.0, slope = 0.0;
  for (const double s : charge_e) {
    g.push_back(value);
    slope += full_well_e - s;
    value += slope;
  }
  const double end = slope;
  if (end <= 0.0) {  // more charge than the column holds
    std::fill(charge_e.begin(), charge_e.end(), full_well_e);
    return;
  }
  std::vector<double> slopes = HullSlopes(g);
  slopes.push_back(end);
  double before = 0.0;
  for (size_t i = 0; i < charge_e.size(); ++i) {
    const double after = std::clamp(slopes[i], 0.0, end);
    charge_e[i] = full_well_e - (after - before);
    before = after;
  }
}

}  // namespace

void Bloom(const Blooming& blooming, double full_well_e, Plane<double>& charge_e) {
  std::vector<double> column(static_cast<size_t>(charge_e.height));
  for (int x = 0; x < charge_e.width; ++x) {
    bool overflows = false;
    for (int y = 0; y < charge_e.height; ++y) {
      const double excess = charge_e(x, y) - full_well_e;
      overflows = overflows || excess > 0.0;
      column[static_cast<size_t>(y)] = charge_e(x, y) - std::max(0.0, excess) * blooming.drained;
    }
    if (!overflows) continue;
    LevelColumn(column, full_well_e);
    for (int y = 0; y < charge_e.height; ++y) charge_e(x, y) = column[static_cast<size_t>(y)];
  }
}

}  // namespace retrolux
