// A planned dataset in its folder: its config, its tasks (one for each scene), and what they left.
#pragma once

#include <optional>

#include "analysis/dataset_picture.h"
#include "core/task_store.h"

namespace retrolux {

// A scene that was rendered, as its task left it.
struct DatasetScene {
  std::string name, split;
  nlohmann::json nuisances;
  std::vector<DatasetPicture> pictures;

  nlohmann::json ToJson() const;
  static DatasetScene FromJson(const nlohmann::json& json);
};

// What of the recording is chosen beside the config. Unset: as the folder has it already, else as
// the config says, and no EXR files.
struct RecordChoice {
  std::optional<int> samples_per_pixel;
  std::optional<bool> keep_exr;
};

// Of a folder that may be there already.
RecordOptions RecordingOf(const DatasetConfig& config, const std::filesystem::path& folder,
                          const RecordChoice& choice);

// All that a scene's result follows from, beside its number.
nlohmann::json DatasetInputs(const DatasetScenes& scenes, const RecordOptions& options);

class DatasetPlan {
 public:
  // Reads what `dataset plan` made; writes nothing. InputError, also as CheckSameWork.
  explicit DatasetPlan(std::filesystem::path folder, const RecordChoice& choice = {});

  const std::filesystem::path& Folder() const { return store_.Folder(); }
  const DatasetScenes& Scenes() const { return scenes_; }
  const DatasetConfig& Config() const { return scenes_.Config(); }
  const RecordOptions& Recording() const { return recording_; }
  const TaskStore& Store() const { return store_; }

  // One for each scene, in their order.
  const std::vector<Task>& Tasks() const { return tasks_; }
  bool HasResult(size_t scene) const { return store_.HasResult(store_.Place(tasks_[scene])); }
  // Why it failed when it was last tried; empty: it did not.
  std::string Failure(size_t scene) const { return store_.Failure(store_.Place(tasks_[scene])); }
  // InputError if there is no result, or a damaged one.
  nlohmann::json Result(size_t scene) const { return store_.Read(store_.Place(tasks_[scene])); }
  DatasetScene Read(size_t scene) const { return DatasetScene::FromJson(Result(scene)); }

  // The files of a result beside the result itself, with their hashes.
  struct File {
    std::filesystem::path name;  // below the folder
    std::string hash;
  };
  std::vector<File> FilesOf(const nlohmann::json& result) const;
  // What is wrong with those files: "images/x.png: missing"; empty: nothing.
  std::string FaultOf(const nlohmann::json& result) const;

 private:
  DatasetScenes scenes_;
  RecordOptions recording_;
  TaskStore store_;
  std::vector<Task> tasks_;
};

inline constexpr const char* kDatasetStudy = "dataset";           // of its tasks
inline constexpr const char* kDatasetConfigFile = "config.json";  // in the folder

}  // namespace retrolux
