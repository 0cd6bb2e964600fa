// retrolux study areas --out DIR
#include <fmt/format.h>

#include <tuple>

#include "analysis/area_study.h"
#include "cli/picture_size.h"
#include "cli/run_json.h"
#include "cli/study.h"
#include "core/atomic_file.h"

namespace retrolux::cli {

namespace {

struct StudyAreasCommand {
  std::filesystem::path out;
  std::string size = "640x480";
  std::string visibility = "ids";
  int triangles = AreaStudyOptions().Triangles();
  AreaStudyOptions study;
};

void SetSize(const std::string& size, AreaStudyOptions& options) {
  std::tie(options.width_px, options.height_px) = ParseSize(size);
}

int LevelsOf(int triangles) {
  std::vector<std::string> possible;
  for (AreaStudyOptions options{.levels = 3}; options.levels <= 8; ++options.levels) {
    if (options.Triangles() == triangles) return options.levels;
    possible.push_back(std::to_string(options.Triangles()));
  }
  throw InputError(
      fmt::format("--triangles {}; expected one of {}", triangles, JoinNames(possible)));
}

std::string Text(const AreaStudy& study) {
  std::string text;
  for (const AreaTarget& target : study.targets) {
    const std::string aim = target.aim == 0.0
                                ? fmt::format("below {:g}", target.tolerance)
                                : fmt::format("{:.4g} +- {:g}", target.aim, target.tolerance);
    text += fmt::format("{:<6}  {:<58} {:10.4f} {:<6} {}\n", target.Met() ? "met" : "MISSED",
                        target.name, target.measured, target.unit, aim);
  }
  return text;
}

int RunStudyAreas(StudyAreasCommand command, const GlobalOptions& global) {
  SetSize(command.size, command.study);
  command.study.levels = LevelsOf(command.triangles);
  command.study.rule = VisibilityRuleNamed(command.visibility);
  command.study.seed = global.seed;
  const auto progress = MakeProgress(global);
  const StudyRun run(global);
  const AreaStudy study = RunAreaStudy(command.study, command.out, *progress);
  for (const std::string& warning : study.tasks.warnings) Tell(warning);
  WriteAreaFiles(study, command.out);
  WriteAreaReport(study, command.out, global.command_line);
  run.Write(command.out, {{"areas", study.rows.size()}, {"tasks", TasksJson(study.tasks)}});
  const std::filesystem::path report = command.out / "report.html";
  nlohmann::json summary = AreaSummary(study);
  summary["report"] = report.string();
  summary["seconds"] = run.Seconds();
  const std::string tasks = study.tasks.Text();
  PrintResult(
      global, summary,
      Text(study) + fmt::format("{} areas in {:.1f} s{}\nreport: {}", study.rows.size(),
                                run.Seconds(), tasks.empty() ? "" : "; " + tasks, report.string()));
  return kExitGood;
}

}  // namespace

void SetUpStudyAreas(CLI::App& study, const GlobalOptions& global, Run& run) {
  auto command = std::make_shared<StudyAreasCommand>();
  CLI::App* sub = study.add_subcommand(
      "areas", "Are the areas that cameras see right? Against closed forms (thesis section 4.6)");
  sub->add_option("--out", command->out, "folder for the results")->required();
  sub->add_option("--size", command->size, "pixels of the cameras, same field of view")
      ->capture_default_str();
  sub->add_option("--visibility", command->visibility,
                  "what hides a part of a mask from a camera: ids (its id buffer), rays, or "
                  "triangles (the thesis's rule, whole triangles)")
      ->check(CLI::IsMember({"ids", "rays", "triangles"}))
      ->capture_default_str();
  sub->add_option("--triangles", command->triangles, "of the sphere: 20 times a power of 4")
      ->capture_default_str();
  sub->add_option("--sample-area", command->study.part_area_mm2,
                  "mm2 of the sphere that one sample stands for, at most")
      ->check(CLI::Range(5e-3, 1e4))
      ->capture_default_str();
  sub->callback([command, &global, &run] {
    run = [command, &global] { return RunStudyAreas(*command, global); };
  });
}

}  // namespace retrolux::cli
