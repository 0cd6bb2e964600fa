// retrolux dataset plan CONFIG --out DIR | run DIR | status DIR | verify DIR | merge DIR... |
// export DIR
#include "cli/dataset.h"

#include <fmt/format.h>

#include "analysis/bop.h"
#include "analysis/coco.h"
#include "analysis/dataset_card.h"
#include "analysis/dataset_csv.h"

namespace retrolux::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct ExportCommand {
  fs::path folder;
  std::string format;
};

// What renders the same files again, however this folder came to be.
std::string CommandOf(const DatasetPlan& plan) {
  std::string options;
  if (plan.Recording().samples_per_pixel != plan.Config().samples_per_pixel)
    options += fmt::format(" --spp {}", plan.Recording().samples_per_pixel);
  if (plan.Recording().keep_exr) options += " --keep-exr";
  return fmt::format("retrolux dataset plan config.json --out DIR{}; retrolux dataset run DIR",
                     options);
}

int RunStatus(const fs::path& folder, const GlobalOptions& global) {
  const DatasetState state = StateOf(DatasetPlan(folder));
  Json summary = StateJson(state);
  summary["failures"] = state.failures;
  std::string text = StateText(state);
  for (const std::string& failure : state.failures) text += "\nfailed: " + failure;
  PrintResult(global, summary, text);
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

}  // namespace

void WriteIndexAndCard(const DatasetPlan& plan) {
  WriteDatasetIndex(plan);
  WriteDatasetCard(ReadDatasetIndex(plan.Folder()), plan.Folder(), CommandOf(plan));
}

Json StateJson(const DatasetState& state) {
  return {{"scenes", state.done.size()},
          {"done", state.ScenesDone()},
          {"missing", state.done.size() - state.ScenesDone()}};
}

std::string StateText(const DatasetState& state) {
  return fmt::format("{} of {} scenes are done", state.ScenesDone(), state.done.size());
}

void AddRecording(CLI::App& sub, RecordChoice& recording) {
  sub.add_option("--spp", recording.samples_per_pixel,
                 "samples per pixel; default: the folder's, else the config's")
      ->check(CLI::Range(1, 1 << 16));
  sub.add_flag_callback(
      "--keep-exr", [&recording] { recording.keep_exr = true; },
      "keep all channels of each picture in exr/; default: as the folder has it");
}

void AddFolder(CLI::App& sub, fs::path& folder) {
  sub.add_option("folder", folder, "that `dataset plan` made")->required();
}

void SetUpDataset(CLI::App& app, const GlobalOptions& global, Run& run) {
  CLI::App* dataset =
      app.add_subcommand("dataset", "Sets of labelled pictures, drawn from a config");
  SetUpDatasetPlan(*dataset, global, run);
  SetUpDatasetRun(*dataset, global, run);

  auto status = std::make_shared<fs::path>();
  CLI::App* sub = dataset->add_subcommand("status", "How many scenes are done, and which failed");
  AddFolder(*sub, *status);
  sub->callback(
      [status, &global, &run] { run = [status, &global] { return RunStatus(*status, global); }; });

  SetUpDatasetVerify(*dataset, global, run);

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
