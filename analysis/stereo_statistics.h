// Errors of markers in space, from what a pair of cameras found of markers whose places are known.
// Axes: depth (along the bisector of the cameras' axes, towards them), across (in the plane of the
// axes), up (off that plane): with StereoPair the world's x, y, z. All in mm unless named px.
#pragma once

#include "analysis/stereo_bench.h"
#include "classifier/marker_point.h"

namespace retrolux {

struct SpatialError {
  int64_t expected = 0, found = 0;       // markers in exposures; found: named by both cameras
  double rms = 0.0;                      // of the distance from the truth
  double rms_low = 0.0, rms_high = 0.0;  // 95 % interval; markers in placements are independent
  Vec3d axis_rms = Vec3d::Zero();        // depth, across, up
  Vec3d bias = Vec3d::Zero();            // mean error
  Vec3d noise = Vec3d::Zero();           // 1 sigma over the exposures of a placement
  double noise_px = 0.0;                 // 1 sigma of u and v over the exposures
};
SpatialError SpatialErrorOf(const std::array<CameraModel, 2>& cameras,
                            const std::vector<StereoShot>& shots, MarkerPoint point);

// What becomes of the marker's place from one stage of the measurement to the next.
struct BudgetLine {
  std::string stage;
  double rms_px = 0.0;            // root of the mean square, of both components together
  double rms_mm = 0.0;            // of the step that the triangulated point makes
  Vec3d bias_mm = Vec3d::Zero();  // its mean
};

// The way of the centroid: geometry (middle of the shape -> centroid of the projected outline:
// perspective and a curved surface), illumination (-> centroid of the light), detector (-> mean of
// the detections), sensor (-> each detection), and all of them; then of the fitted middle of the
// shape: detector and sensor. Of the markers of that number, nothing: of all. Empty if no pair of
// cameras found one.
std::vector<BudgetLine> ErrorBudget(const std::array<CameraModel, 2>& cameras,
                                    const std::vector<StereoShot>& shots,
                                    std::optional<int> number);

// Poses of the target from its six identifiable markers, in exposures in which all were found.
struct PoseErrors {
  int64_t exposures = 0, poses = 0;
  double translation_rms_mm = 0.0;  // of the target's origin
  double rotation_rms_deg = 0.0;
  double fre_rms_mm = 0.0;
  double expected_tre_mm = 0.0;  // at the origin, from the FRE (Fitzpatrick et al. 1998)
};
PoseErrors PoseErrorsOf(const std::array<CameraModel, 2>& cameras,
                        const std::vector<StereoShot>& shots, MarkerPoint point);

}  // namespace retrolux
