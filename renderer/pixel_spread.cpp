#include "renderer/pixel_spread.h"

#include <cmath>

namespace retrolux {

Vec2d SampleCutGaussian(const Vec2f& u) {
  // Share of the Gaussian within r: 1 - exp(-r^2 / 2).
  const double within = -std::expm1(-0.5 * kGaussianCut * kGaussianCut);
  const double r = std::sqrt(-2.0 * std::log1p(-within * static_cast<double>(u.x())));
  const double phi = 2.0 * kPi * static_cast<double>(u.y());
  return {r * std::cos(phi), r * std::sin(phi)};
}

double LineOffset_px(const SensorSpec& sensor) {
  return sensor.scan == Scan::kInterlaced ? -0.5 : 0.0;
}

PixelSpread::PixelSpread(const CameraSpec& camera, double wavelength_nm) {
  if (camera.lens.diffraction) airy_.emplace(camera, wavelength_nm);
  diffusion_px_ = 1e-3 * camera.sensor.charge_diffusion_um / camera.lens.PrincipalDistance_mm() *
                  Vec2d(camera.model.fx, camera.model.fy);
  line_offset_px_ = LineOffset_px(camera.sensor);
}

Vec2d PixelSpread::Sample(PixelSampler& sampler) const {
  Vec2d px = sampler.Next2D().cast<double>() + Vec2d(-0.5, line_offset_px_ - 0.5);
  if (airy_) px += airy_->SampleCore(sampler.Next2D());
  if (diffusion_px_.x() > 0.0)
    px += diffusion_px_.cwiseProduct(SampleCutGaussian(sampler.Next2D()));
  return px;
}

double PixelSpread::Radius_px() const {
  return (airy_ ? airy_->CoreRadius_px() : 0.0) + kGaussianCut * diffusion_px_.maxCoeff() +
         std::abs(line_offset_px_);
}

}  // namespace retrolux
