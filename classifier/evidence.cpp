#include "classifier/evidence.h"

#include <algorithm>
#include <cmath>

namespace retrolux {

namespace {

// Outside of these no pattern was named while the weights were fitted.
bool WithinLimits(const Evidence& e) {
  const bool polygon = e.straight_edges != 0;
  // Parts of other shapes, strips, glints and rings imitate these.
  const bool imitated = e.straight_edges <= 4;
  const double least_lead = imitated ? 20.0 : 5.0;
  // Seen from nearly the side any quadrilateral is anything.
  const double least_foreshortening = polygon && imitated ? 0.30 : 0.17;
  const bool covered = polygon && imitated && e.ground_step > 0.35;
  const bool alone = !imitated || e.framed > 0.3;
  const bool flat = !polygon || e.saddle < 0.12;
  return e.fitted && e.number != kDecoy && e.misfit < 4.0 && e.lead > least_lead && e.bend < 60.0 &&
         e.foreshortening > least_foreshortening && e.area_px >= 40.0 && flat && !covered &&
         alone && e.least_contrast > 0.2;
}

// Common to all: how well it fits, how far the next is, how bent it is, what lies around it, how
// it stands out.
struct Weights {
  double constant, misfit, lead, bend, ground_step, least_contrast, contrast;
};
constexpr Weights kFewEdges{1.521, -0.088, 0.676, -0.964, 0.527, -2.154, 0.071};
constexpr Weights kManyEdges{-4.351, -1.771, 2.383, 0.217, -0.558, 0.515, 0.044};
constexpr Weights kRound{0.239, -0.860, -0.433, 0.533, 1.379, -0.582, 0.134};

double Common(const Evidence& e, const Weights& w) {
  return w.constant + w.misfit * std::log(std::max(e.misfit, 0.7)) +
         w.lead * std::log(std::min(e.lead, 1000.0) / 10.0) +
         w.bend * std::min(e.bend, 30.0) / 10.0 +
         w.ground_step * std::min(std::sqrt(std::max(e.ground_step, 0.0) / 0.1), 2.0) +
         w.least_contrast * std::min(e.least_contrast, 1.0) +
         w.contrast * std::log(std::min(e.contrast_sigma, 100.0) / 10.0);
}

struct SizeWeights {
  double saddle, half_size, area;
};
constexpr SizeWeights kFewEdgesSize{-0.468, 0.829, 1.127};
constexpr SizeWeights kManyEdgesSize{-0.689, -0.032, 1.506};

double OfPolygon(const Evidence& e, const Weights& w, const SizeWeights& s) {
  return Common(e, w) + s.saddle * std::min(e.saddle, 0.1) / 0.01 +
         s.half_size * std::log(e.half_size_px / 10.0) + s.area * std::log(e.area_px / 100.0);
}

// Glints are blurred, white, or have a peak; a ring's dark middle has no ground around it.
double OfDisc(const Evidence& e) {
  constexpr double kSize = -1.411, kBlur = -3.182, kWhite = -4.607, kFree = 10.452, kPeak = -1.361;
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
