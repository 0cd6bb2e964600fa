// The unit of work of the marker study: one camera in one pose, with all markers at all positions.
#pragma once

#include <nlohmann/json.hpp>

#include "analysis/marker_study.h"

namespace retrolux {

// What a task gives. As JSON it holds every bit of it.
struct MarkerStudyTaskResult {
  struct Kept {
    size_t picture = 0;  // index in `pictures`
    std::string kind;    // as in KeptPicture
    std::string file;    // relative to the study's folder
    std::string hash;    // of its bytes
  };
  std::vector<PictureResult> pictures;  // by marker, then in the order of the positions
  std::vector<Kept> kept;
  int64_t retraced_pixels = 0;

  nlohmann::json ToJson() const;
  // Of the camera and the pose with these indices.
  static MarkerStudyTaskResult FromJson(const nlohmann::json& json, int pose, int camera);
};

// Whether the kept pictures of a result lie in `folder` as they were written: other work may have
// put its own in their places.
bool KeptPicturesAreThere(const nlohmann::json& result, const std::filesystem::path& folder);

// Renders the background, decides all pictures on all threads, and writes those to be kept below
// `folder`. `room` is the scene in its first pose. What the work took is added to `times`; progress
// advances by one for each picture.
MarkerStudyTaskResult RunMarkerStudyTask(const Scene& room, const MarkerStudy& study, int pose,
                                         int camera, const std::vector<GridPosition>& positions,
                                         const std::filesystem::path& folder, Progress& progress,
                                         MarkerStudy::Times& times);

}  // namespace retrolux
