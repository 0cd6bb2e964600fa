// Where a point lies that several cameras see.
//
// Start: the point nearest to all rays (linear least squares of the distances, in mm). Then
// Gauss-Newton on what counts, the distances between seen and projected points in the distorted
// picture, in units of their noise (Hartley and Sturm, "Triangulation", CVIU 68(2), 1997: the
// optimum for normal noise). The covariance is that of the linearised fit.
//
// Outliers: views agree if no residual exceeds `max_residual_px`. If all do not, the largest group
// of views that agree is taken: with n views all groups of n - 1, then of n - 2, ... are tried. A
// group is taken only if it is the only one of its size, so that with two views nothing, and with
// three one wrong view can be told. The limit: an error along the epipolar line of two cameras
// moves the point and leaves no residual.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/camera_model.h"

namespace retrolux {

struct Sighting {
  const CameraModel* camera = nullptr;
  Vec2d px = Vec2d::Zero();  // distorted, as in the picture
  double sigma_px = 0.05;    // its noise, 1 sigma in each of u and v
};

struct TriangulationOptions {
  // Views agree within this. Larger keeps what falling light and curved surfaces do to centroids,
  // smaller finds smaller mistakes.
  double max_residual_px = 1.5;
  double min_angle_deg = 1.0;  // between the two rays that are furthest from parallel
};

struct TriangulatedPoint {
  Vec3d position = Vec3d::Zero();    // world, mm
  Mat3d covariance = Mat3d::Zero();  // mm2
  std::vector<bool> used;            // by sighting
  std::vector<Vec2d> residuals_px;   // seen minus projected, of all sightings
  double rms_px = 0.0;               // of the used ones: root of the mean of both components
};

// A point, or why there is none.
struct Triangulation {
  std::optional<TriangulatedPoint> point;
  std::string refusal;  // "no two of 3 views agree within 1.5 px"; empty with a point
};

// InputError for fewer than two sightings and for rays that are parallel to within
// `min_angle_deg`: such cameras cannot tell where the point is.
Triangulation Triangulate(std::span<const Sighting> sightings, const TriangulationOptions& options);

// The largest angle between two of the rays, rad.
double LargestAngle(std::span<const Ray> rays);

}  // namespace retrolux
