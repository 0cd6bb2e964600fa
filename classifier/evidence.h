// What speaks for and against a name, and the probability that follows.
#pragma once

#include "classifier/marker_fit.h"

namespace retrolux {

// Of the marker that fits a pattern best.
struct Evidence {
  bool fitted = false;
  int number = 0;          // in the set; kDecoy: something that is no marker
  int straight_edges = 0;  // of it
  // What the fit leaves over, rms over the patch, in standard deviations of the noise.
  double misfit = 100.0;
  // By how much the best fit of another shape is worse, chi-square, over the square of `misfit`.
  // kNoRival if no other was worth trying.
  double lead = kNoRival;
  double bend = 100.0;       // chi-square of the bend (MarkerFit)
  double saddle = 0.0;       // MarkerFit
  double ground_step = 0.0;  // ground_step.h
  double free_share = 1.0;   // Patch
  double white_share = 0.0;  // of the marker's pixels, how many are as bright as can be
  // Logarithm of the light in the marker's middle over that at its outline: glints have a peak.
  double peak = 0.0;
  // Smallest contrast along the outline, of the middle's: where it is next to nothing the marker
  // may go on unseen.
  double least_contrast = 1.0;
  bool torn = false;            // of bright patterns: Pattern
  double framed = 1.0;          // of dark patterns: DarkFrame; 1 if the set asks for no border
  double contrast_sigma = 0.0;  // contrast over the noise of a pixel
  double half_size_px = 0.0;    // ViewOfPlane
  double foreshortening = 0.0;  // ViewOfPlane
  double blur_px = 0.0;         // standard deviation of the blur beyond a pixel's box
  double area_px = 0.0;         // of the pattern

  static constexpr double kNoRival = 1e4;
};

// The probability that the name is right: a logistic function of the evidence, one for shapes with
// three or four edges, which cut and torn patterns imitate, one for those with more, which nothing
// imitates, and one for discs, which glints imitate. 0 beyond the limits within which they were
// fitted. docs/identification.md gives the patterns that they were fitted to and how well they
// hold. `others_log_odds`: what the sizes of the picture's other markers add (consensus.h); if
// they agree, wider limits hold.
double NameProbability(const Evidence& evidence, double others_log_odds = 0.0);

}  // namespace retrolux
