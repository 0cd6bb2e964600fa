// retrolux study markers --out DIR
#include <fmt/format.h>

#include "analysis/marker_coverage.h"
#include "analysis/marker_study_gain.h"
#include "cli/run_json.h"
#include "cli/study.h"
#include "scenes/scene_json.h"

namespace retrolux::cli {

namespace {

struct StudyMarkersCommand {
  std::filesystem::path out;
  std::string scene = "ct-room";
  std::vector<std::string> poses = {"reference", "start", "end"};
  std::string keep = "samples";
  MarkerStudyOptions study;
};

constexpr double kScanStep_mm = 5.0;  // of the couch (thesis 3.2.2)

std::vector<Pose> ChosenPoses(const Scene& scene, const std::vector<std::string>& names) {
  if (names == std::vector<std::string>{"scan"}) return ScanPoses(scene, kScanStep_mm);
  std::vector<Pose> poses;
  for (const std::string& name : names) poses.push_back(scene.AtPose(name).poses.front());
  return poses;
}

// Of the pictures of hits.csv, those that this run has made: all tasks have the same number.
double PicturesNow(const MarkerStudy& study) {
  const auto tasks = static_cast<double>(study.tasks.done_before + study.tasks.done_now);
  return static_cast<double>(study.results.size()) * static_cast<double>(study.tasks.done_now) /
         tasks;
}

nlohmann::json Figures(const MarkerStudy& study, double seconds) {
  const MarkerStudy::Times& t = study.times;
  return {{"pictures", study.results.size()},
          {"pictures_rendered", study.composed},
          {"pictures_per_minute", 60.0 * PicturesNow(study) / seconds},
          {"tasks", TasksJson(study.tasks)},
          {"times",
           {{"background_wall", t.background},
            {"pictures_wall", t.pictures},
            {"geometry", t.geometry},
            {"trace", t.trace},
            {"sensor", t.sensor},
            {"identify", t.identify},
            {"write", t.write}}}};
}

std::string Text(const MarkerStudy& study, const StudyCoverage& coverage,
                 const std::filesystem::path& report, double seconds) {
  std::string text;
  for (const CellSet& set : coverage.Sets()) {
    if (set.name != "satisfies" && set.name != "all" && set.name != "expanded") continue;
    if (study.poses.size() > 3) continue;
    text += fmt::format("marker {}  {:<10} {:<10} {:6.2f} %  {:8.0f} mm2\n", set.marker, set.name,
                        set.pose, set.percent, set.area_mm2);
  }
  if (const auto gain = GainOverEdges(study, coverage)) {
    text += fmt::format("named by both {}, only by {} {}, only by edges {}\n", gain->both,
                        study.options.method, gain->only_method, gain->only_edges);
  }
  text += fmt::format("{:.0f} pictures in {:.1f} s ({:.0f} a minute)", PicturesNow(study), seconds,
                      60.0 * PicturesNow(study) / seconds);
  const std::string tasks = study.tasks.Text();
  return text + (tasks.empty() ? "" : "; " + tasks) + "\nreport: " + report.string();
}

int RunStudyMarkers(StudyMarkersCommand command, const GlobalOptions& global) {
  const Scene scene = LoadScene(command.scene);
  command.study.poses = ChosenPoses(scene, command.poses);
  command.study.seed = global.seed;
  command.study.noise_seed = global.NoiseSeed();
  command.study.keep = command.keep == "all"      ? Keep::kAll
                       : command.keep == "misses" ? Keep::kMisses
                                                  : Keep::kSamples;
  const auto progress = MakeProgress(global);
  const StudyRun run(global);
  const MarkerStudy study = RunMarkerStudy(scene, command.study, command.out, *progress);
  for (const std::string& warning : study.tasks.warnings) Tell(warning);
  const StudyCoverage coverage(study);
  WriteStudyFiles(study, coverage, command.out);
  WriteStudyReport(study, coverage, scene, command.out, global.command_line);
  const double seconds = run.Seconds();
  run.Write(command.out, Figures(study, seconds));
  nlohmann::json summary = StudySummary(study, coverage);
  summary["report"] = (command.out / "report.html").string();
  summary["seconds"] = seconds;
  PrintResult(global, summary, Text(study, coverage, command.out / "report.html", seconds));
  return kExitGood;
}

}  // namespace

void SetUpStudyMarkers(CLI::App& study, const GlobalOptions& global, Run& run) {
  auto command = std::make_shared<StudyMarkersCommand>();
  CLI::App* sub = study.add_subcommand(
      "markers", "Where on the mask do the CT room's cameras identify markers? (thesis chapter 3)");
  sub->add_option("--out", command->out, "folder for the results")->required();
  sub->add_option("--scene", command->scene,
                  "a room with an object 'mask' and front... and back... cameras")
      ->capture_default_str();
  sub->add_option("--markers", command->study.markers, "numbers of the marker set")
      ->delimiter(',')
      ->capture_default_str();
  sub->add_option("--poses", command->poses,
                  "names of poses, or 'scan': every 5 mm from start to end")
      ->delimiter(',')
      ->capture_default_str();
  sub->add_option(
         "--method", command->study.method,
         "how markers are identified; with robust, the gain over edges in the same pictures")
      ->check(CLI::IsMember({kEdgesMethod, kRobustMethod}))
      ->capture_default_str();
  sub->add_option("--spp", command->study.samples_per_pixel, "samples per pixel")
      ->check(CLI::Range(1, 1 << 16))
      ->capture_default_str();
  sub->add_option("--material", command->study.material,
                  "what the markers are made of, a material of the scene or the library")
      ->capture_default_str();
  sub->add_option("--stride", command->study.stride,
                  "only every N-th row and column of the grid, for a quick look")
      ->check(CLI::Range(1, 14))
      ->capture_default_str();
  sub->add_option("--keep", command->keep,
                  "pictures to keep: all, misses, or samples for the report")
      ->check(CLI::IsMember({"all", "misses", "samples"}))
      ->capture_default_str();
  sub->callback([command, &global, &run] {
    run = [command, &global] { return RunStudyMarkers(*command, global); };
  });
}

}  // namespace retrolux::cli
