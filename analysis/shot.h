// A shot: every camera of a scene records once.
#pragma once

#include <filesystem>

#include "renderer/render_files.h"

namespace retrolux {

struct ShotOptions {
  std::vector<std::string> cameras;  // empty: all
  RingChoice rings = RingChoice::kAll;
  TraceOptions trace;
  // Of pixels in which something begins or ends (renderer/edge_pixels.h); the noise of a picture is
  // mostly theirs. 0: four times those of the others.
  int edge_samples_per_pixel = 0;
  uint64_t noise_seed = 1;
  bool ids_only = false;
};

// Renders into `folder`, which is made if need be: NAME.exr and NAME.png a camera, truth.json and
// cameras.yml for the shot. Returns the names of the files. Everything that can be wrong with the
// input is found before the first ray.
std::vector<std::string> RenderShot(const Scene& scene, const ShotOptions& options,
                                    const std::filesystem::path& folder, Progress& progress);

}  // namespace retrolux
