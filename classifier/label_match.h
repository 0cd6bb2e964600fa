// Which detection belongs to which labelled marker, and what that says of it. docs/evaluation.md
// gives the reasons.
#pragma once

#include <optional>
#include <vector>

#include "classifier/detection.h"
#include "core/polygon.h"

namespace retrolux {

// A marker of which the picture shows at least a pixel.
struct LabelledShape {
  int number = 0;                   // 0: the standard marker
  Polygon hull_px;                  // convex hull of its outline, hidden parts included
  Vec2d centre_px = Vec2d::Zero();  // of the outline; decides between hulls that overlap
  bool counts = true;               // false: nobody is asked to find it
};

enum class Verdict {
  kFound,      // the name of the marker that it lies on
  kIgnored,    // so too, but the marker does not count
  kDuplicate,  // so too, but another one with more confidence lies there; a false positive
  kMisnamed,   // another name than that of the marker that it lies on, counted or not
  kNothing,    // a name where no marker is; a false positive
  kUnnamed,    // a pattern without a name
};

struct JudgedDetection {
  Verdict verdict = Verdict::kUnnamed;
  std::optional<size_t> marker;  // that it lies on
};

// What became of a marker; the first that holds.
enum class LabelOutcome {
  kFound,     // at least one detection on it has its name
  kMisnamed,  // those with names have others
  kUnnamed,   // a pattern without a name lies there
  kMissed,    // nothing does
};

struct MarkerOutcome {
  LabelOutcome outcome = LabelOutcome::kMissed;
  // The detection that decided: of those on the marker with that outcome the most confident, then
  // the one nearest to its centre.
  std::optional<size_t> detection;
  int wrong_names = 0;
};

struct PictureMatch {
  std::vector<JudgedDetection> detections;  // in the order given
  std::vector<MarkerOutcome> markers;
};

// A detection lies on the marker whose hull holds its centroid, or is nearest to it and not farther
// than `margin_px`; of several, on the one with the nearest centre.
PictureMatch MatchDetections(const std::vector<LabelledShape>& markers,
                             const std::vector<Detection>& detections, double margin_px);

}  // namespace retrolux
