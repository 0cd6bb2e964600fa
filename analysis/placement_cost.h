// What a combination of cameras is worth (thesis 4.1.1): the area of the mask that at least two of
// them see, each part weighted by how well those that see it reconstruct a point.
#pragma once

#include <span>
#include <vector>

#include "analysis/reconstruction_error.h"
#include "analysis/visibility.h"
#include "scenes/rig_layout.h"

namespace retrolux {

// areas[S], S a bit mask over the given sets: the area (mm2) of the samples that all sets of S hold
// (eq. 4.1, 4.2, 4.4); areas[0] is that of all samples which any of them holds. At most 16 sets.
std::vector<double> AreasSeenByAll(std::span<const SampleSet* const> sets,
                                   const std::vector<float>& areas_mm2);

// A combination of cameras: a bit mask over all of them, from camera 1 in bit 0.
using CameraSet = uint32_t;
CameraSet SetOf(const std::vector<int>& cameras);  // from 0
std::vector<int> CamerasOf(CameraSet set);         // from 0, ascending
std::string NameOf(CameraSet set);                 // "1-2-8", cameras from 1

// The combinations of a placement that count, and the weight of every pair (eq. 4.7).
class PlacementWeights {
 public:
  PlacementWeights(const Scenario& scenario, const ReconstructionError& error,
                   const Placement& placement);

  // Those with at least min_separation_deg between any two cameras; ascending in the order of
  // CameraCombinations. May be empty.
  const std::vector<CameraSet>& Combinations() const { return combinations_; }

  struct Worth {
    double cost_mm2 = 0.0;  // eq. 4.3, 4.5
    double area_mm2 = 0.0;  // the same with every weight 1: seen by two or more
  };
  // Eq. 4.3 for any number of cameras: the area that exactly the cameras of T see, T any part of
  // the combination with two cameras or more, times the mean weight of the pairs of T. Eq. 4.5 is
  // this with B_ijk - C_ijkl for the B_ijk that it prints: as printed, what all four cameras see
  // would count five times, against the thesis's own account of that case.
  // `areas` is AreasSeenByAll over cameras `of`, which holds those of the combination.
  Worth Of(CameraSet combination, const std::vector<double>& areas, CameraSet of) const;

  // Smallest separation of two cameras of the combination: true, and nominal (eq. 4.12).
  double MinAngleRad(CameraSet combination) const;
  double MinNominalAngleRad(CameraSet combination) const;

 private:
  double Pair(const std::vector<double>& table, int i, int j) const {
    return table[static_cast<size_t>(i * count_ + j)];
  }
  double MinOver(const std::vector<double>& table, CameraSet combination) const;

  int count_;
  std::vector<double> weight_, angle_, nominal_;  // count x count
  std::vector<CameraSet> combinations_;
};

}  // namespace retrolux
