#include "cli/study.h"

namespace retrolux::cli {

void SetUpStudy(CLI::App& app, const GlobalOptions& global, Run& run) {
  CLI::App* study =
      app.add_subcommand("study", "The studies; each writes report.html, its tables and run.json");
  SetUpStudyMarkers(*study, global, run);
  SetUpStudyLayout(*study, global, run);
  SetUpStudyVault(*study, global, run);
  SetUpStudyAreas(*study, global, run);
  SetUpStudyStereo(*study, global, run);
  SetUpStudyMotion(*study, global, run);
  SetUpStudyHotspot(*study, global, run);
}

}  // namespace retrolux::cli
