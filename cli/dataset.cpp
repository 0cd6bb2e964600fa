// retrolux dataset plan CONFIG --out DIR | run DIR | status DIR | export DIR
#include <fmt/format.h>

#include "analysis/bop.h"
#include "analysis/coco.h"
#include "analysis/dataset_card.h"
#include "analysis/dataset_csv.h"
#include "cli/run_json.h"
#include "cli/task_choice.h"

namespace retrolux::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct PlanCommand {
  fs::path config, out;
};

struct RunCommand {
  fs::path folder;
  std::string shard, tasks;
  int samples_per_pixel = 0;
  bool keep_exr = false;
};

struct ExportCommand {
  fs::path folder;
  std::string format;
};

Json StateJson(const Dataset& dataset) {
  return {{"scenes", dataset.scenes.size()},
          {"done", dataset.ScenesDone()},
          {"missing", dataset.scenes.size() - dataset.ScenesDone()}};
}

std::string StateText(const Dataset& dataset) {
  return fmt::format("{} of {} scenes are done", dataset.ScenesDone(), dataset.scenes.size());
}

DatasetRunOptions RunOptionsOf(const RunCommand& command) {
  DatasetRunOptions options;
  if (command.samples_per_pixel > 0) options.samples_per_pixel = command.samples_per_pixel;
  options.keep_exr = command.keep_exr;
  if (!command.shard.empty()) options.chosen = ParseShard(command.shard);
  if (!command.tasks.empty()) options.chosen = ParseTasks(command.tasks);
  return options;
}

int RunPlan(const PlanCommand& command, const GlobalOptions& global) {
  PlanDataset(command.config, command.out);
  const DatasetConfig config = ReadDatasetConfig(command.config);
  PrintResult(global, {{"out", command.out.string()}, {"scenes", config.scenes}},
              fmt::format("{}: {} scenes planned; retrolux dataset run {}", command.out.string(),
                          config.scenes, command.out.string()));
  return kExitGood;
}

// What one picture cost, ms of all threads together.
Json Costs(const RecordTimes& times, int64_t pictures) {
  const auto each = [&](double seconds) {
    return pictures > 0 ? 1e3 * seconds / static_cast<double>(pictures) : 0.0;
  };
  return {{"geometry", each(times.geometry)},
          {"trace", each(times.trace)},
          {"sensor", each(times.sensor)},
          {"encode", each(times.encode)},
          {"labels", each(times.labels)}};
}

