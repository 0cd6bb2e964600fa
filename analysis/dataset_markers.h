// The markers of a drawn scene, on the side of the mask that its cameras can see.
#pragma once

#include "analysis/dataset_scene.h"

namespace retrolux {

// The scene must have its mask and its cameras. Where there is no room for a marker it is left out.
void DrawMarkers(const MarkerRange& range, const DatasetMask& mask, const SceneDraw& draw,
                 DrawnScene& drawn);

}  // namespace retrolux
