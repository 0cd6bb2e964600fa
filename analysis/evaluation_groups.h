// The markers of an evaluation by what they, and their pictures, are like.
#pragma once

#include "analysis/evaluation_scores.h"

namespace retrolux {

struct EvaluationGroup {
  // A value, or numbers from `from` to below `to` (the last of quantiles: to and with it).
  nlohmann::json value;
  std::optional<double> from, to;
  bool is_range = false;
  EvaluationChoice choice;

  std::string Label() const;  // "20 to 25", "retro_bead", "none"
};

struct EvaluationVariable {
  std::string name;        // key in evaluation.json; of the dataset's nuisances "scene.NAME"
  std::string title;       // with its unit, for people
  bool of_scenes = false;  // whose groups have false positives, too
  std::vector<EvaluationGroup> groups;  // those that hold a marker or a picture, in order
};

// Properties of the markers, then the nuisances of their scenes, which have false positives, too.
std::vector<EvaluationVariable> EvaluationVariables(const Evaluation& evaluation);

}  // namespace retrolux
