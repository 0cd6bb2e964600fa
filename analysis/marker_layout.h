// Where identifiable markers go on a mask so that they work together: in every pose of the patient
// some pair of cameras must name at least three of them at once, well enough spread for a pose.
#pragma once

#include "analysis/marker_sight.h"

namespace retrolux {

struct LayoutOptions {
  // How uncertain the middle of each marker is, of that of a good one (classifier/marker_point.h):
  // as many as there are markers.
  std::vector<double> relative_sigma = std::vector<double>(6, 1.0);
  // Where a camera counts as naming a marker. Larger ones find layouts whose markers fade; the
  // study renders what comes of it.
  SightLimits sight;
  double clearance_mm = 25.0;        // between the centres of two markers
  double min_separation_deg = 15.0;  // of a pair, seen from the mask: closer ones give hot spots
  double candidate_mm2 = 100.0;      // of the mask's surface for each place that is tried
  double point_sigma_px = 0.05;      // of a marker in a picture, in each of u and v
  int spare = 1;                     // markers beyond three that a pair should see, to lose
  int starts = 24;                   // random layouts that the search sets out from
  uint64_t seed = 1;
};

// A marker that a pair of cameras sees: its place in the mask's frame, its LayoutOptions::
// relative_sigma.
struct SharedMarker {
  Vec3d at = Vec3d::Zero();
  double relative_sigma = 1.0;
};

// Root of the expected squared error of the mask's origin, mm, by a pose from these markers, seen
// by two cameras: Fitzpatrick's TRE with the localisation errors of two rays
// (analysis/stereo_study.h, RaySigma_mm). Infinite for fewer than three or for all on a line.
double PairTre_mm(const std::vector<SharedMarker>& markers, const CameraModel& a,
                  const CameraModel& b, const Vec3d& mask_in_world, double point_sigma_px);

// Angle between two cameras, seen from a point, deg.
double SeparationDeg(const CameraModel& a, const CameraModel& b, const Vec3d& from);

struct MarkerLayout {
  std::vector<size_t> places;  // of the candidates, by marker
  double worst_tre_mm = 0.0;   // over the poses, of the best pair in each
  int least_common = 0;        // over the poses, markers that the pair with the most sees
};

// The layout whose worst pose is best: first that a pair sees 3 + spare markers, then the TRE.
// Exchanges one place, or two markers, at a time, the best exchange of all, from random layouts,
// until none is better. The same on any number of threads. InputError if no layout lets a pair see
// three in every pose.
MarkerLayout FindLayout(const Scene& scene, const SightTable& table,
                        const std::vector<MarkerPlace>& places, const LayoutOptions& options,
                        Progress& progress);

}  // namespace retrolux
