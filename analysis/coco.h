// A dataset's labels in the form of COCO: boxes, run-length masks, keypoints.
#pragma once

#include "analysis/dataset.h"

namespace retrolux {

// `split`'s pictures as COCO's instances and keypoints in one file; markers with a visible pixel.
// Category 1 + number: 1 the standard marker, 2 .. the identifiable ones; its keypoints are the
// corners of its shape. Boxes, areas and "segmentation" are of the visible pixels, "amodal" of the
// whole outline. Coordinates: "info" of the file.
nlohmann::json CocoJson(const DatasetIndex& index, const std::string& split);

// FOLDER/coco/SPLIT.json for each split that has pictures. Returns the files.
std::vector<std::filesystem::path> ExportCoco(const DatasetIndex& index,
                                              const std::filesystem::path& folder);

}  // namespace retrolux
