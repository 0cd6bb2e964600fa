// Sets of labelled pictures for those who teach and test detectors: scenes drawn from a config,
// each rendered by all of its cameras, with everything that is true of the markers in them.
//
// The folder of a dataset:
//   config.json (and masks that it names)   the plan; everything follows from it
//   manifest.json, tasks/                   core/task_manifest.h; a task is a scene
//   images/SCENE_CAMERA.png                 what the sensors give
//   dataset.json, card.md, contact_sheet.png, report.html    once all scenes are done
#pragma once

#include <functional>
#include <optional>

#include "analysis/dataset_picture.h"
#include "core/task_manifest.h"

namespace retrolux {

// Makes the folder: the config and its masks are copied into it, and the tasks listed. InputError
// for a config that can't be drawn from, and for a folder that holds another plan.
void PlanDataset(const std::filesystem::path& config, const std::filesystem::path& folder);

struct DatasetRunOptions {
  std::optional<int> samples_per_pixel;  // instead of the config's
  bool keep_exr = false;
  std::function<bool(size_t scene)> chosen;  // null: all
};

// A scene that was rendered, as its task left it.
struct DatasetScene {
  std::string name, split;
  nlohmann::json nuisances;
  std::vector<DatasetPicture> pictures;

  nlohmann::json ToJson() const;
  static DatasetScene FromJson(const nlohmann::json& json);
};

struct Dataset {
  DatasetConfig config;
  int samples_per_pixel = 0;
  std::vector<std::optional<DatasetScene>> scenes;  // nothing: not done yet
  TaskReport tasks;

  size_t ScenesDone() const;
  bool IsDone() const { return ScenesDone() == scenes.size(); }
};

// Renders the scenes that are chosen and not done. A scene of which a picture is missing or changed
// counts as not done.
Dataset RunDataset(const std::filesystem::path& folder, const DatasetRunOptions& options,
                   Progress& progress, RecordTimes& times);

// dataset.json (`retrolux/dataset-index-1`): all labels, a scene a line. The dataset must be done.
void WriteDatasetIndex(const Dataset& dataset, const std::filesystem::path& folder);

// What dataset.json says of the whole set; its "scenes" are read one by one.
struct DatasetIndex {
  nlohmann::json header;  // without the scenes
  std::vector<DatasetScene> scenes;
};
// InputError if there is none.
DatasetIndex ReadDatasetIndex(const std::filesystem::path& folder);

}  // namespace retrolux
