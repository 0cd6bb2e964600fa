// Identification method `robust`: every closed bright or dark outline is compared with the whole
// marker set, contour and interior, by fitting each marker to the pixels. docs/identification.md
// explains it and gives the figures. Where to read on, in the order of the work:
//   pattern.h      closed outlines at half height, as for `edges`, with wider limits, and of the
//                  steepest places, for what the light falls over
//   outline_map.h  how a marker lies in the picture; the set prepared
//   proposals.h    which markers an outline may show, in which turn
//   patch.h        the pixels that are compared
//   coverage.h     a marker as the sensor sees it
//   marker_fit.h   the fit of place, bend, blur and light
//   ground_step.h  whether something lies over the marker
//   dark_frame.h   whether a dark marker lies on a bright square of its own
//   evidence.h     what speaks for and against a name, and its probability
//   judge.h        the decision on one pattern
//   consensus.h  what the markers of a picture say of one another
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "classifier/detection.h"
#include "classifier/edges.h"
#include "classifier/evidence.h"
#include "classifier/marker_fit.h"

namespace retrolux {

struct RobustOptions {
  // What is looked at at all, as EdgesOptions. Smaller and dimmer patterns than `edges` takes, and
  // more blurred ones: the fit decides.
  double min_area_px = 40.0;
  double min_slope_sigma = 5.0;
  double min_contrast_sigma = 4.0;
  double max_edge_blur_px = 4.0;
  // Turns of each marker that are tried. More finds markers whose outline is badly torn.
  int turns = 2;
  // How far the outline may be from the best marker's, rms, beyond 0.2 px, of the root of its area.
  // Of 1400 drawn markers one was at 0.06, all others below 0.035. Larger costs time on patterns
  // that are no markers.
  double likely_outline = 0.035;
  // Hypotheses that are fitted to the pixels, at most. More find the name where noise and blur have
  // made another outline look better; each costs about 0.3 ms.
  int fits = 6;
  PatchOptions patch;
  FitOptions fit;
  // A name is given if its probability is at least this. Larger trades names for safety.
  double min_probability = 0.97;
  bool dark = true;  // whether dark shapes on bright ground are looked for, too
  // What a pixel without light reads, DN, for the centroid of the light. Unset: the darkest of the
  // smoothed picture.
  std::optional<double> black_dn;

  // InputError that names the first parameter out of its range.
  void Check() const;
};

// A pattern with all that was weighed.
struct JudgedPattern {
  Detection detection;
  bool dark = false;  // darker than its surroundings
  Polygon outline_px;
  Polygon fitted_px;         // of the marker that fits best; empty: no fit was worth trying
  Evidence evidence;         // of that marker
  double probability = 0.0;  // that it is the one
};

std::vector<JudgedPattern> JudgePatterns(const DigitalImage& image, const MarkerSet& markers,
                                         const RobustOptions& options,
                                         const std::filesystem::path* debug = nullptr);

// The patterns that lie wholly in the picture, from top to bottom, dark ones after the bright ones.
// Sees nothing but the picture; any size and depth. The same result on any number of threads; may
// be called from several threads at once.
//
// confidence = the probability that the name is right, calibrated (evidence.h); 0 without a name.
std::vector<Detection> IdentifyRobustly(const DigitalImage& image, const MarkerSet& markers,
                                        const RobustOptions& options,
                                        const std::filesystem::path* debug = nullptr);

}  // namespace retrolux
