// Figures of one picture's light: levels, highlights, and what each ring does by each mechanism.
#pragma once

#include <nlohmann/json.hpp>

#include "analysis/hotspot_light.h"
#include "renderer/marker_truth.h"

namespace retrolux {

// Which rings are on while a picture is taken, and how brightly. Strobed in turn, each camera
// exposes in its own ring's light: that is `own`.
struct HotspotMix {
  std::string name;
  double own = 1.0, neighbours = 1.0;  // power, relative to that of the scene; the room's is 1
  // An ideal polariser: all mirror-like reflection is gone, nothing else changes. Real crossed
  // polarisers leave some of it, halve the rest, and dim sheeting whose beads keep polarisation.
  bool polarised = false;
  std::string only = "";  // of the neighbours this one's ring alone is on; "": all of them
};

// own, both, neighbour; own and both with the polariser; then both at the other powers.
std::vector<HotspotMix> HotspotMixes(const std::vector<double>& powers);
// The one without neighbours that a mix is compared with.
const char* ReferenceOf(const HotspotMix& mix);

// The mean signal of the picture, e-.
FloatPlane Mixed(const HotspotLight& light, const HotspotMix& mix);

// Where a marker is in the picture, and the pixels on and around it.
struct HotspotMarker {
  int number = 0;
  Vec2d centre_px = Vec2d::Zero();
  Polygon hull_px;             // of its projected outline
  std::vector<size_t> inside;  // pixels that show nothing else
  std::vector<size_t> around;  // of the bare mask, up to a marker's half size beyond it
};

// The markers of the scene that the camera sees wholly.
std::vector<HotspotMarker> HotspotMarkers(const Scene& scene, const RayScene& rays,
                                          const CameraModel& camera, const HotspotLight& light);

// Means over the markers, but for peaks and counts. e-, px.
struct HotspotLevels {
  double peak_e = 0.0;             // of the bare mask
  double saturated_px = 0.0;       // of the whole picture: mean signal at or above the full well
  double saturated_mask_px = 0.0;  // of these, bare mask
  double background_e = 0.0;  // around markers: a plane is fitted to it, and taken at their centres
  double gradient_e_px = 0.0;  // slope of that plane
  double marker_e = 0.0;
  double contrast = 0.0;   // (marker - background) / background
  double marker_px = 0.0;  // pixels that show nothing but a marker, of each
  double background_noise_e = 0.0, marker_noise_e = 0.0;  // 1 sigma of a pixel of that level
};
HotspotLevels LevelsOf(const FloatPlane& signal, const HotspotLight& light, size_t mask,
                       const std::vector<HotspotMarker>& markers, const SensorSpec& sensor);

// A mirror-like reflection on the bare mask: of the pixels at half its peak or more, after a 3 x 3
// median (single paths of several reflections are brighter than any highlight). Peak 0: none.
struct Highlight {
  double peak_e = 0.0;
  double area_px = 0.0;
  std::array<double, 2> at_px = {0.0, 0.0};       // their centroid
  std::array<double, 3> at_mm = {0.0, 0.0, 0.0};  // on the surface, world
};
Highlight HighlightOf(const FloatPlane& bare_glints, const IdBuffers& ids, size_t mask);

// What one ring does to the picture, e-: means over the markers' pixels, or over those around them.
struct RingLight {
  std::string name;
  double separation_deg = 0.0;  // of its camera, seen from the origin; 0: the own ring
  Highlight highlight;          // on the bare mask
  double beam_e = 0.0;          // around markers: the mask's body
  double gloss_e = 0.0;         // around markers: the mask's coat
  double lobe_e = 0.0;          // on markers: the retro-reflective lobe
  double sheet_e = 0.0;         // on markers: body of the sheeting
  double cover_e = 0.0;         // on markers: its cover
  double direct_px = 0.0;       // pixels that show the ring itself
  double direct_peak_e = 0.0;   // the brightest of them
};
std::vector<RingLight> RingsOf(const Scene& scene, const RayScene& rays, const CameraSpec& camera,
                               size_t mask, const HotspotLight& light,
                               const std::vector<FloatPlane>& bare_glints,
                               const std::vector<HotspotMarker>& markers);

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(HotspotLevels, peak_e, saturated_px, saturated_mask_px,
                                   background_e, gradient_e_px, marker_e, contrast, marker_px,
                                   background_noise_e, marker_noise_e)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Highlight, peak_e, area_px, at_px, at_mm)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RingLight, name, separation_deg, highlight, beam_e, gloss_e,
                                   lobe_e, sheet_e, cover_e, direct_px, direct_peak_e)

}  // namespace retrolux
