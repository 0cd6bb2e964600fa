// The room of a drawn scene: mask, couch, walls and cameras.
#pragma once

#include "analysis/dataset_scene.h"

namespace retrolux {

// Without markers; the cameras that record are named.
DrawnScene DrawRoom(const ViewChoice& view, const DatasetMask& mask, const SceneDraw& draw);

}  // namespace retrolux
