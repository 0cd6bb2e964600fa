// The subcommands of `retrolux dataset`, and what they share.
#pragma once

#include "analysis/dataset.h"
#include "cli/commands.h"

namespace retrolux::cli {

void SetUpDatasetPlan(CLI::App& dataset, const GlobalOptions& global, Run& run);
void SetUpDatasetRun(CLI::App& dataset, const GlobalOptions& global, Run& run);
void SetUpDatasetVerify(CLI::App& dataset, const GlobalOptions& global, Run& run);  // and merge

// The positional `folder` of a planned dataset.
void AddFolder(CLI::App& sub, std::filesystem::path& folder);
// --spp and --keep-exr.
void AddRecording(CLI::App& sub, RecordChoice& recording);

nlohmann::json StateJson(const DatasetState& state);
std::string StateText(const DatasetState& state);

// dataset.json, card.md and what belongs to it. The dataset must be done. The same bytes however it
// was made.
void WriteIndexAndCard(const DatasetPlan& plan);

}  // namespace retrolux::cli
