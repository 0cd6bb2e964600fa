// What a drawn scene has beside mask and markers to fool a detector.
#pragma once

#include "analysis/dataset_scene.h"

namespace retrolux {

// The scene must have its cameras and its markers.
void DrawDistractors(const DistractorRange& range, const DatasetMask& mask, const SceneDraw& draw,
                     DrawnScene& drawn);

}  // namespace retrolux
