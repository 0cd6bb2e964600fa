// A placement of the treatment vault (solution.json of `study vault`) as the study of hot spots
// needs it.
#pragma once

#include "analysis/hotspot_setup.h"
#include "scenes/rig_layout.h"

namespace retrolux {

struct HotspotVault {
  Scenario scenario;
  Placement placement;
  std::string mask;  // of the scenario
  std::vector<MaskRotation> rotations;
};

// The placement of a solution.json in the vault of its simulation, with its mask (without one: the
// face). `scenario`, a name or a file, takes the place of the solution's simulation, which need not
// be a built-in one; "": none. InputError, also for a placement that cannot be built and a mask
// that no places of markers are known of.
HotspotVault ReadHotspotVault(const std::filesystem::path& solution, const std::string& scenario);

// The vault with its mask turned and the markers of the built-in scene `face` or `body` on it: the
// six identifiable ones and a standard one. Coat, sheeting, rings, lenses, sensors and exposure as
// the setup says (FurnishRoom).
Scene HotspotVaultScene(const HotspotVault& vault, const MaskRotation& rotation,
                        const HotspotSetup& setup);

}  // namespace retrolux
