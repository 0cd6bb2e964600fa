#include "analysis/dataset_scene.h"

#include "analysis/dataset_distractors.h"
#include "analysis/dataset_markers.h"
#include "analysis/dataset_recording.h"
#include "analysis/dataset_room.h"
#include "core/atomic_file.h"
#include "core/data_path.h"
#include "core/hash.h"

namespace retrolux {

using Json = nlohmann::json;

SceneObject& ObjectOf(Scene& scene, const std::string& name) {
  return scene.objects[static_cast<size_t>(&scene.Object(name) - scene.objects.data())];
}

DatasetScenes::DatasetScenes(DatasetConfig config) : config_(std::move(config)) {
  for (const MaskChoice& choice : config_.masks)
    masks_.push_back(MakeDatasetMask(choice, config_.file));
}

Json DatasetScenes::Inputs() const {
  Json drawn_from = config_.document;
  for (const char* key : {"$schema", "name", "description", "licence", "scenes"})
    drawn_from.erase(key);
  Json masks = Json::array();
  for (const DatasetMask& mask : masks_) masks.push_back(mask.hash);
  const std::string marker_set = ReadTextFile(DataPath("scenes/data/markers.json"));
  const std::string materials = ReadTextFile(DataPath("materials/data/library.json"));
  return {{"config", drawn_from},
          {"masks", masks},
          {"marker_set", HexHash(HashBytes(marker_set))},
          {"materials", HexHash(HashBytes(materials))}};
}

namespace {

template <typename Item>
std::vector<double> WeightsOf(const std::vector<Item>& items) {
  std::vector<double> weights;
  for (const Item& item : items) weights.push_back(item.weight);
  return weights;
}

}  // namespace

DrawnScene DatasetScenes::Draw(int index) const {
  const SceneDraw draw(config_.seed, static_cast<uint32_t>(index));
  const ViewChoice& view =
      config_.views[PickWeighted(WeightsOf(config_.views), draw.Uniform("view"))];
  const DatasetMask& mask = masks_[PickWeighted(WeightsOf(config_.masks), draw.Uniform("mask"))];
  DrawnScene drawn = DrawRoom(view, mask, draw);
  drawn.name = fmt::format("scene-{:05}", index);
  drawn.scene.name = drawn.name;
  drawn.split = config_.splits[PickWeighted(config_.split_shares, draw.Uniform("split"))];
  DrawMarkers(config_.markers, mask, draw, drawn);
  DrawDistractors(config_.distractors, mask, draw, drawn);
  DrawRecording(config_.recording, draw, drawn);
  CheckScene(drawn.scene, config_.file);
  return drawn;
}

}  // namespace retrolux
