#include "renderer/airy.h"

#include <algorithm>
#include <cmath>

namespace retrolux {

namespace {

constexpr double kCore = 16.470630050877634;  // fifth zero of J1
constexpr double kLast = 200.0;

// The smallest v with the energy e within it, by bisection: E grows with v.
double InverseEncircledEnergy(double e) {
  double low = 0.0, high = kCore;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (AiryEncircledEnergy(middle) < e ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Energy per unit of area in the plane of v.
double Density(double v) {
  const double j1 = std::cyl_bessel_j(1.0, v);
  return j1 * j1 / (kPi * v * v);
}

}  // namespace

double AiryEncircledEnergy(double v) {
  const double j0 = std::cyl_bessel_j(0.0, v), j1 = std::cyl_bessel_j(1.0, v);
  return 1.0 - j0 * j0 - j1 * j1;
}

double AiryDisc::TailShare() {
  return 1.0 - AiryEncircledEnergy(kCore);
}

AiryDisc::AiryDisc(const CameraSpec& camera, double wavelength_nm) {
  constexpr int kEntries = 2049;
  const double principal_mm = camera.lens.PrincipalDistance_mm();
  const double working_f_number = 0.5 * principal_mm / camera.lens.ApertureRadius_mm();
  const double mm_per_v = 1e-6 * wavelength_nm * working_f_number / kPi;
  px_per_v_ = mm_per_v * camera.model.fx / principal_mm;
  rows_per_column_ = camera.model.fy / camera.model.fx;
  core_radius_px_ = kCore * px_per_v_ * std::max(1.0, rows_per_column_);
  for (int i = 0; i < kEntries; ++i) {
    const double share = static_cast<double>(i) / (kEntries - 1);
    core_v_.push_back(
        static_cast<float>(InverseEncircledEnergy(share * AiryEncircledEnergy(kCore))));
  }
}

Vec2d AiryDisc::SampleCore(const Vec2f& u) const {
  const float place = u.x() * static_cast<float>(core_v_.size() - 1);
  const size_t i = std::min(static_cast<size_t>(place), core_v_.size() - 2);
  const float v = core_v_[i] + (place - static_cast<float>(i)) * (core_v_[i + 1] - core_v_[i]);
  const double r = static_cast<double>(v) * px_per_v_;
  const double phi = 2.0 * kPi * static_cast<double>(u.y());
  return {r * std::cos(phi), rows_per_column_ * r * std::sin(phi)};
}

FloatPlane AiryDisc::TailKernel() const {
  constexpr int kCells = 16;  // a side of a pixel
  const int half_x = std::max(1, static_cast<int>(std::ceil(kLast * px_per_v_)));
  const int half_y = std::max(1, static_cast<int>(std::ceil(kLast * px_per_v_ * rows_per_column_)));
  FloatPlane kernel(2 * half_x + 1, 2 * half_y + 1);
  const auto pixel = [&](int x, int y) {
    double sum = 0.0;
    for (int i = 0; i < kCells; ++i) {
      for (int j = 0; j < kCells; ++j) {
        const double v = std::hypot(x + (i + 0.5) / kCells - 0.5,
                                    (y + (j + 0.5) / kCells - 0.5) / rows_per_column_) /
                         px_per_v_;
        if (v > kCore && v < kLast) sum += Density(v);
      }
    }
    return sum;
  };
  double total = 0.0;
  std::vector<double> sums;
  for (int y = 0; y <= half_y; ++y) {
    for (int x = 0; x <= half_x; ++x) {
      sums.push_back(pixel(x, y));
      total += sums.back() * (x > 0 ? 2.0 : 1.0) * (y > 0 ? 2.0 : 1.0);
    }
  }
  for (int y = -half_y; y <= half_y; ++y) {
    for (int x = -half_x; x <= half_x; ++x) {
      const auto i = static_cast<size_t>(std::abs(y) * (half_x + 1) + std::abs(x));
      kernel(x + half_x, y + half_y) = static_cast<float>(total > 0.0 ? sums[i] / total : 0.0);
    }
  }
  return kernel;
}

}  // namespace retrolux
