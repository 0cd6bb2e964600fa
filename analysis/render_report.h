// report.html of a folder that `retrolux render` wrote: the pictures, the markers in them, the
// room.
#pragma once

#include <optional>

#include "analysis/report.h"
#include "scenes/scene.h"

namespace retrolux {

// `scene`: what was rendered, in its pose, for the room; the report says so if there is none.
// InputError if the folder has no truth.json.
Report RenderReport(const std::filesystem::path& folder, const std::optional<Scene>& scene,
                    const std::string& command);

}  // namespace retrolux
