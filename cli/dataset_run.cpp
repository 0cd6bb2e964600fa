// retrolux dataset run: renders what is not done.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <optional>

#include "cli/dataset.h"
#include "cli/run_json.h"
#include "cli/task_choice.h"
#include "core/error.h"

namespace retrolux::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct RunCommand {
  fs::path folder;
  std::string shard, tasks;
  std::optional<double> time_limit_s;
  RecordChoice recording;
};

// The time limit is that of the program, however often a crash made the work begin again.
DatasetRunOptions RunOptionsOf(const RunCommand& command, const GlobalOptions& global) {
  DatasetRunOptions options;
  options.recording = command.recording;
  if (!command.shard.empty()) options.chosen = ParseShard(command.shard);
  if (!command.tasks.empty()) {
    const DatasetPlan plan(command.folder, command.recording);
    options.chosen = ParseTasks(command.tasks, plan.Tasks().size());
  }
  if (command.time_limit_s) {
    options.until =
        global.begun + std::chrono::milliseconds(std::llround(1e3 * *command.time_limit_s));
  }
  return options;
}

void SetTimeLimit(double seconds, RunCommand& command) {
  constexpr double kLongest_s = 1e7;
  if (!(seconds >= 0.0 && seconds <= kLongest_s))
    throw InputError(
        fmt::format("--time-limit: {} s; expected from 0 to {:g} s", seconds, kLongest_s));
  command.time_limit_s = seconds;
}

// What one picture cost, ms of all threads together.
Json Costs(const RecordTimes& times, int64_t pictures) {
  const auto each = [&](double seconds) {
    return pictures > 0 ? 1e3 * seconds / static_cast<double>(pictures) : 0.0;
  };
  return {{"geometry", each(times.geometry)}, {"trace", each(times.trace)},
          {"sensor", each(times.sensor)},     {"encode", each(times.encode)},
          {"write", each(times.write)},       {"labels", each(times.labels)}};
}

double Share(int64_t part, int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

Json Figures(const DatasetState& state, const RecordTimes& times, double seconds) {
  const int64_t pictures = times.pictures;
  return {{"pictures", pictures},
          {"pictures_per_minute", 60.0 * static_cast<double>(pictures) / seconds},
          {"tasks", TasksJson(state.tasks)},
          {"cost_ms", Costs(times, pictures)},
          {"traced_share", Share(times.traced_pixels, times.pixels)},
          {"paths_per_pixel", Share(times.paths, times.pixels)}};
}

std::string RunText(const DatasetState& state, const Json& figures, double seconds,
                    const ThreadLimit& threads) {
  std::string text = StateText(state);
  const std::string tasks = state.tasks.Text();
  if (!tasks.empty()) text += "; " + tasks;
  return text + fmt::format("; {} pictures in {:.1f} s ({:.0f} a minute) on {}",
                            figures["pictures"].get<int64_t>(), seconds,
                            figures["pictures_per_minute"].get<double>(), threads.Text());
}

int RunRun(const RunCommand& command, const GlobalOptions& global) {
  const auto progress = MakeProgress(global);
  const StudyRun run(global);
  RecordTimes times;
  const DatasetState state =
      RunDataset(command.folder, RunOptionsOf(command, global), *progress, times);
  for (const std::string& warning : state.tasks.warnings) Tell(warning);
  const double seconds = run.Seconds();
  const Json figures = Figures(state, times, seconds);
  if (state.IsDone()) WriteIndexAndCard(DatasetPlan(command.folder));
  run.Write(command.folder, figures);
  Json summary = StateJson(state);
  summary.update(figures);
  summary["seconds"] = seconds;
  std::string text = RunText(state, figures, seconds, ThreadsOf(global));
  if (state.IsDone()) text += "\ncard: " + (command.folder / "card.md").string();
  PrintResult(global, summary, text);
  return state.tasks.out_of_time > 0 ? kExitTryAgain : kExitGood;
}

}  // namespace

void SetUpDatasetRun(CLI::App& dataset, const GlobalOptions& global, Run& run) {
  auto command = std::make_shared<RunCommand>();
  CLI::App* sub =
      dataset.add_subcommand("run", "Renders the scenes that are not done, with their labels");
  AddFolder(*sub, command->folder);
  AddRecording(*sub, command->recording);
  CLI::Option* shard =
      sub->add_option("--shard", command->shard, "i/n: every n-th scene, i from 1");
  sub->add_option("--tasks", command->tasks, "scenes by number, from 0, e.g. 2,4,10-20")
      ->excludes(shard);
  sub->add_option_function<double>(
         "--time-limit", [command](double seconds) { SetTimeLimit(seconds, *command); },
         "no scene is begun later than that, e.g. 90min or 8h; exit code 75 if some are left")
      ->transform(CLI::AsNumberWithUnit(
          std::map<std::string, double>{{"s", 1.0}, {"min", 60.0}, {"h", 3600.0}},
          CLI::AsNumberWithUnit::UNIT_REQUIRED, "TIME"));
  sub->callback(
      [command, &global, &run] { run = [command, &global] { return RunRun(*command, global); }; });
}

}  // namespace retrolux::cli
