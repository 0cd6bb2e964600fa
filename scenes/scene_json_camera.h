// The "cameras" of a scene file.
#pragma once

#include "core/json_reader.h"
#include "scenes/scene.h"

namespace retrolux {

CameraSpec ReadCamera(JsonReader json);

}  // namespace retrolux
