// The pictures of one drawn scene, rendered and labelled.
#pragma once

#include <atomic>
#include <filesystem>

#include "analysis/dataset_scene.h"
#include "analysis/marker_label.h"

namespace retrolux {

struct RecordOptions {
  uint64_t seed = 1;          // of light transport and noise
  int samples_per_pixel = 8;  // see SparseSamples; four times as many on markers and at nodes
  bool keep_exr = false;
};

// A picture with its labels, as a dataset holds it.
struct DatasetPicture {
  std::string camera;
  std::string file;      // below the dataset's folder
  std::string hash;      // of its bytes
  std::string exr_hash;  // of exr/SCENE_CAMERA.exr; empty: not kept
  CameraModel model;
  int bits = 8;
  double exposure_s = 0.0;
  std::vector<MarkerLabel> markers;

  nlohmann::json ToJson() const;
  static DatasetPicture FromJson(const nlohmann::json& json);
};

// Where the time went, s, summed over threads.
struct RecordTimes {
  std::atomic<double> geometry = 0.0, trace = 0.0, sensor = 0.0, encode = 0.0, write = 0.0,
                      labels = 0.0;
  std::atomic<int64_t> pictures = 0, paths = 0, traced_pixels = 0, pixels = 0;

  double All() const { return geometry + trace + sensor + encode + write + labels; }
};

// Writes images/SCENE_CAMERA.png (and exr/SCENE_CAMERA.exr) below `folder`, and returns what
// belongs to them. `times` is added to.
std::vector<DatasetPicture> RecordScene(const DrawnScene& drawn, const RecordOptions& options,
                                        const std::filesystem::path& folder, RecordTimes& times);

}  // namespace retrolux
