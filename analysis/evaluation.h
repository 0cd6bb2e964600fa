// How well methods find and name the markers of a dataset: each labelled marker beside what each
// method says of it. docs/evaluation.md defines the words.
#pragma once

#include "analysis/dataset.h"
#include "classifier/error_statistics.h"
#include "classifier/label_match.h"

namespace retrolux {

// All limits of the evaluation.
struct EvaluationLimits {
  // A detection lies on a marker if its centroid is in the convex hull of the marker's outline or
  // at most this far from it, px. The hull is that of pixel centres, half a pixel too small.
  double margin_px = 2.0;
  // Markers of which less is visible are not asked for: what is left can be another marker's shape.
  double min_visible_fraction = 0.5;
  // What counts as wholly visible, if the whole outline is in the picture, too. Below 1, because
  // the surface is sampled.
  double whole_fraction = 0.99;
  // From this incidence on a marker has a direction of tilt in the picture, deg.
  double min_tilt_deg = 10.0;
  // The markers that have to be found: size at least, px; incidence below, deg.
  double target_size_px = 20.0;
  double target_incidence_deg = 60.0;
  double target_steep_incidence_deg = 70.0;
  // A nuisance with more different values than `values` is cut into `parts` with as many pictures.
  int values = 8;
  int parts = 5;
};

struct EvaluatedPicture {
  const DatasetScene* scene = nullptr;
  const DatasetPicture* picture = nullptr;
  size_t first_marker = 0, marker_count = 0;  // its part of Evaluation::markers
};

// A labelled marker of which a pixel shows, in one picture.
struct EvaluatedMarker {
  size_t picture = 0;
  const MarkerLabel* label = nullptr;
  LabelledShape shape;
  bool whole = false;           // visible, and the outline in the picture
  double frame_position = 0.0;  // distance from the picture's middle over half its diagonal
  std::optional<Vec2d> tilt;    // as in PlaceError
};

struct MarkerResult {
  MarkerOutcome match;
  // If it was found: against the centroid that its polarity has (bright: radiometric, dark:
  // outline), against the outline's, and the visible corners'.
  std::optional<PlaceError> centroid, outline;
  std::vector<PlaceError> corners;
};

struct MethodResult {
  std::string method;
  std::vector<std::vector<Detection>> detections;      // of each picture
  std::vector<std::vector<JudgedDetection>> verdicts;  // likewise
  std::vector<MarkerResult> markers;                   // of each marker of the evaluation
};

// Points into the index that it was made of.
struct Evaluation {
  EvaluationLimits limits;
  std::string split;
  std::vector<EvaluatedPicture> pictures;
  std::vector<EvaluatedMarker> markers;  // picture by picture
  std::vector<MethodResult> methods;

  const std::vector<Detection>& DetectionsAt(const MethodResult& method, size_t marker) const {
    return method.detections[markers[marker].picture];
  }
};

// Pictures and markers of a split (`all`: of all), without methods. InputError if it has no
// picture.
Evaluation PrepareEvaluation(const DatasetIndex& index, const std::string& split,
                             const EvaluationLimits& limits);

// `detections`: of each picture of the evaluation.
MethodResult ScoreMethod(const Evaluation& evaluation, const std::string& method,
                         std::vector<std::vector<Detection>> detections);

// "standard", or the number.
std::string MarkerName(int number);

}  // namespace retrolux
