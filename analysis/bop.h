// A dataset in the form of BOP (Benchmark for 6D Object Pose Estimation): one folder a scene.
#pragma once

#include "analysis/dataset.h"

namespace retrolux {

// FOLDER/bop/SPLIT/SCENE/ with scene_camera.json, scene_gt.json, scene_gt_info.json, gray/, mask/,
// mask_visib/, and FOLDER/bop/dataset_info.json, which says units, axes and pixel origin. Image i
// is the scene's camera i, in its order; obj_id is 1 + number, as COCO's categories. Returns the
// scenes' folders.
std::vector<std::filesystem::path> ExportBop(const DatasetIndex& index,
                                             const std::filesystem::path& folder);

}  // namespace retrolux
