// How far from a pixel the light may fall that the pixel counts: its own square, the core of the
// lens's diffraction, and charge that diffuses sideways in the sensor before it is collected.
// Drawn sample by sample; ids stay those of the pixel's centre.
//
// With interlaced scan row y of the picture is the sum of the photosites' lines y and y + 1
// (renderer/sensor_fields.h). So that the rows lie where the camera matrix says, line y is the one
// half a row above.
#pragma once

#include "core/sampler.h"
#include "renderer/airy.h"

namespace retrolux {

// Of the photosites' line y from row y of the picture, px: 0, or -0.5 with interlaced scan.
double LineOffset_px(const SensorSpec& sensor);

class PixelSpread {
 public:
  // `wavelength_nm` as for AiryDisc.
  PixelSpread(const CameraSpec& camera, double wavelength_nm);

  // A displacement from the pixel's centre, px.
  Vec2d Sample(PixelSampler& sampler) const;
  // How far beyond the pixel's square it may go, px.
  double Radius_px() const;

 private:
  std::optional<AiryDisc> airy_;
  Vec2d diffusion_px_;           // 1 sigma along columns and rows
  double line_offset_px_ = 0.0;  // of the photosite from the pixel, along the rows
};

// Of a round Gaussian, cut at kGaussianCut sigma (where 3e-4 of it are left) and made up for: in
// units of sigma, for u uniform on the unit square.
inline constexpr double kGaussianCut = 4.0;
Vec2d SampleCutGaussian(const Vec2f& u);

}  // namespace retrolux
