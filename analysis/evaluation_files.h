// The files of an evaluation: evaluation.json (`retrolux/evaluation-1`), misses.csv and
// false_positives.csv.
#pragma once

#include "analysis/evaluation_groups.h"

namespace retrolux {

// The first method's figures at the top, the others' in the same form under `compared`. The same
// dataset and detections give the same bytes.
nlohmann::ordered_json EvaluationJson(const Evaluation& evaluation, const DatasetIndex& index,
                                      const std::vector<EvaluationVariable>& variables);

void WriteEvaluationFiles(const Evaluation& evaluation, const DatasetIndex& index,
                          const std::vector<EvaluationVariable>& variables,
                          const std::filesystem::path& folder);

}  // namespace retrolux
