// Brown-Conrady lens distortion with OpenCV's coefficients, on the plane z = 1 of the camera frame
// (x = X / Z, y = Y / Z):
//   r2 = x^2 + y^2,   radial = 1 + k1 r2 + k2 r2^2 + k3 r2^3
//   x_d = x radial + 2 p1 x y + p2 (r2 + 2 x^2)
//   y_d = y radial + p1 (r2 + 2 y^2) + 2 p2 x y
// (OpenCV documentation, calib3d; Brown, Photogrammetric Engineering 37(8), 1971).
#pragma once

#include <array>
#include <limits>
#include <optional>

#include "core/conventions.h"

namespace retrolux {

class Distortion {
 public:
  Distortion() = default;  // none
  Distortion(double k1, double k2, double p1, double p2, double k3);

  bool operator==(const Distortion&) const = default;
  bool IsNone() const { return *this == Distortion(); }
  // In OpenCV's order: k1, k2, p1, p2, k3.
  std::array<double, 5> Coefficients() const { return {k1_, k2_, p1_, p2_, k3_}; }

  // Where an ideal lens's point (x, y) really falls.
  Vec2d Apply(const Vec2d& ideal) const;
  // d(x_d, y_d) / d(x, y) there. Its determinant is by how much the lens stretches areas.
  Eigen::Matrix2d Jacobian(const Vec2d& ideal) const;
  // The inverse of Apply, to the last digits (Newton). Nothing where no point within LargestRadius
  // maps there.
  std::optional<Vec2d> Remove(const Vec2d& distorted) const;
  // The radius at which the radial part turns back, infinite if it never does. Further out Apply
  // still gives numbers, but no lens brings light there.
  double LargestRadius() const { return largest_radius_; }

 private:
  double k1_ = 0.0, k2_ = 0.0, p1_ = 0.0, p2_ = 0.0, k3_ = 0.0;
  double largest_radius_ = std::numeric_limits<double>::infinity();
};

}  // namespace retrolux
