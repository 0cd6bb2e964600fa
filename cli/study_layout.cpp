// retrolux study layout --out DIR
#include <fmt/format.h>

#include "analysis/layout_study.h"
#include "analysis/marker_study.h"
#include "classifier/method.h"
#include "cli/command_tree.h"
#include "cli/run_json.h"
#include "cli/study.h"
#include "scenes/scene_json.h"

namespace retrolux::cli {

namespace {

struct StudyLayoutCommand {
  std::filesystem::path out;
  std::string scene = "ct-room";
  std::vector<std::string> poses = {"scan"};
  LayoutStudyOptions study;
};

constexpr double kScanStep_mm = 5.0;  // of the couch (thesis 3.2.2)

std::string Text(const LayoutStudy& study, const std::filesystem::path& report) {
  std::string text;
  for (const MarkerSpec& m : study.markers)
    text +=
        fmt::format("{}  at {:7.1f} {:7.1f} {:7.1f} mm\n", m.name, m.at.x(), m.at.y(), m.at.z());
  double position = 0.0, rotation = 0.0;
  int without = 0;
  for (size_t p = 0; p < study.options.poses.size(); ++p) {
    const LayoutPair& best = study.Best(p);
    position = std::max(position, best.position_error_mm.value_or(0.0));
    rotation = std::max(rotation, best.rotation_error_deg.value_or(0.0));
    without += !best.position_error_mm;
  }
  text += fmt::format(
      "{} poses: the best pair names {} or more in common, {} beyond the three that a pose needs; "
      "{} misnamed\nlargest error of the mask's pose {:.3f} mm, {:.3f} deg; no pose in {}\n",
      study.options.poses.size(), study.Margin() + 3, study.Margin(), study.misnamed, position,
      rotation, without);
  const std::string tasks = study.tasks.Text();
  return text + (tasks.empty() ? "" : tasks + "\n") + "report: " + report.string();
}

int RunStudyLayout(StudyLayoutCommand command, const GlobalOptions& global) {
  const Scene scene = LoadScene(command.scene);
  MethodByName(command.study.method);
  if (command.poses == std::vector<std::string>{"scan"}) {
    command.study.poses = ScanPoses(scene, kScanStep_mm);
  } else {
    for (const std::string& name : command.poses)
      command.study.poses.push_back(scene.AtPose(name).poses.front());
  }
  command.study.seed = command.study.layout.seed = global.seed;
  const auto progress = MakeProgress(global);
  const StudyRun run(global);
  const LayoutStudy study = RunLayoutStudy(scene, command.study, command.out, *progress);
  for (const std::string& warning : study.tasks.warnings) Tell(warning);
  WriteLayoutFiles(study, command.out);
  WriteLayoutReport(study, scene, command.out, global.command_line);
  run.Write(command.out,
            {{"poses", study.options.poses.size()}, {"tasks", TasksJson(study.tasks)}});
  const std::filesystem::path report = command.out / "report.html";
  nlohmann::json summary = LayoutSummary(study);
  summary["report"] = report.string();
  PrintResult(global, summary, Text(study, report));
  return kExitGood;
}

}  // namespace

void SetUpStudyLayout(CLI::App& study, const GlobalOptions& global, Run& run) {
  auto command = std::make_shared<StudyLayoutCommand>();
  CLI::App* sub = study.add_subcommand(
      "layout", "Where do six markers go so that a pair of cameras names three in every pose?");
  sub->footer(
      "Searches the places, renders all markers at once in every pose, names them in the noisy\n"
      "pictures, and counts what pairs of cameras have in common.");
  sub->add_option("--out", command->out, "folder for the results")->required();
  sub->add_option("--scene", command->scene,
                  "a room with an object 'mask' that moves with the pose")
      ->capture_default_str();
  sub->add_option("--mask", command->study.mask, "what lies there: oval or face")
      ->check(CLI::IsMember({"oval", "face"}))
      ->capture_default_str();
  sub->add_option("--poses", command->poses,
                  "names of poses, or 'scan': every 5 mm from start to end")
      ->delimiter(',')
      ->capture_default_str();
  sub->add_option("--method", command->study.method, "how markers are identified")
      ->type_name(ChoiceType(MethodNames()))
      ->capture_default_str();
  sub->add_option("--material", command->study.material, "what the markers are made of")
      ->capture_default_str();
  sub->add_option("--max-incidence", command->study.layout.sight.max_incidence_deg,
                  "deg; the search counts on a marker that faces a camera to within this all over")
      ->check(CLI::Range(5.0, 85.0))
      ->capture_default_str();
  sub->add_option("--max-fall", command->study.layout.sight.max_fall,
                  "and on which the ring's light falls by at most this factor")
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str();
  sub->add_option("--min-separation", command->study.layout.min_separation_deg,
                  "deg; pairs of cameras that stand closer do not count")
      ->check(CLI::Range(1.0, 170.0))
      ->capture_default_str();
  sub->add_option("--spp", command->study.samples_per_pixel,
                  "samples per pixel; four times as many at edges of markers")
      ->check(CLI::Range(1, 1 << 16))
      ->capture_default_str();
  sub->callback([command, &global, &run] {
    run = [command, &global] { return RunStudyLayout(*command, global); };
  });
}

}  // namespace retrolux::cli
