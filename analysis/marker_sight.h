// Which places on a mask a camera can be counted on to name a marker at, by geometry and by the
// light that comes back, before any picture is rendered.
#pragma once

#include "core/parallel.h"
#include "scenes/scene.h"

namespace retrolux {

// A place on the mask, in the mask object's frame.
struct MarkerPlace {
  Vec3d at = Vec3d::Zero(), normal = Vec3d::UnitX();
};

// Places all over the mask, stratified by area: one for each `place_mm2`.
std::vector<MarkerPlace> CandidatePlaces(const Scene& scene, double place_mm2, uint64_t seed);

// Both hold for the place and eight points of the surface 10 mm around it, where the corners of a
// marker's square lie.
struct SightLimits {
  // Between the normal and the direction to the camera. The default sheeting is as bright as the
  // mask at about 53 degrees.
  double max_incidence_deg = 50.0;
  // Of the brightest to the dimmest of them in the light of the camera's ring. Where the surface
  // bends much, one corner of an oblique marker shines while another sinks into the mask, and no
  // fit explains it. Below a factor of 4 `robust` left 0.3 % of whole markers unnamed, nowhere the
  // same one twice; from 4.2 on some places were lost in every pose (docs/layout.md).
  double max_fall = 4.0;
};

// Which cameras can be counted on at which places in which pose: those with a ring that see the
// nine points, in the frame and not hidden, within the limits.
struct SightTable {
  std::vector<Pose> poses;
  // [pose][camera][place]
  std::vector<std::vector<std::vector<uint8_t>>> seen;
};
SightTable SeePlaces(const Scene& scene, const std::vector<Pose>& poses,
                     const std::vector<MarkerPlace>& places, const Bsdf& sheeting,
                     const SightLimits& limits, Progress& progress);

}  // namespace retrolux
