// The figures of merit of a method on some of the markers and pictures.
#pragma once

#include "analysis/evaluation.h"
#include "classifier/proportion.h"

namespace retrolux {

// A choice of what is evaluated, by number in the evaluation.
struct EvaluationChoice {
  std::vector<size_t> markers;
  std::vector<size_t> pictures;  // whose false positives belong to it; empty: markers only
  bool all_markers = false;      // hardly visible ones count, too
};
EvaluationChoice Everything(const Evaluation& evaluation);

struct Scores {
  int64_t pictures = 0;
  int64_t markers = 0;          // that count
  int64_t found = 0;            // of them
  int64_t misnamed = 0;         // detections with another name than that of the marker under them
  int64_t false_positives = 0;  // names where no marker is, and duplicates
  int64_t duplicates = 0;       // of these
  int64_t ignored = 0;          // right names on markers that do not count
  int64_t unnamed = 0;          // patterns without a name, on a marker or not
  PlaceErrors centroid, outline, corners;  // of those found; corners: of corners, not markers

  int64_t Named() const { return found + misnamed + false_positives; }
  Proportion Recall() const { return {found, markers}; }
  Proportion Precision() const { return {found, Named()}; }
  Proportion Misnamed() const { return {misnamed, Named()}; }
  Proportion WrongNames() const { return {misnamed + false_positives, Named()}; }
  std::optional<double> F1() const;  // harmonic mean of precision and recall
};
Scores ScoresOf(const Evaluation& evaluation, const MethodResult& method,
                const EvaluationChoice& choice);

// Detections and missed markers by what is there (rows: the classes, then "nothing") and what is
// said of it (columns: the classes, then "unnamed": a pattern without a name, and "none").
struct Confusion {
  std::vector<std::string> truth, named;
  std::vector<std::vector<int64_t>> counts;
};
Confusion ConfusionOf(const Evaluation& evaluation, const MethodResult& method);

// What two methods find of the same markers.
struct PairedResult {
  std::string first, second, markers;  // methods; which markers
  int64_t both = 0, first_only = 0, second_only = 0, neither = 0;

  double P() const { return McNemarExactP(first_only, second_only); }
};
// Every method with each that follows it: on all markers, and on those that have to be found.
std::vector<PairedResult> PairedResults(const Evaluation& evaluation);

}  // namespace retrolux
