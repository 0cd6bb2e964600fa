// retrolux dataset plan: the folder of a dataset, and the jobs of engines that run it.
#include <fmt/format.h>

#include <algorithm>

#include "cli/dataset.h"
#include "cli/job_files.h"
#include "core/error.h"

namespace retrolux::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct PlanCommand {
  fs::path config, out;
  std::string engine;
  int shards = 0;  // 0: as many as have a minute's work
  int shard_threads = 1;
  RecordChoice recording;
};

// Seconds of one thread for a scene, from a few that are rendered for it (and kept).
double SecondsPerScene(const DatasetPlan& plan, Progress& progress) {
  constexpr size_t kProbe = 3;
  DatasetRunOptions options;
  options.chosen = [](size_t scene) { return scene < kProbe; };
  RecordTimes times;
  const DatasetState state = RunDataset(plan.Folder(), options, progress, times);
  if (state.tasks.done_now == 0) {
    throw InputError::At(plan.Folder(), "",
                         "is begun already, so that no scene is left to be timed", "--shards N");
  }
  return times.All() / static_cast<double>(state.tasks.done_now);
}

// So that each has at least `seconds` of work, and an array is no longer than Slurm's default
// takes.
int ShardsFor(double scenes, double seconds_per_scene, double seconds) {
  constexpr double kMost = 1000.0;
  return static_cast<int>(std::clamp(scenes * seconds_per_scene / seconds, 1.0, kMost));
}

// Shards of a minute if no number is given; never of less than half a minute.
int ShardsOf(const PlanCommand& command, const DatasetPlan& plan, Progress& progress) {
  constexpr double kUsual_s = 60.0, kLeast_s = 30.0;
  const auto scenes = static_cast<double>(plan.Tasks().size());
  if (command.shards > 0 && StateOf(plan).ScenesDone() > 0) return command.shards;
  const double each = SecondsPerScene(plan, progress);
  if (command.shards == 0) return ShardsFor(scenes, each, kUsual_s);
  const int most = ShardsFor(scenes, each, kLeast_s);
  if (command.shards > most) {
    Tell(fmt::format(
        "{} shards instead of {}: a scene takes {:.2g} s, a shard should have half a minute of "
        "work",
        most, command.shards, each));
  }
  return std::min(command.shards, most);
}

int RunPlan(const PlanCommand& command, const GlobalOptions& global) {
  PlanDataset(command.config, command.out, command.recording);
  const DatasetPlan plan(command.out);
  Json summary = {{"out", command.out.string()}, {"scenes", plan.Tasks().size()}};
  std::string next = fmt::format("retrolux dataset run {}", command.out.string());
  if (!command.engine.empty()) {
    const auto progress = MakeProgress(global);
    const JobPlan jobs{plan.Config().name, command.out, ShardsOf(command, plan, *progress),
                       command.shard_threads};
    const std::vector<fs::path> files = WriteJobFiles(jobs, command.engine);
    summary["shards"] = jobs.shards;
    for (const fs::path& file : files) summary["jobs"].push_back(file.string());
    next = fmt::format("{} shards: {}", jobs.shards, files.front().string());
  }
  PrintResult(
      global, summary,
      fmt::format("{}: {} scenes planned; {}", command.out.string(), plan.Tasks().size(), next));
  return kExitGood;
}

}  // namespace

void SetUpDatasetPlan(CLI::App& dataset, const GlobalOptions& global, Run& run) {
  auto plan = std::make_shared<PlanCommand>();
  CLI::App* sub = dataset.add_subcommand("plan", "Lists the scenes of a config; renders nothing");
  sub->add_option("config", plan->config, "what to draw from (docs/datasets.md)")->required();
  sub->add_option("--out", plan->out, "folder of the dataset")->required();
  AddRecording(*sub, plan->recording);
  CLI::Option* emit = sub->add_option("--emit", plan->engine,
                                      "write a job, to be submitted: slurm, openjd, or "
                                      "parallel (GNU parallel). Renders three scenes to time them")
                          ->check(CLI::IsMember({"slurm", "openjd", "parallel"}));
  sub->add_option("--shards", plan->shards,
                  "into how many shards; default: of a minute's work each. Never of less than half")
      ->check(CLI::Range(1, 1000))
      ->needs(emit);
  sub->add_option("--shard-threads", plan->shard_threads, "threads of each shard")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str()
      ->needs(emit);
  sub->callback(
      [plan, &global, &run] { run = [plan, &global] { return RunPlan(*plan, global); }; });
}

}  // namespace retrolux::cli
