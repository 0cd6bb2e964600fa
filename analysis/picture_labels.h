// The labels of one picture, from its geometry and its noiseless film.
#pragma once

#include "analysis/marker_label.h"
#include "renderer/film.h"
#include "renderer/id_pass.h"
#include "renderer/marker_truth.h"

namespace retrolux {

// A marker of a scene, as all of its cameras share it.
struct LabelledMarker {
  const MarkerSpec* spec = nullptr;
  PlacedMarker placed;
  MarkerSurface surface;
  std::vector<std::optional<SurfaceHit>> corners;  // nothing where the surface ends
};
// `scene` must outlive the result.
std::vector<LabelledMarker> LabelledMarkers(const Scene& scene, const RayScene& rays);

// Every marker that shows a pixel, or would if nothing hid it. Fails (our own fault) unless the
// labels' visible masks, put together, are id.marker pixel by pixel.
std::vector<MarkerLabel> LabelPicture(const std::vector<LabelledMarker>& markers,
                                      const RayScene& rays, const CameraSpec& camera,
                                      const IdBuffers& ids, const Film& film, double exposure_s);

}  // namespace retrolux
