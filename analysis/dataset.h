// Sets of labelled pictures for those who teach and test detectors: scenes drawn from a config,
// each rendered by all of its cameras, with everything that is true of the markers in them.
//
// The folder of a dataset:
//   config.json (and masks that it names)   the plan; everything follows from it
//   manifest.json, tasks/                   core/task_manifest.h; a task is a scene
//   images/SCENE_CAMERA.png                 what the sensors give
//   exr/SCENE_CAMERA.exr                    all channels, if asked for
//   dataset.json, card.md, contact_sheet.png, report.html    once all scenes are done
#pragma once

#include <chrono>
#include <functional>

#include "analysis/dataset_plan.h"
#include "core/task_manifest.h"

namespace retrolux {

// Makes the folder: the config and its masks are copied into it, and the tasks listed. InputError
// for a config that can't be drawn from, and for a folder that holds results of another plan.
void PlanDataset(const std::filesystem::path& config, const std::filesystem::path& folder,
                 const RecordChoice& choice = {});

struct DatasetRunOptions {
  RecordChoice recording;
  std::function<bool(size_t scene)> chosen;                    // null: all
  std::optional<std::chrono::steady_clock::time_point> until;  // no scene is begun later
};

struct DatasetState {
  std::vector<bool> done;             // by scene
  std::vector<std::string> failures;  // "scene-00017 (number 17): what happened when last tried"
  TaskReport tasks;

  size_t ScenesDone() const;
  bool IsDone() const { return ScenesDone() == done.size(); }
};

// Renders the scenes that are chosen and not done. A chosen scene of which a picture is missing or
// changed counts as not done. InputError, TasksFailed, TryAgainError as TaskManifest.
DatasetState RunDataset(const std::filesystem::path& folder, const DatasetRunOptions& options,
                        Progress& progress, RecordTimes& times);

// What is there, by the results' names alone; writes nothing.
DatasetState StateOf(const DatasetPlan& plan);

// dataset.json (`retrolux/dataset-index-1`): all labels, a scene a line. The dataset must be done;
// holds one scene at a time.
void WriteDatasetIndex(const DatasetPlan& plan);
// Whether dataset.json is what WriteDatasetIndex would write now.
bool IsIndexOf(const DatasetPlan& plan);

// What dataset.json says of the whole set; its "scenes" are read one by one.
struct DatasetIndex {
  nlohmann::json header;  // without the scenes
  std::vector<DatasetScene> scenes;
};
// InputError if there is none.
DatasetIndex ReadDatasetIndex(const std::filesystem::path& folder);

}  // namespace retrolux
