#include "classifier/evidence.h"

#include <algorithm>
#include <cmath>

namespace retrolux {

namespace {

// Log odds from which on a size agrees with the others'.
constexpr double kAgrees = 1.0;

// Outside of these nothing is named. A pattern whose size is that of the picture's other markers
// (`same_size`) has to answer less; not a triangle, whose three sizes agree with any too easily.
bool WithinLimits(const Evidence& e, bool same_size) {
  const bool agrees = same_size && e.straight_edges != 3;
  const bool round = e.straight_edges == 0;
  // Parts of other shapes, strips, glints and rings imitate these.
  const bool imitated = e.straight_edges <= 4;
  const double least_lead = imitated && !agrees ? 20.0 : 5.0;
  // Seen from nearly the side any quadrilateral is anything.
  const double least_foreshortening = round ? 0.17 : !imitated ? 0.20 : agrees ? 0.25 : 0.30;
  // What a cable cuts off a bright square is a triangle, too; of 3,797 discs one was above 0.5.
  const bool cut =
      round ? e.ground_step > 0.8 : imitated && !agrees && (e.ground_step > 0.35 || e.torn);
  // Dark triangles are seen between things; a dark disc of the right size is a bright one at an
  // angle at which it sends less than the mask.
  const bool alone = !imitated || e.framed > 0.3 || (round && agrees);
  const bool flat = round || e.saddle < (agrees ? 0.25 : 0.12);
  // A nose bends like this, and a marker goes on unseen where it is as bright as the ground: both
  // are believed if nothing else looks like it.
  const bool sole = agrees && e.lead > 5000.0;
  const bool bent = e.bend > (sole ? 300.0 : 40.0);
  const double least_contrast = !agrees ? 0.2 : !sole ? 0.05 : imitated ? -0.15 : -0.4;
  // A ring of diodes, and the dark in its middle.
  const bool ring = round && (e.least_contrast > 2.0 || e.free_share < 0.45);
  return e.fitted && e.number != kDecoy && e.misfit < 4.0 && e.lead > least_lead &&
         e.foreshortening > least_foreshortening && e.area_px >= 40.0 && flat && !bent && !cut &&
         !ring && alone && e.least_contrast > least_contrast;
}

// Common to all: how well it fits, how far the next is, how bent it is, what lies around it, how
// it stands out. 0 where the patterns at hand asked for a sign that makes no sense.
struct Weights {
  double constant, misfit, lead, bend, ground_step, least_contrast, contrast;
};
constexpr Weights kFewEdges{-0.254, -1.204, 0.619, -0.941, 0.0, -0.453, 0.293};
constexpr Weights kManyEdges{-3.213, -1.496, 1.501, -0.081, -0.076, 1.206, 0.727};
constexpr Weights kRound{4.498, 0.0, 0.121, 0.0, 0.0, 4.105, -0.251};

// A bend beyond `most_bend` says no more.
double Common(const Evidence& e, const Weights& w, double most_bend) {
  return w.constant + w.misfit * std::log(std::max(e.misfit, 0.7)) +
         w.lead * std::log(std::min(e.lead, 1000.0) / 10.0) +
         w.bend * std::min(e.bend, most_bend) / 10.0 +
         w.ground_step * std::min(std::sqrt(std::max(e.ground_step, 0.0) / 0.1), 2.0) +
         w.least_contrast * std::min(e.least_contrast, 1.0) +
         w.contrast * std::log(std::min(e.contrast_sigma, 100.0) / 10.0);
}

// Sizes beyond these, px and px2, were in no picture that the weights were fitted to.
constexpr double kLargestHalf_px = 30.0, kLargestArea_px2 = 1500.0;
struct SizeWeights {
  double saddle, half_size, area;
};
constexpr SizeWeights kFewEdgesSize{-0.360, 0.263, 1.334};
constexpr SizeWeights kManyEdgesSize{-0.720, 2.199, 1.840};

double OfPolygon(const Evidence& e, const Weights& w, const SizeWeights& s, double most_bend) {
  return Common(e, w, most_bend) + s.saddle * std::min(e.saddle, 0.1) / 0.01 +
         s.half_size * std::log(std::min(e.half_size_px, kLargestHalf_px) / 10.0) +
         s.area * std::log(std::min(e.area_px, kLargestArea_px2) / 100.0);
}

// Glints are blurred, white, or have a peak; a ring's dark middle has no ground around it.
double OfDisc(const Evidence& e) {
  constexpr double kSize = -1.783, kBlur = -3.244, kWhite = -6.060, kFree = 2.043, kPeak = -0.521;
  const double narrow_px = e.half_size_px * e.foreshortening;
  return Common(e, kRound, 0.0) + kSize * std::log(narrow_px / 5.0) +
         kBlur * 10.0 * std::min(e.blur_px / narrow_px, 0.5) + kWhite * e.white_share +
         kFree * std::min(e.free_share, 0.7) / 0.7 +
         kPeak * std::clamp(std::abs(e.peak) - 0.03, 0.0, 0.2) / 0.1;
}

}  // namespace

double NameProbability(const Evidence& e, double others_log_odds) {
  const bool agrees = others_log_odds > kAgrees;
  if (!WithinLimits(e, agrees)) return 0.0;
  const double most_bend = agrees ? 10.0 : 30.0;
  const double sum = e.straight_edges == 0   ? OfDisc(e)
                     : e.straight_edges <= 4 ? OfPolygon(e, kFewEdges, kFewEdgesSize, most_bend)
                                             : OfPolygon(e, kManyEdges, kManyEdgesSize, most_bend);
  return 1.0 / (1.0 + std::exp(-sum - others_log_odds));
}

}  // namespace retrolux
