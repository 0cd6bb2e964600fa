// What a method has to reach, in named rows.
#pragma once

#include <functional>

#include "analysis/evaluation_scores.h"

namespace retrolux {

// Some of the markers, by what is true of them.
struct MarkerCondition {
  std::string name;
  std::function<bool(const EvaluatedMarker&)> holds;
};

// For comparing methods: all, and those that have to be found.
std::vector<MarkerCondition> PairedConditions(const EvaluationLimits& limits);

struct EvaluationTarget {
  std::string measure;              // found, misnamed, wrong names, centroid rms, centroid bias
  std::string markers;              // which of those that count
  std::string unit;                 // "1" or "px"
  std::optional<Proportion> share;  // of which the value is, with its interval
  std::optional<double> value;      // nothing: there is nothing to measure
  double aim = 0.0;  // found: at least; of wrong names the interval's end; else below
  bool met = false;
};
std::vector<EvaluationTarget> TargetsOf(const Evaluation& evaluation, const MethodResult& method);

}  // namespace retrolux
