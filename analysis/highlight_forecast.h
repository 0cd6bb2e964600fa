// Where the rings of other cameras are mirrored in a camera's picture of a mask, and how brightly,
// without tracing light: what tells which pictures are worth a render.
//
// Of the points that the pixel centres show, the one where the coat reflects most of a ring that it
// sees: its BSDF towards the middle of the ring times the ring's irradiance (cross_highlight.h).
// What it leaves out: a ring's width (it takes 1 % off a highlight of roughness 0.15 and half of
// one of 0.02), reflections of reflections, and the picture's edges, where a render shows less of a
// highlight than its brightest point.
#pragma once

#include "renderer/ray_scene.h"

namespace retrolux {

struct HighlightForecast {
  double peak_e = 0.0;                            // 0: no part of the mask that is seen is lit
  std::array<double, 3> at_mm = {0.0, 0.0, 0.0};  // on the surface, world
};

// For each ring of the scene, in the order of its cameras, all of which must have one. `mask`: the
// index of the object; `rays`: the geometry of the scene.
std::vector<HighlightForecast> ForecastHighlights(const Scene& scene, const RayScene& rays,
                                                  const CameraSpec& camera, size_t mask);

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(HighlightForecast, peak_e, at_mm)

}  // namespace retrolux
