#include "analysis/dataset.h"

#include <algorithm>

#include "core/atomic_file.h"
#include "core/hash.h"

namespace retrolux {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

constexpr const char* kConfigFile = "config.json";
constexpr const char* kIndexFile = "dataset.json";
constexpr const char* kIndexSchema = "retrolux/dataset-index-1";

// Files that the config names, below its folder, go along.
void CopyMasks(const DatasetConfig& config, const fs::path& folder) {
  for (const MaskChoice& mask : config.masks) {
    const fs::path from = config.file.parent_path() / mask.mesh;
    if (!fs::path(mask.mesh).has_extension()) continue;
    fs::create_directories((folder / mask.mesh).parent_path());
    WriteTextFile(folder / mask.mesh, ReadTextFile(from));
  }
}

std::vector<Task> TasksOf(const DatasetConfig& config) {
  std::vector<Task> tasks;
  for (int i = 0; i < config.scenes; ++i)
    tasks.push_back({fmt::format("scene-{:05}", i), {{"scene", i}}});
  return tasks;
}

RecordOptions Recording(const DatasetConfig& config, const DatasetRunOptions& options) {
  return {config.seed, options.samples_per_pixel.value_or(config.samples_per_pixel),
          options.keep_exr};
}

Json InputsOf(const DatasetScenes& scenes, const RecordOptions& options) {
  Json inputs = scenes.Inputs();
  inputs["spp"] = options.samples_per_pixel;
  inputs["keep_exr"] = options.keep_exr;
  return inputs;
}

bool PicturesAreThere(const Json& result, const fs::path& folder) {
  const Json& pictures = result.at("pictures");
  return std::all_of(pictures.begin(), pictures.end(), [&](const Json& picture) {
    const fs::path file = folder / picture.at("file").get<std::string>();
    return fs::exists(file) && HexHash(HashBytes(ReadTextFile(file))) == picture.at("hash");
  });
}

Json HeaderOf(const Dataset& dataset) {
  Json splits = Json::object();
  int64_t pictures = 0, markers = 0;
  for (const std::string& split : dataset.config.splits)
    splits[split] = {{"scenes", 0}, {"pictures", 0}, {"markers", 0}};
  for (const std::optional<DatasetScene>& scene : dataset.scenes) {
    Json& split = splits[scene->split];
    split["scenes"] = split["scenes"].get<int>() + 1;
    for (const DatasetPicture& picture : scene->pictures) {
      const auto shown = static_cast<int>(
          std::count_if(picture.markers.begin(), picture.markers.end(),
                        [](const MarkerLabel& label) { return label.visible.Area() > 0; }));
      split["pictures"] = split["pictures"].get<int>() + 1;
      split["markers"] = split["markers"].get<int>() + shown;
      ++pictures;
      markers += shown;
    }
  }
  return {{"schema", kIndexSchema},
          {"version", RETROLUX_VERSION},
          {"name", dataset.config.name},
          {"description", dataset.config.description},
          {"licence", dataset.config.licence},
          {"seed", dataset.config.seed},
          {"spp", dataset.samples_per_pixel},
          {"units", "px, mm, deg, s, e-"},
          {"pixel_origin", "center"},
          {"axes",
           "pixels: x right, y down, (0, 0) the centre of the top-left pixel; camera: x right, y "
           "down, z forward, x_camera = R x_world + t; marker: z along the outward normal; masks: "
           "COCO's run lengths, column by column"},
          {"splits", splits},
          {"pictures", pictures},
          {"markers", markers}};
}

}  // namespace

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

size_t Dataset::ScenesDone() const {
  return static_cast<size_t>(std::count_if(scenes.begin(), scenes.end(),
                                           [](const auto& scene) { return scene.has_value(); }));
}

void PlanDataset(const fs::path& config_file, const fs::path& folder) {
  const DatasetScenes scenes(ReadDatasetConfig(config_file));
  scenes.Draw(0);  // what can't be drawn shows here, not after hours
  const std::string text = ReadTextFile(config_file);
  const fs::path copy = folder / kConfigFile;
  if (fs::exists(copy) && ReadTextFile(copy) != text) {
    throw InputError::At(copy, "", "the plan of another dataset",
                         "another --out, or the config that this folder was planned with");
  }
  EnsureWritableFolder(folder);
  CopyMasks(scenes.Config(), folder);
  WriteTextFile(copy, text);
  DatasetRunOptions none;
  none.chosen = [](size_t) { return false; };
  RecordTimes times;
  RunDataset(folder, none, NoProgress(), times);
}

Dataset RunDataset(const fs::path& folder, const DatasetRunOptions& options, Progress& progress,
                   RecordTimes& times) {
  const fs::path config = folder / kConfigFile;
  if (!fs::exists(config)) {
    throw InputError::At(folder, "", fmt::format("no {}", kConfigFile),
                         "a folder that `retrolux dataset plan` made");
  }
  const DatasetScenes scenes(ReadDatasetConfig(config));
  const RecordOptions recording = Recording(scenes.Config(), options);
  EnsureWritableFolder(folder / "images");
  if (recording.keep_exr) EnsureWritableFolder(folder / "exr");
  TaskLoop loop;
  loop.unit = "scenes";
  loop.chosen = options.chosen;
  loop.usable = [&](const Json& result) { return PicturesAreThere(result, folder); };
  TaskManifest manifest(folder, "dataset", InputsOf(scenes, recording));
  const std::vector<Json> results = manifest.Run(
      "scenes", TasksOf(scenes.Config()),
      [&](size_t task) {
        const DrawnScene drawn = scenes.Draw(static_cast<int>(task));
        DatasetScene scene{drawn.name, drawn.split, drawn.nuisances,
                           RecordScene(drawn, recording, folder, times)};
        return scene.ToJson();
      },
      progress, loop);
  Dataset dataset{scenes.Config(), recording.samples_per_pixel, {}, manifest.Report()};
  for (const Json& result : results) {
    dataset.scenes.push_back(result.is_null() ? std::nullopt
                                              : std::optional(DatasetScene::FromJson(result)));
  }
  return dataset;
}

void WriteDatasetIndex(const Dataset& dataset, const fs::path& folder) {
  std::string text = HeaderOf(dataset).dump(1);
  text.resize(text.size() - 2);  // the line with the closing brace
  text += ",\n \"scenes\": [";
  for (size_t i = 0; i < dataset.scenes.size(); ++i)
    text += (i > 0 ? ",\n" : "\n") + dataset.scenes[i]->ToJson().dump();
  WriteTextFile(folder / kIndexFile, text + "\n]}\n");
}

DatasetIndex ReadDatasetIndex(const fs::path& folder) {
  const fs::path file = folder / kIndexFile;
  if (!fs::exists(file)) {
    throw InputError::At(folder, "", fmt::format("no {}", kIndexFile),
                         "a dataset whose scenes are all done (`retrolux dataset run`)");
  }
  JsonReader json = JsonReader::FromFile(file);
  json.Schema(kIndexSchema);
  DatasetIndex index{json.Raw(), {}};
  index.header.erase("scenes");
  try {
    for (const Json& scene : json.Raw().at("scenes"))
      index.scenes.push_back(DatasetScene::FromJson(scene));
  } catch (const Json::exception& error) {
    throw InputError::At(file, "", error.what(), "an index that `retrolux dataset run` wrote");
  }
  return index;
}

}  // namespace retrolux
