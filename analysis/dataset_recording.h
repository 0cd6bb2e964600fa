// How the cameras of a drawn scene record it: sensor, focus, light, exposure.
#pragma once

#include "analysis/dataset_scene.h"

namespace retrolux {

// Last of the parts: the exposure follows from the scene's sheeting and cameras.
void DrawRecording(const RecordingRange& range, const SceneDraw& draw, DrawnScene& drawn);

}  // namespace retrolux
