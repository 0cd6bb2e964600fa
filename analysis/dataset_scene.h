// The scenes of a dataset: scene i follows from the config and i alone.
#pragma once

#include <nlohmann/json.hpp>

#include "analysis/dataset_mask.h"
#include "renderer/lights.h"
#include "scenes/scene.h"

namespace retrolux {

// An ordinary scene, with what it was drawn as.
struct DrawnScene {
  std::string name;   // "scene-00012"
  std::string split;  // train, val or test
  Scene scene;
  std::vector<std::string> cameras;  // that record; the scene's others only give light
  RingChoice rings = RingChoice::kOwn;
  // By name, numbers with their unit in it; null: there is none. What the scene is not asked for is
  // not there.
  nlohmann::json nuisances;
};

// Names of its objects that the parts of a drawn scene share.
inline constexpr const char* kMaskObject = "mask";
inline constexpr const char* kCouchObject = "couch";

// The object of that name, to be changed.
SceneObject& ObjectOf(Scene& scene, const std::string& name);

class DatasetScenes {
 public:
  // Reads what the config names. InputError.
  explicit DatasetScenes(DatasetConfig config);

  const DatasetConfig& Config() const { return config_; }
  // All that the scenes follow from but their number: config and geometry. Without the number of
  // scenes, so that a dataset can grow.
  nlohmann::json Inputs() const;
  DrawnScene Draw(int index) const;

 private:
  DatasetConfig config_;
  std::vector<DatasetMask> masks_;
};

}  // namespace retrolux
