#include "analysis/dataset_plan.h"

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/task_manifest.h"

namespace retrolux {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

DatasetConfig ConfigOf(const fs::path& folder) {
  if (!fs::exists(folder / kDatasetConfigFile)) {
    throw InputError::At(folder, "", fmt::format("no {}", kDatasetConfigFile),
                         "a folder that `retrolux dataset plan` made");
  }
  return ReadDatasetConfig(folder / kDatasetConfigFile);
}

std::vector<Task> TasksOf(const DatasetConfig& config) {
  std::vector<Task> tasks;
  for (int i = 0; i < config.scenes; ++i)
    tasks.push_back({fmt::format("scene-{:05}", i), {{"scene", i}}});
  return tasks;
}

}  // namespace

RecordOptions RecordingOf(const DatasetConfig& config, const fs::path& folder,
                          const RecordChoice& choice) {
  const Json manifest = ReadManifest(folder);
  const Json before =
      manifest.is_object() ? manifest.value("options", Json::object()) : Json::object();
  RecordOptions options;
  options.seed = config.seed;
  options.samples_per_pixel =
      choice.samples_per_pixel.value_or(before.value("spp", config.samples_per_pixel));
  options.keep_exr = choice.keep_exr.value_or(before.value("keep_exr", false));
  return options;
}

Json DatasetInputs(const DatasetScenes& scenes, const RecordOptions& options) {
  Json inputs = scenes.Inputs();
  inputs["spp"] = options.samples_per_pixel;
  inputs["keep_exr"] = options.keep_exr;
  return inputs;
}

Json DatasetScene::ToJson() const {
  Json list = Json::array();
  for (const DatasetPicture& picture : pictures) list.push_back(picture.ToJson());
  return {{"scene", name}, {"split", split}, {"nuisances", nuisances}, {"pictures", list}};
}

DatasetScene DatasetScene::FromJson(const Json& json) {
  DatasetScene scene{json.at("scene"), json.at("split"), json.at("nuisances"), {}};
  for (const Json& picture : json.at("pictures"))
    scene.pictures.push_back(DatasetPicture::FromJson(picture));
  return scene;
}

DatasetPlan::DatasetPlan(fs::path folder, const RecordChoice& choice)
    : scenes_(ConfigOf(folder)),
      recording_(RecordingOf(scenes_.Config(), folder, choice)),
      store_(std::move(folder), kDatasetStudy, DatasetInputs(scenes_, recording_)),
      tasks_(TasksOf(scenes_.Config())) {
  CheckSameWork(store_);
}

std::vector<DatasetPlan::File> DatasetPlan::FilesOf(const Json& result) const {
  std::vector<File> files;
  for (const Json& picture : result.at("pictures")) {
    const fs::path png = picture.at("file").get<std::string>();
    files.push_back({png, picture.at("hash")});
    if (recording_.keep_exr)
      files.push_back({fs::path("exr") / png.stem().concat(".exr"), picture.at("exr_hash")});
  }
  return files;
}

std::string DatasetPlan::FaultOf(const Json& result) const {
  for (const File& file : FilesOf(result)) {
    if (!fs::exists(Folder() / file.name)) return file.name.string() + ": missing";
    if (HexHash(HashBytes(ReadTextFile(Folder() / file.name))) != file.hash)
      return file.name.string() + ": not what was written";
  }
  return "";
}

}  // namespace retrolux
