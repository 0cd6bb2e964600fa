// The treatment vault of a scenario as a scene to be rendered: what a placement of cameras records.
#pragma once

#include "scenes/rig_layout.h"
#include "scenes/scene.h"

namespace retrolux {

// Cameras "camera-1" .. of a placement with filter and diode ring, the object "mask" turned, each
// beam's nozzle ("snout-NAME" and "nozzle-NAME") where that orientation lets it stand, in a plain
// room. InputError for a mask that the scenario does not have or whose mesh can't be read.
Scene VaultScene(const Scenario& scenario, const Placement& placement, const std::string& mask_name,
                 const MaskRotation& rotation);

}  // namespace retrolux
