// Many pictures that differ by one marker: what the marker does not change is rendered once.
//
// The background of a camera is rendered without a marker. For a picture with one, only the pixels
// that can show it are traced again, with the random numbers that they would have in a full render;
// all others keep their background value. What is left out is the light that the marker throws onto
// other surfaces: far below the noise of a pixel (tests/composed_picture_test.cpp; figures in
// docs/physics.md).
#pragma once

#include "renderer/lens_scatter.h"
#include "renderer/marker_truth.h"

namespace retrolux {

class ComposedCamera {
 public:
  // `scene` has no markers; it and `rays` must outlive the object. Renders the background on all
  // threads.
  ComposedCamera(const Scene& scene, const RayScene& rays, const CameraSpec& camera,
                 RingChoice rings, const TraceOptions& options, Progress& progress);

  // The noiseless mean signal with the marker. `retraced`, if not null, receives the number of
  // pixels traced.
  FloatPlane Signal(const PlacedMarker& marker, const MarkerSurface& surface,
                    int64_t* retraced = nullptr) const;

  const FloatPlane& Background() const { return background_; }
  const CameraSpec& Camera() const { return response_.Camera(); }
  double ExposureSeconds() const { return response_.ExposureSeconds(); }

 private:
  // How far the lens spreads what lies at the marker's depth.
  double Blur_px(const MarkerSurface& surface) const;

  const Scene& scene_;
  const RayScene& rays_;
  Lights lights_;
  CameraResponse response_;
  LensRays lens_;
  LensScatter scatter_;
  double spread_px_;  // beyond a pixel's square, further than which only scatter_ goes
  TraceOptions options_;
  FloatPlane traced_background_;  // before the lens's scatter
  FloatPlane background_;
};

// Pixels whose box can show the marker: those within a margin of the convex hull of its projected
// surface. `blur_px`: how far from where it falls the lens spreads a point.
std::vector<Eigen::Vector2i> PixelsThatCanShow(const MarkerSurface& surface,
                                               const CameraModel& camera, double blur_px = 0.0);

}  // namespace retrolux
