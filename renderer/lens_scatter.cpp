#include "renderer/lens_scatter.h"

#include <algorithm>
#include <numeric>
#include <opencv2/imgproc.hpp>

namespace retrolux {

LensScatter::LensScatter(const CameraSpec& camera, double wavelength_nm)
    : glare_(static_cast<float>(camera.lens.veiling_glare)) {
  if (!camera.lens.diffraction) return;
  tail_ = AiryDisc(camera, wavelength_nm).TailKernel();
  tail_share_ = static_cast<float>(AiryDisc::TailShare());
}

void LensScatter::Apply(FloatPlane& plane) const {
  if (IsNone()) return;
  const double mean = std::accumulate(plane.data.begin(), plane.data.end(), 0.0) /
                      static_cast<double>(plane.data.size());
  FloatPlane tail(plane.width, plane.height);
  if (!tail_.data.empty()) {
    const auto view = [](const FloatPlane& p) {
      return cv::Mat(p.height, p.width, CV_32F, const_cast<float*>(p.data.data()));
    };
    cv::Mat out = view(tail);
    cv::filter2D(view(plane), out, CV_32F, view(tail_), {-1, -1}, 0.0, cv::BORDER_REPLICATE);
  }
  const float veil = glare_ * static_cast<float>(mean);
  for (size_t i = 0; i < plane.data.size(); ++i) {
    // Through a Fourier transform, the tail may come out a rounding below zero.
    const float sharp =
        (1.0f - tail_share_) * plane.data[i] + tail_share_ * std::max(0.0f, tail.data[i]);
    plane.data[i] = (1.0f - glare_) * sharp + veil;
  }
}

void LensScatter::Apply(Film& film) const {
  if (IsNone()) return;
  std::fill(film.electrons.data.begin(), film.electrons.data.end(), 0.0f);
  for (FloatPlane& group : film.group_electrons) {
    Apply(group);
    for (size_t i = 0; i < group.data.size(); ++i) film.electrons.data[i] += group.data[i];
  }
  Apply(film.radiance);
  const float stays = (1.0f - glare_) * (1.0f - tail_share_);
  for (float& variance : film.variance.data) variance *= stays * stays;
}

}  // namespace retrolux
