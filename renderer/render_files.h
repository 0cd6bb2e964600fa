// The files that a rendered shot leaves (design of the files: docs/file-formats.md).
#pragma once

#include "core/image_file.h"
#include "renderer/film.h"
#include "renderer/id_pass.h"
#include "renderer/marker_truth.h"

namespace retrolux {

struct ShotInfo {
  std::string scene_name, scene_hash, pose;
  uint64_t seed = 1;
  uint64_t noise_seed = 1;
  int samples_per_pixel = 0;
  int edge_samples_per_pixel = 0;  // of EdgePixels
  double exposure_s = 0.0;
};

// All channels of one camera, with what they mean in the header. Without a film (ids only) the ids
// alone.
ExrImage ShotExr(const CameraSpec& camera, const IdBuffers& ids, const Film* film,
                 const ShotInfo& info, const std::vector<std::string>& body_names,
                 const std::vector<PlacedMarker>& markers,
                 const std::vector<MarkerSpec>& marker_specs);

// truth.json, cameras in the order given.
struct CameraTruth {
  std::string camera;
  std::vector<MarkerView> views;  // one for each marker
};
nlohmann::json TruthJson(const std::vector<CameraTruth>& cameras,
                         const std::vector<PlacedMarker>& markers,
                         const std::vector<MarkerSpec>& marker_specs, const Scene& scene,
                         const ShotInfo& info);

// The key of the noise of one camera's picture.
uint64_t NoiseKey(uint64_t noise_seed, const std::string& picture);

}  // namespace retrolux
