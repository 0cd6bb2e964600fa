#include "classifier/evidence.h"

#include <algorithm>
#include <cmath>

namespace retrolux {

namespace {

// Outside of these no pattern was named while the weights were fitted.
bool WithinLimits(const Evidence& e) {
  // Parts of other shapes, glints and rings imitate these.
  const bool imitated = e.straight_edges <= 4;
  const double least_lead = imitated ? 20.0 : 5.0;
  const bool seen = !imitated || e.least_contrast > 0.2;
  const bool flat = e.straight_edges == 0 || e.saddle < 0.04;
  return e.fitted && e.number != kDecoy && e.misfit < 2.5 && e.lead > least_lead && e.bend < 30.0 &&
         e.foreshortening > 0.17 && e.area_px >= 40.0 && flat && seen;
}

// Common to all: how well it fits, how far the next is, how bent it is, what lies around it.
struct Weights {
  double constant, misfit, lead, bend, ground_step;
};
constexpr Weights kFewEdges{3.624, -0.043, -0.034, -1.054, -1.287};
constexpr Weights kManyEdges{-1.012, -0.992, 2.318, -1.515, -0.496};
constexpr Weights kRound{-0.084, -3.790, -0.471, -0.070, 1.503};

double Common(const Evidence& e, const Weights& w) {
  return w.constant + w.misfit * std::log(std::max(e.misfit, 0.7)) +
         w.lead * std::log(std::min(e.lead, 1000.0) / 10.0) +
         w.bend * std::min(e.bend, 20.0) / 10.0 +
         w.ground_step * std::min(std::sqrt(std::max(e.ground_step, 0.0) / 0.1), 2.0);
}

struct SizeWeights {
  double saddle, half_size, area;
};
constexpr SizeWeights kFewEdgesSize{-0.785, 0.339, 0.641};
constexpr SizeWeights kManyEdgesSize{-0.278, -0.198, 0.138};

double OfPolygon(const Evidence& e, const Weights& w, const SizeWeights& s) {
  return Common(e, w) + s.saddle * std::min(e.saddle, 0.04) / 0.01 +
         s.half_size * std::log(e.half_size_px / 10.0) + s.area * std::log(e.area_px / 100.0);
}

// Glints are blurred, white, or have a peak; a ring's dark middle has no ground around it.
double OfDisc(const Evidence& e) {
  constexpr double kSize = -1.526, kBlur = -2.158, kWhite = -5.481, kFree = 9.758, kPeak = -2.170;
  const double narrow_px = e.half_size_px * e.foreshortening;
  return Common(e, kRound) + kSize * std::log(narrow_px / 5.0) +
         kBlur * 10.0 * std::min(e.blur_px / narrow_px, 0.5) + kWhite * e.white_share +
         kFree * std::min(e.free_share, 0.7) / 0.7 +
         kPeak * std::clamp(std::abs(e.peak) - 0.03, 0.0, 0.2) / 0.1;
}

}  // namespace

double NameProbability(const Evidence& e) {
  if (!WithinLimits(e)) return 0.0;
  const double sum = e.straight_edges == 0   ? OfDisc(e)
                     : e.straight_edges <= 4 ? OfPolygon(e, kFewEdges, kFewEdgesSize)
                                             : OfPolygon(e, kManyEdges, kManyEdgesSize);
  return 1.0 / (1.0 + std::exp(-sum));
}

}  // namespace retrolux
