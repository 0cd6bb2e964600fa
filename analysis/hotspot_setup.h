// What the study of hot spots looks at: ring-lit cameras in a row before a mask with markers, and
// the ways in which they may differ from the default.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace retrolux {

struct HotspotSetup {
  std::string mask = "oval";  // or "face"
  // GGX width of the mask's coat. That of a real mask is not measured: 0.1 to 0.3 is plausible,
  // below 0.05 it would be wet or stretched to a gloss.
  double roughness = 0.15;
  std::string sheeting = "retro_bead";
  double ring_radius_mm = 30.0;  // of all rings
  double half_angle_deg = 20.0;  // of all diodes
  double neighbour_nm = 880.0;   // peak of the neighbours' diodes
  double neighbour_fwhm_nm = 80.0;
  double exposure = 1.0;        // in units of the derived one (renderer/exposure.h)
  double veiling_glare = 0.0;   // of the lens
  bool ccd = false;             // blooming, and smear of 1e-5
  int cameras = 2;              // in a row, the first looks
  double distance_mm = 1600.0;  // of all cameras from the isocentre

  void Check() const;  // InputError that names the first parameter out of its range
  nlohmann::json ToJson() const;
};

// The cameras stand in the plane z = 0, `psi_deg` from each to the next, and look at the origin,
// "left" and "right" symmetric about +x, the others beyond "right". The mask carries the six
// identifiable markers and a standard one and is moved by up to 20 mm and turned by up to 10
// degrees about each axis, by `placement` and seed (StereoScene).
Scene HotspotScene(const HotspotSetup& setup, double psi_deg, int placement, uint64_t seed);

// Gives the mask of a room its coat, its markers their sheeting, and every camera its ring, lens
// and sensor, as the setup says, and the room the exposure. What is said of neighbours and of
// number and distance of the cameras is not for rooms. InputError if there is no object "mask".
void FurnishRoom(const HotspotSetup& setup, Scene& scene);

// A change of the setup that the study tries. To add one: a row in the table of hotspot_setup.cpp.
struct HotspotVariation {
  const char* name;
  const char* description;
  void (*change)(HotspotSetup& setup);
};
const std::vector<HotspotVariation>& HotspotVariations();

// Gives a material of the scene another width of its coat; InputError if it has none.
void SetCoatRoughness(Scene& scene, const std::string& material, double roughness);

}  // namespace retrolux
