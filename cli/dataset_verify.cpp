// retrolux dataset verify | merge: is all there, and whole?
#include <fmt/format.h>

#include "analysis/dataset_merge.h"
#include "cli/dataset.h"
#include "core/error.h"

namespace retrolux::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct MergeCommand {
  std::vector<fs::path> folders;
};

// A line for each on stderr, however many.
void PrintFaults(const DatasetFaults& faults) {
  for (const std::string& fault : faults.damaged) Tell(fault);
  for (const std::string& scene : faults.missing) Tell("not done: " + scene);
}

std::string FaultsText(const DatasetFaults& faults) {
  return fmt::format("{} scenes checked, {} damaged, {} not done", faults.checked,
                     faults.damaged.size(), faults.missing.size());
}

Json FaultsJson(const DatasetFaults& faults) {
  return {{"checked", faults.checked}, {"damaged", faults.damaged}, {"missing", faults.missing}};
}

int ExitCodeOf(const DatasetFaults& faults) {
  if (!faults.damaged.empty()) return kExitCheckFailed;
  return faults.missing.empty() ? kExitGood : kExitTasksFailed;
}

int RunVerify(const fs::path& folder, const GlobalOptions& global) {
  const DatasetFaults faults = VerifyDataset(folder, IndexToo::kYes, *MakeProgress(global));
  PrintFaults(faults);
  PrintResult(global, FaultsJson(faults), FaultsText(faults));
  return ExitCodeOf(faults);
}

// What is made of all scenes is made anew, and must not be there if one of them is not.
void RemoveSummaries(const fs::path& folder) {
  for (const char* name : {"dataset.json", "card.md", "contact_sheet.png", "report.html"}) {
    std::error_code error;
    fs::remove(folder / name, error);
    if (error)
      throw InputError::At(folder / name, "", error.message(), "a file that can be removed");
  }
}

// A damaged copy that another folder had whole is told of, and no fault.
int RunMerge(const MergeCommand& command, const GlobalOptions& global) {
  const auto progress = MakeProgress(global);
  const fs::path& folder = command.folders.front();
  const std::vector<std::string> not_taken =
      MergeDatasets(folder, {command.folders.begin() + 1, command.folders.end()}, *progress);
  for (const std::string& fault : not_taken) Tell(fault);
  RemoveSummaries(folder);
  DatasetFaults faults = VerifyDataset(folder, IndexToo::kNo, *progress);
  if (!faults.missing.empty())
    faults.damaged.insert(faults.damaged.end(), not_taken.begin(), not_taken.end());
  PrintFaults(faults);
  std::string text = FaultsText(faults);
  if (ExitCodeOf(faults) == kExitGood) {
    WriteIndexAndCard(DatasetPlan(folder));
    text += "\ncard: " + (folder / "card.md").string();
  }
  PrintResult(global, FaultsJson(faults), text);
  return ExitCodeOf(faults);
}

}  // namespace

void SetUpDatasetVerify(CLI::App& dataset, const GlobalOptions& global, Run& run) {
  auto verified = std::make_shared<fs::path>();
  CLI::App* sub = dataset.add_subcommand("verify",
                                         "Reads all results and pictures and compares checksums; "
                                         "exit code 3 if one is damaged, 4 if one is missing");
  AddFolder(*sub, *verified);
  sub->callback([verified, &global, &run] {
    run = [verified, &global] { return RunVerify(*verified, global); };
  });

  auto merged = std::make_shared<MergeCommand>();
  sub = dataset.add_subcommand("merge",
                               "Takes what other folders of the same plan have done, "
                               "verifies, and writes the index and the card");
  sub->add_option("folders", merged->folders, "the dataset, then folders to take from, if any")
      ->required();
  sub->callback(
      [merged, &global, &run] { run = [merged, &global] { return RunMerge(*merged, global); }; });
}

}  // namespace retrolux::cli
