// Bias and scatter of places in the picture.
#pragma once

#include <optional>
#include <vector>

#include "core/conventions.h"

namespace retrolux {

// Of numbers. sigma is the standard deviation (n - 1); 0 of one number.
struct ScalarErrors {
  size_t count = 0;
  double bias = 0.0, sigma = 0.0;
  double p95 = 0.0;  // 95th percentile of the sizes (nearest rank)

  // Of the bias, if the errors do not depend on one another.
  double StandardError() const;
};
ScalarErrors ScalarErrorsOf(const std::vector<double>& errors);

// An error in the picture, px: measured - true.
struct PlaceError {
  Vec2d error = Vec2d::Zero();
  std::optional<Vec2d> tilt;     // unit; the way that the marker's normal points in the picture
  std::optional<Vec2d> outward;  // unit; away from the marker's centre
};

struct PlaceErrors {
  ScalarErrors u, v;           // px, along the picture's axes
  ScalarErrors tilt, outward;  // px, of those errors that have such a direction
  double rms = 0.0;            // px, of the distances: sqrt(mean of u^2 + v^2)
  double p95 = 0.0;            // px, 95th percentile of the distances

  size_t Count() const { return u.count; }
  // Length of the mean error, px. Expect `BiasError` of it from scatter alone.
  double Bias() const { return Vec2d(u.bias, v.bias).norm(); }
  double BiasError() const { return Vec2d(u.StandardError(), v.StandardError()).norm(); }
};
PlaceErrors PlaceErrorsOf(const std::vector<PlaceError>& errors);

// Detected corners against true ones (nothing: of that one nothing is known), both in the marker's
// order; of a triangle, which may begin at any corner, from where they fit best. Empty if the
// numbers differ. `centre_px`: of the marker.
std::vector<PlaceError> CornerErrors(const std::vector<Vec2d>& detected,
                                     const std::vector<std::optional<Vec2d>>& truth,
                                     const Vec2d& centre_px, const std::optional<Vec2d>& tilt);

}  // namespace retrolux
