// retrolux study motion --out DIR
#include <fmt/format.h>

#include "analysis/motion_study.h"
#include "cli/run_json.h"
#include "cli/study.h"

namespace retrolux::cli {

namespace {

struct StudyMotionCommand {
  std::filesystem::path out;
  MotionStudyOptions study;
};

std::string Text(const MotionStudy& study) {
  std::string text = fmt::format("displacement: rms error {:.4f} mm, greatest {:.4f} mm\n",
                                 study.rms_error_mm, study.max_error_mm);
  if (study.alarm_s >= 0.0 && study.crossing_s >= 0.0) {
    text += fmt::format("limit {:g} mm passed at {:.3f} s, alarm at {:.3f} s: {:.0f} ms later\n",
                        study.options.limit_mm, study.crossing_s, study.alarm_s,
                        1e3 * (study.alarm_s - study.crossing_s));
  }
  text += fmt::format("{} frames with an alarm below the limit, {} without one above it\n",
                      study.false_alarms, study.missed_alarms);
  for (const HiddenOutcome& outcome : study.outcomes) {
    text += fmt::format(
        "marker {} hidden in frames {} to {}: {}, {}\n", outcome.hidden.number,
        outcome.hidden.first, outcome.hidden.last, outcome.lost ? "lost" : "missed",
        outcome.back_after_frames < 0
            ? std::string("never back")
            : fmt::format("back {} frames after it was free, {}", outcome.back_after_frames,
                          outcome.by_name ? "by identification" : "by its expected place"));
  }
  return text;
}

int RunStudyMotion(StudyMotionCommand command, const GlobalOptions& global) {
  command.study.shot.seed = global.seed;
  const auto progress = MakeProgress(global);
  const StudyRun run(global);
  const MotionStudy study = RunMotionStudy(command.study, command.out, *progress);
  for (const std::string& warning : study.tasks.warnings) Tell(warning);
  WriteMotionFiles(study, command.out);
  WriteMotionReport(study, command.out, global.command_line);
  run.Write(command.out, {{"frames", study.frames.size()},
                          {"identify_ms", study.identify_ms},
                          {"tasks", TasksJson(study.tasks)}});
  const std::filesystem::path report = command.out / "report.html";
  const std::string tasks = study.tasks.Text();
  PrintResult(global, MotionSummary(study),
              Text(study) + fmt::format("{:.1f} s{}\nreport: {}", run.Seconds(),
                                        tasks.empty() ? "" : "; " + tasks, report.string()));
  return kExitGood;
}

}  // namespace

void SetUpStudyMotion(CLI::App& study, const GlobalOptions& global, Run& run) {
  auto command = std::make_shared<StudyMotionCommand>();
  CLI::App* sub = study.add_subcommand(
      "motion",
      "A patient who breathes, drifts and coughs, watched by two cameras: displacement over time, "
      "alarm and its latency, markers that are hidden and come back");
  sub->add_option("--out", command->out, "folder for the results")->required();
  MotionStudyOptions& options = command->study;
  sub->add_option("--frames", options.frames, "pictures of each camera")
      ->check(CLI::Range(2, 100000))
      ->capture_default_str();
  sub->add_option("--rate", options.frames_per_s, "frames per second")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  sub->add_option("--limit", options.limit_mm, "alarm from this displacement on, mm")
      ->check(CLI::Range(0.01, 100.0))
      ->capture_default_str();
  sub->add_option("--angle", options.psi_deg, "separation of the cameras, degrees")
      ->check(CLI::Range(5.0, 150.0))
      ->capture_default_str();
  sub->add_option("--spp", options.shot.samples_per_pixel,
                  "samples per pixel; four times as many at the edges of markers")
      ->check(CLI::Range(1, 1 << 16))
      ->capture_default_str();
  sub->callback([command, &global, &run] {
    run = [command, &global] { return RunStudyMotion(*command, global); };
  });
}

}  // namespace retrolux::cli
