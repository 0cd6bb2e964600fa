// retrolux study markers --out DIR
#include <fmt/format.h>

#include <chrono>
#include <ctime>

#include "analysis/marker_coverage.h"
#include "cli/commands.h"
#include "core/atomic_file.h"
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

// "2026-11-22T10:00:00Z"
std::string UtcNow() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
  return text;
}

void WriteRunJson(const StudyMarkersCommand& command, const GlobalOptions& global,
                  const MarkerStudy& study, const std::string& started, double seconds) {
  const MarkerStudy::Times& t = study.times;
  const nlohmann::json run = {
      {"schema", "retrolux/run-1"},
      {"version", RETROLUX_VERSION},
      {"units", "s"},
      {"pixel_origin", "center"},
      {"command", global.command_line},
      {"seed", global.seed},
      {"noise_seed", global.NoiseSeed()},
      {"started", started},
      {"seconds", seconds},
      {"threads", global.threads > 0 ? global.threads : AvailableThreads()},
      {"pictures", study.results.size()},
      {"pictures_rendered", study.composed},
      {"pictures_per_minute", 60.0 * static_cast<double>(study.results.size()) / seconds},
      {"times",
       {{"background_wall", t.background},
        {"pictures_wall", t.pictures},
        {"geometry", t.geometry},
        {"trace", t.trace},
        {"sensor", t.sensor},
        {"identify", t.identify},
        {"write", t.write}}}};
  WriteTextFile(command.out / "run.json", run.dump(2) + "\n");
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
  return text + fmt::format("{} pictures in {:.1f} s ({:.0f} a minute)\nreport: {}",
                            study.results.size(), seconds,
                            60.0 * static_cast<double>(study.results.size()) / seconds,
                            report.string());
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
  const std::string started = UtcNow();
  const auto start = std::chrono::steady_clock::now();
  const MarkerStudy study = RunMarkerStudy(scene, command.study, command.out, *progress);
  const StudyCoverage coverage(study);
  WriteStudyFiles(study, coverage, command.out);
  WriteStudyReport(study, coverage, command.out, global.command_line);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  WriteRunJson(command, global, study, started, seconds);
  nlohmann::json summary = StudySummary(study, coverage);
  summary["report"] = (command.out / "report.html").string();
  summary["seconds"] = seconds;
  PrintResult(global, summary, Text(study, coverage, command.out / "report.html", seconds));
  return kExitGood;
}

}  // namespace

void SetUpStudy(CLI::App& app, const GlobalOptions& global, Run& run) {
  CLI::App* study =
      app.add_subcommand("study", "The studies; each writes report.html, its tables and run.json");
  auto command = std::make_shared<StudyMarkersCommand>();
  CLI::App* sub = study->add_subcommand(
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
  sub->add_option("--method", "how markers are identified")
      ->check(CLI::IsMember({"edges"}))
      ->default_str("edges");
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
