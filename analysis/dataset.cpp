#include "analysis/dataset.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <functional>
#include <map>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/file_below.h"
#include "core/json_reader.h"

namespace retrolux {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

constexpr const char* kIndexFile = "dataset.json";
constexpr const char* kIndexSchema = "retrolux/dataset-index-1";

// Files that the config names, below its folder, go along.
void CopyMasks(const DatasetConfig& config, const fs::path& folder) {
  for (const MaskChoice& mask : config.masks) {
    const fs::path from = config.file.parent_path();
    if (!fs::path(mask.mesh).has_extension()) continue;
    if (const auto found = ObjectionToFile(from, mask.mesh))
      throw InputError::At(config.file, "/masks", *found, "a file below the folder of the config");
    fs::create_directories((folder / mask.mesh).parent_path());
    WriteTextFile(folder / mask.mesh, ReadTextFile(from / mask.mesh));
  }
}

// Counts over all results, one at a time.
Json HeaderOf(const DatasetPlan& plan) {
  const DatasetConfig& config = plan.Config();
  std::map<std::string, std::array<int64_t, 3>> counts;  // scenes, pictures, markers
  for (const std::string& split : config.splits) counts[split] = {};
  for (size_t i = 0; i < plan.Tasks().size(); ++i) {
    const DatasetScene scene = plan.Read(i);
    auto& [scenes, pictures, markers] = counts[scene.split];
    ++scenes;
    for (const DatasetPicture& picture : scene.pictures) {
      ++pictures;
      markers += std::count_if(picture.markers.begin(), picture.markers.end(),
                               [](const MarkerLabel& label) { return label.visible.Area() > 0; });
    }
  }
  Json splits = Json::object();
  int64_t all_pictures = 0, all_markers = 0;
  for (const auto& [split, count] : counts) {
    const auto& [scenes, pictures, markers] = count;
    splits[split] = {{"scenes", scenes}, {"pictures", pictures}, {"markers", markers}};
    all_pictures += pictures;
    all_markers += markers;
  }
  return {{"schema", kIndexSchema},
          {"version", RETROLUX_VERSION},
          {"name", config.name},
          {"description", config.description},
          {"licence", config.licence},
          {"seed", config.seed},
          {"spp", plan.Recording().samples_per_pixel},
          {"units", "px, mm, deg, s, e-"},
          {"pixel_origin", "center"},
          {"axes",
           "pixels: x right, y down, (0, 0) the centre of the top-left pixel; camera: x right, y "
           "down, z forward, x_camera = R x_world + t; marker: z along the outward normal; masks: "
           "COCO's run lengths, column by column"},
          {"splits", splits},
          {"pictures", all_pictures},
          {"markers", all_markers}};
}

// Writes the config and its masks into the folder. What was made of another text is no index of it.
void CopyPlan(const DatasetConfig& config, const fs::path& folder) {
  CopyMasks(config, folder);
  const fs::path copy = folder / kDatasetConfigFile;
  const std::string text = ReadTextFile(config.file);
  if (fs::exists(copy) && ReadTextFile(copy) != text) fs::remove(folder / kIndexFile);
  WriteTextFile(copy, text);
}

// What other runs have done counts if its pictures are there; those of this one's own choice have
// been read.
void MissPictures(const DatasetPlan& plan, const DatasetRunOptions& options, DatasetState& state) {
  if (!options.chosen) return;
  for (size_t i = 0; i < state.done.size(); ++i) {
    if (!state.done[i] || options.chosen(i)) continue;
    for (const DatasetPlan::File& file : plan.FilesOf(plan.Result(i)))
      state.done[i] = state.done[i] && fs::exists(plan.Folder() / file.name);
  }
}

}  // namespace

size_t DatasetState::ScenesDone() const {
  return static_cast<size_t>(std::count(done.begin(), done.end(), true));
}

void PlanDataset(const fs::path& config_file, const fs::path& folder, const RecordChoice& choice) {
  const DatasetScenes scenes(ReadDatasetConfig(config_file));
  scenes.Draw(0);  // what can't be drawn shows here, not after hours
  const RecordOptions recording = RecordingOf(scenes.Config(), folder, choice);
  // Settles what the folder is for, before another run's config is replaced.
  const TaskManifest begun(TaskStore(folder, kDatasetStudy, DatasetInputs(scenes, recording)));
  CopyPlan(scenes.Config(), folder);
  DatasetRunOptions none{choice, [](size_t) { return false; }, {}};
  RecordTimes times;
  RunDataset(folder, none, NoProgress(), times);
}

