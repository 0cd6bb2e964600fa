#include "analysis/dataset_merge.h"

#include "core/atomic_file.h"
#include "core/error.h"

namespace retrolux {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

std::string NameOf(const DatasetPlan& plan, size_t scene) {
  return fmt::format("{} (number {})", plan.Tasks()[scene].name, scene);
}

// What is wrong with a scene that has a result; empty: nothing.
std::string FaultOf(const DatasetPlan& plan, size_t scene) {
  try {
    return plan.FaultOf(plan.Result(scene));
  } catch (const InputError& error) {
    return error.what();
  }
}

void CopyFile(const fs::path& from, const fs::path& to) {
  EnsureWritableFolder(to.parent_path());
  WriteTextFile(to, ReadTextFile(from));
}

// The pictures first: a result says that all that belongs to it is there.
void TakeScene(const DatasetPlan& from, const DatasetPlan& to, size_t scene) {
  for (const DatasetPlan::File& file : to.FilesOf(from.Result(scene)))
    CopyFile(from.Folder() / file.name, to.Folder() / file.name);
  const StoredTask task = to.Store().Place(to.Tasks()[scene]);
  CopyFile(from.Store().ResultFile(task), to.Store().ResultFile(task));
  to.Store().ClearFailure(task);
}

// InputError if `other` is no part of the same dataset.
void CheckSameDataset(const DatasetPlan& plan, const DatasetPlan& other) {
  std::string changes = Changes(plan.Config().document, other.Config().document);
  if (changes.empty()) changes = Changes(plan.Store().Options(), other.Store().Options());
  if (changes.empty()) return;
  throw InputError::At(other.Folder(), "", "another dataset; " + changes,
                       "a folder of the same plan as " + plan.Folder().string());
}

}  // namespace

DatasetFaults VerifyDataset(const fs::path& folder, IndexToo index, Progress& progress) {
  const DatasetPlan plan(folder);
  DatasetFaults faults;
  const size_t scenes = plan.Tasks().size();
  progress.Begin("verifying", static_cast<int64_t>(scenes), "scenes");
  std::vector<std::string> fault(scenes);
  ParallelFor(static_cast<int64_t>(scenes), [&](int64_t i) {
    const auto scene = static_cast<size_t>(i);
    if (plan.HasResult(scene)) fault[scene] = FaultOf(plan, scene);
    progress.Advance(1);
  });
  progress.End();
  for (size_t i = 0; i < scenes; ++i) {
    if (!plan.HasResult(i)) {
      const std::string failure = plan.Failure(i);
      faults.missing.push_back(NameOf(plan, i) + (failure.empty() ? "" : ": " + failure));
      continue;
    }
    ++faults.checked;
    if (!fault[i].empty()) faults.damaged.push_back(NameOf(plan, i) + ": " + fault[i]);
  }
  if (index == IndexToo::kYes && faults.damaged.empty() && faults.missing.empty()) {
    if (!fs::exists(folder / "dataset.json")) {
      faults.missing.push_back("dataset.json: `retrolux dataset run` writes it");
    } else if (!IsIndexOf(plan)) {
      faults.damaged.push_back("dataset.json: not what the results say");
    }
  }
  return faults;
}

std::vector<std::string> MergeDatasets(const fs::path& folder, const std::vector<fs::path>& others,
                                       Progress& progress) {
  const DatasetPlan plan(folder);
  for (const fs::path& other : others) CheckSameDataset(plan, DatasetPlan(other));
  std::vector<std::string> damaged;
  for (const fs::path& other_folder : others) {
    const DatasetPlan other(other_folder);
    const size_t scenes = plan.Tasks().size();
    progress.Begin("merging " + other_folder.string(), static_cast<int64_t>(scenes), "scenes");
    for (size_t i = 0; i < scenes; ++i) {
      progress.Advance(1);
      if (!other.HasResult(i)) continue;
      if (plan.HasResult(i) && FaultOf(plan, i).empty()) continue;
      const std::string fault = FaultOf(other, i);
      if (fault.empty()) {
        TakeScene(other, plan, i);
      } else {
        damaged.push_back(
            fmt::format("{}: {}: {}; not taken, `retrolux dataset run` there makes "
                        "it again",
                        other_folder.string(), NameOf(other, i), fault));
      }
    }
    progress.End();
  }
  return damaged;
}

}  // namespace retrolux
