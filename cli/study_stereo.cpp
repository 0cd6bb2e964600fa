// retrolux study stereo --out DIR
#include <fmt/format.h>

#include "analysis/stereo_study.h"
#include "cli/run_json.h"
#include "cli/study.h"

namespace retrolux::cli {

namespace {

struct StudyStereoCommand {
  std::filesystem::path out;
  bool quick = false;
  StereoStudyOptions study;
};

void MakeQuick(StereoStudyOptions& options) {
  options.angles_deg = {15, 30, 45, 60, 90, 120, 150};
  options.placements = 1;
  options.budget_placements = 2;
  options.shot.exposures = 4;
  options.shot.samples_per_pixel = 4;
}

std::string Text(const StereoStudy& study) {
  std::string text = "rms error of markers (mm): fitted middle | centroid; found\n";
  for (const StereoTarget target : study.options.targets) {
    for (const StereoRow* row : study.Rows(target, MarkerPoint::kCentre)) {
      const StereoRow* light = study.Row(target, MarkerPoint::kLight, row->psi_deg);
      text += fmt::format(
          "{:<6} {:6.1f} deg  {:7.4f} | {:7.4f}  {:5.1f} %\n", NameOf(target), row->psi_deg,
          row->error.rms, light->error.rms,
          100.0 * static_cast<double>(row->error.found) / static_cast<double>(row->error.expected));
    }
  }
  for (const StereoTargetLine& goal : study.goals) {
    text += fmt::format("{:<6}  {:<55} {:8.4f} {:<4} below {:g}\n", goal.Met() ? "met" : "MISSED",
                        goal.name, goal.measured, goal.unit, goal.limit);
  }
  return text;
}

int RunStudyStereo(StudyStereoCommand command, const GlobalOptions& global) {
  if (command.quick) MakeQuick(command.study);
  command.study.shot.seed = global.seed;
  const auto progress = MakeProgress(global);
  const StudyRun run(global);
  const StereoStudy study = RunStereoStudy(command.study, command.out, *progress);
  for (const std::string& warning : study.tasks.warnings) Tell(warning);
  WriteStereoStudyFiles(study, command.out);
  WriteStereoStudyReport(study, command.out, global.command_line);
  run.Write(command.out, {{"pairs", study.tasks.done_before + study.tasks.done_now},
                          {"tasks", TasksJson(study.tasks)}});
  const std::filesystem::path report = command.out / "report.html";
  nlohmann::json summary = StereoSummary(study);
  const std::string tasks = study.tasks.Text();
  PrintResult(global, summary,
              Text(study) + fmt::format("{:.1f} s{}\nreport: {}", run.Seconds(),
                                        tasks.empty() ? "" : "; " + tasks, report.string()));
  return kExitGood;
}

}  // namespace

void SetUpStudyStereo(CLI::App& study, const GlobalOptions& global, Run& run) {
  auto command = std::make_shared<StudyStereoCommand>();
  CLI::App* sub = study.add_subcommand(
      "stereo",
      "How well do two cameras place markers, over their separation? Rendered, noisy, identified "
      "pictures beside Borghese and Ferrigno's curve");
  sub->add_option("--out", command->out, "folder for the results")->required();
  StereoShotOptions& shot = command->study.shot;
  sub->add_option("--placements", command->study.placements,
                  "random places of the target at each angle")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  sub->add_option("--exposures", shot.exposures, "noisy pictures of each")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  sub->add_option("--spp", shot.samples_per_pixel,
                  "samples per pixel; four times as many at the edges of markers")
      ->check(CLI::Range(1, 1 << 16))
      ->capture_default_str();
  sub->add_option("--material", shot.material, "sheeting of the markers")->capture_default_str();
  sub->add_option("--distance", shot.distance_mm, "of the cameras from the target, mm")
      ->check(CLI::Range(500.0, 5000.0))
      ->capture_default_str();
  sub->add_flag("--quick", command->quick, "seven angles, few and noisier pictures");
  sub->callback([command, &global, &run] {
    run = [command, &global] { return RunStudyStereo(*command, global); };
  });
}

}  // namespace retrolux::cli
