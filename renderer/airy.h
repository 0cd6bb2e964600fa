// Diffraction by a round aperture: the Airy pattern on the sensor (Born and Wolf, Principles of
// Optics, section 8.5.2). With v = pi r / (lambda N), N the working f-number:
//   energy within radius r    E(v) = 1 - J0(v)^2 - J1(v)^2
//   energy per unit of v      2 J1(v)^2 / v
#pragma once

#include "core/plane.h"
#include "scenes/scene.h"

namespace retrolux {

double AiryEncircledEnergy(double v);

// Split at its fifth dark ring (v = 16.4706, 96 % of the energy). The core is drawn from sample by
// sample: inside a pixel it must be exact. The tail is smooth over a pixel but reaches far, and a
// few samples that stray into a bright marker would speckle the dark around it, so it is a kernel
// to convolve pictures with (renderer/lens_scatter.h).
class AiryDisc {
 public:
  // `wavelength_nm`: one for the whole picture, the mean of what the camera records.
  AiryDisc(const CameraSpec& camera, double wavelength_nm);

  // A displacement in px with the density of the core, for u uniform on the unit square.
  Vec2d SampleCore(const Vec2f& u) const;
  double CoreRadius_px() const { return core_radius_px_; }
  static double TailShare();
  // The tail out to v = 200, beyond which 0.3 % of the energy lie (made up for by the rest), over
  // the pixels around the middle one: odd sides, sum 1.
  FloatPlane TailKernel() const;

 private:
  double px_per_v_;         // along the columns
  double rows_per_column_;  // a px along y over one along x, of the same length on the sensor
  double core_radius_px_;
  std::vector<float> core_v_;  // at equal steps of energy
};

}  // namespace retrolux