double Share(int64_t part, int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

int64_t PixelsOfAPicture(const Dataset& dataset) {
  for (const auto& scene : dataset.scenes) {
    if (!scene || scene->pictures.empty()) continue;
    const CameraModel& model = scene->pictures.front().model;
    return static_cast<int64_t>(model.width) * model.height;
  }
  return 1;
}

Json Figures(const Dataset& dataset, const RecordTimes& times, double seconds) {
  const int64_t pictures = times.pixels / PixelsOfAPicture(dataset);
  return {
      {"pictures", pictures},
      {"pictures_per_minute", 60.0 * static_cast<double>(pictures) / seconds},
      {"tasks", {{"done_before", dataset.tasks.done_before}, {"done_now", dataset.tasks.done_now}}},
      {"cost_ms", Costs(times, pictures)},
      {"traced_share", Share(times.traced_pixels, times.pixels)},
      {"paths_per_pixel", Share(times.paths, times.pixels)}};
}

int RunRun(const RunCommand& command, const GlobalOptions& global) {
  const auto progress = MakeProgress(global);
  const StudyRun run(global);
  RecordTimes times;
  const Dataset dataset = RunDataset(command.folder, RunOptionsOf(command), *progress, times);
  for (const std::string& warning : dataset.tasks.warnings)
    fmt::print(stderr, "retrolux: {}\n", warning);
  const double seconds = run.Seconds();
  const Json figures = Figures(dataset, times, seconds);
  if (dataset.IsDone()) {
    WriteDatasetIndex(dataset, command.folder);
    WriteDatasetCard(ReadDatasetIndex(command.folder), command.folder, global.command_line);
  }
  run.Write(command.folder, figures);
  Json summary = StateJson(dataset);
  summary.update(figures);
  summary["seconds"] = seconds;
  std::string text = StateText(dataset) + fmt::format("; {} pictures in {:.1f} s ({:.0f} a minute)",
                                                      figures["pictures"].get<int64_t>(), seconds,
                                                      figures["pictures_per_minute"].get<double>());
  if (dataset.IsDone()) text += "\ncard: " + (command.folder / "card.md").string();
  PrintResult(global, summary, text);
  return kExitGood;
}

int RunStatus(const RunCommand& command, const GlobalOptions& global) {
  DatasetRunOptions options = RunOptionsOf(command);
  options.chosen = [](size_t) { return false; };
  RecordTimes times;
  const Dataset dataset = RunDataset(command.folder, options, NoProgress(), times);
  for (const std::string& warning : dataset.tasks.warnings)
    fmt::print(stderr, "retrolux: {}\n", warning);
  PrintResult(global, StateJson(dataset), StateText(dataset));
  return kExitGood;
}

int RunExport(const ExportCommand& command, const GlobalOptions& global) {
  const DatasetIndex index = ReadDatasetIndex(command.folder);
  std::vector<fs::path> written;
  if (command.format == "coco") written = ExportCoco(index, command.folder);
  if (command.format == "bop") written = ExportBop(index, command.folder);
  if (command.format == "csv") written = {ExportCsv(index, command.folder)};
  Json files = Json::array();
  for (const fs::path& file : written) files.push_back(file.string());
  PrintResult(global, {{"written", files}},
              fmt::format("{} written, the first {}", written.size(), written.front().string()));
  return kExitGood;
}

void AddRunOptions(CLI::App& sub, RunCommand& command) {
  sub.add_option("folder", command.folder, "that `dataset plan` made")->required();
  sub.add_option("--spp", command.samples_per_pixel,
                 "samples per pixel; default: the config's. Other samples, another set of results")
      ->check(CLI::Range(1, 1 << 16));
  sub.add_flag("--keep-exr", command.keep_exr, "keep all channels of each picture in exr/");
}

}  // namespace

void SetUpDataset(CLI::App& app, const GlobalOptions& global, Run& run) {
  CLI::App* dataset =
      app.add_subcommand("dataset", "Sets of labelled pictures, drawn from a config");

  auto plan = std::make_shared<PlanCommand>();
  CLI::App* sub = dataset->add_subcommand("plan", "Lists the scenes of a config; renders nothing");
  sub->add_option("config", plan->config, "what to draw from (docs/datasets.md)")->required();
  sub->add_option("--out", plan->out, "folder of the dataset")->required();
  sub->callback(
      [plan, &global, &run] { run = [plan, &global] { return RunPlan(*plan, global); }; });

  auto command = std::make_shared<RunCommand>();
  sub = dataset->add_subcommand("run", "Renders the scenes that are not done, with their labels");
  AddRunOptions(*sub, *command);
  CLI::Option* shard =
      sub->add_option("--shard", command->shard, "i/n: every n-th scene, i from 1");
  sub->add_option("--tasks", command->tasks, "scenes by number, from 0, e.g. 2,4,10-20")
      ->excludes(shard);
  sub->callback(
      [command, &global, &run] { run = [command, &global] { return RunRun(*command, global); }; });

  auto status = std::make_shared<RunCommand>();
  sub = dataset->add_subcommand("status", "How many scenes are done");
  AddRunOptions(*sub, *status);
  sub->callback(
      [status, &global, &run] { run = [status, &global] { return RunStatus(*status, global); }; });

  auto exported = std::make_shared<ExportCommand>();
  sub = dataset->add_subcommand("export", "The labels in other programs' forms");
  sub->add_option("folder", exported->folder, "of a dataset that is done")->required();
  sub->add_option("--format", exported->format, "coco (coco/), bop (bop/) or csv (markers.csv)")
      ->required()
      ->check(CLI::IsMember({"coco", "bop", "csv"}));
  sub->callback([exported, &global, &run] {
    run = [exported, &global] { return RunExport(*exported, global); };
  });
}

}  // namespace retrolux::cli
