// The subcommands of `retrolux study`, a file each.
#pragma once

#include "cli/commands.h"

namespace retrolux::cli {

void SetUpStudyAreas(CLI::App& study, const GlobalOptions& global, Run& run);
void SetUpStudyHotspot(CLI::App& study, const GlobalOptions& global, Run& run);
void SetUpStudyLayout(CLI::App& study, const GlobalOptions& global, Run& run);
void SetUpStudyMarkers(CLI::App& study, const GlobalOptions& global, Run& run);
void SetUpStudyMotion(CLI::App& study, const GlobalOptions& global, Run& run);
void SetUpStudyStereo(CLI::App& study, const GlobalOptions& global, Run& run);
void SetUpStudyVault(CLI::App& study, const GlobalOptions& global, Run& run);

}  // namespace retrolux::cli
