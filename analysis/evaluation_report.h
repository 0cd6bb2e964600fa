// The page of an evaluation.
#pragma once

#include "analysis/evaluation_groups.h"

namespace retrolux {

// report.html. `dataset`: its folder, for the pictures.
void WriteEvaluationReport(const Evaluation& evaluation, const DatasetIndex& index,
                           const std::vector<EvaluationVariable>& variables,
                           const std::filesystem::path& dataset,
                           const std::filesystem::path& folder, const std::string& command_line);

}  // namespace retrolux
