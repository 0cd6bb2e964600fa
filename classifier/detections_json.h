// detections.json: what was found in which picture (scenes/schema/detections-1.schema.json).
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "classifier/detection.h"
#include "core/marker_set.h"

namespace retrolux {

struct PictureDetections {
  std::string file;    // as the user or the study named it
  std::string camera;  // the file's name without its extension, unless known better
  std::vector<Detection> detections;
};

nlohmann::ordered_json DetectionsJson(const std::string& method,
                                      const std::vector<PictureDetections>& pictures);

// Written whole or not at all.
void WriteDetections(const std::filesystem::path& file, const std::string& method,
                     const std::vector<PictureDetections>& pictures);

struct DetectionsFile {
  std::string method;  // that all detections name; empty: none, or several
  std::vector<PictureDetections> pictures;
};

// A file of ours or of another detector. `schema`, `pixel_origin` and of each detection `marker`
// and `centroid_px` must be there; absent: no corners, confidence 1, method "", 0 edges, 0 px2.
// InputError with the place.
DetectionsFile ReadDetections(const std::filesystem::path& file, const MarkerSet& markers);

}  // namespace retrolux
