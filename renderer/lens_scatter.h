// What the lens spreads over the picture beyond a few pixels: the tail of the Airy pattern, and the
// veil of stray light.
//
//   picture = (1 - g) ((1 - t) p + t K * p) + g mean(p)
//
// with g the share of the veil (Lens::veiling_glare), t and K the tail of renderer/airy.h. Linear,
// so light groups stay groups. What lies outside the picture is taken to be as bright as its edge.
#pragma once

#include <optional>

#include "renderer/airy.h"
#include "renderer/film.h"

namespace retrolux {

class LensScatter {
 public:
  // `wavelength_nm` as for AiryDisc.
  LensScatter(const CameraSpec& camera, double wavelength_nm);

  bool IsNone() const { return tail_.data.empty() && glare_ == 0.0f; }
  void Apply(FloatPlane& plane) const;
  // The electrons of all groups and the radiance; the variance falls by the square of what stays.
  void Apply(Film& film) const;

 private:
  FloatPlane tail_;  // empty: no diffraction
  float tail_share_ = 0.0f;
  float glare_;
};

}  // namespace retrolux