DatasetState RunDataset(const fs::path& folder, const DatasetRunOptions& options,
                        Progress& progress, RecordTimes& times) {
  const DatasetPlan plan(folder, options.recording);
  TaskLoop loop;
  loop.unit = "scenes";
  loop.chosen = options.chosen;
  loop.until = options.until;
  loop.usable = [&](const Json& result) { return plan.FaultOf(result).empty(); };
  TaskManifest manifest(plan.Store());
  EnsureWritableFolder(folder / "images");
  if (plan.Recording().keep_exr) EnsureWritableFolder(folder / "exr");
  DatasetState state;
  state.done = manifest.Do(
      "scenes", plan.Tasks(),
      [&](size_t task) {
        const DrawnScene drawn = plan.Scenes().Draw(static_cast<int>(task));
        DatasetScene scene{drawn.name, drawn.split, drawn.nuisances,
                           RecordScene(drawn, plan.Recording(), folder, times)};
        return scene.ToJson();
      },
      progress, loop);
  state.tasks = manifest.Report();
  MissPictures(plan, options, state);
  return state;
}

DatasetState StateOf(const DatasetPlan& plan) {
  DatasetState state;
  for (size_t i = 0; i < plan.Tasks().size(); ++i) {
    state.done.push_back(plan.HasResult(i));
    if (state.done.back()) continue;
    const std::string failure = plan.Failure(i);
    if (!failure.empty())
      state.failures.push_back(fmt::format("{} (number {}): {}", plan.Tasks()[i].name, i, failure));
  }
  return state;
}

namespace {

// The text of dataset.json, piece by piece, as the results say it.
void ComposeIndex(const DatasetPlan& plan, const std::function<void(std::string_view)>& append) {
  std::string header = HeaderOf(plan).dump(1);
  header.resize(header.size() - 2);  // the line with the closing brace
  append(header + ",\n \"scenes\": [");
  for (size_t i = 0; i < plan.Tasks().size(); ++i)
    append((i > 0 ? ",\n" : "\n") + plan.Read(i).ToJson().dump());
  append("\n]}\n");
}

}  // namespace

void WriteDatasetIndex(const DatasetPlan& plan) {
  FileWriter file(plan.Folder() / kIndexFile);
  ComposeIndex(plan, [&](std::string_view text) { file.Append(text); });
  file.Commit();
}

bool IsIndexOf(const DatasetPlan& plan) {
  std::ifstream stream(plan.Folder() / kIndexFile, std::ios::binary);
  bool same = true;
  std::string found;
  ComposeIndex(plan, [&](std::string_view expected) {
    found.resize(expected.size());
    same = same && stream.read(found.data(), static_cast<std::streamsize>(found.size())) &&
           found == expected;
  });
  return same && stream.peek() == std::ifstream::traits_type::eof();
}

DatasetIndex ReadDatasetIndex(const fs::path& folder) {
  const fs::path file = folder / kIndexFile;
  if (!fs::exists(file)) {
    throw InputError::At(folder, "", fmt::format("no {}", kIndexFile),
                         "a dataset whose scenes are all done (`retrolux dataset run`)");
  }
  // Each scene is turned into its struct as it is read: as JSON all of them would take ten times
  // the memory.
  DatasetIndex index;
  std::string key;
  const auto take = [&](int depth, Json::parse_event_t event, Json& parsed) {
    if (depth == 1 && event == Json::parse_event_t::key) key = parsed.get<std::string>();
    if (depth != 2 || event != Json::parse_event_t::object_end || key != "scenes") return true;
    index.scenes.push_back(DatasetScene::FromJson(parsed));
    return false;
  };
  try {
    std::ifstream stream(file, std::ios::binary);
    index.header = Json::parse(stream, take);
  } catch (const Json::exception& error) {
    throw InputError::At(file, "", error.what(), "an index that `retrolux dataset run` wrote");
  }
  JsonReader::FromText(index.header.dump(), file).Schema(kIndexSchema);
  index.header.erase("scenes");
  return index;
}

}  // namespace retrolux
