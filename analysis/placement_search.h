// The worth of a placement of cameras (thesis 4.5.1): of all orientations of the mask the worst,
// each seen by the combination of cameras that is best for it.
#pragma once

#include <map>
#include <span>

#include "analysis/placement_cost.h"
#include "analysis/visibility_store.h"

namespace retrolux {

// What the best combination makes of one orientation. No combination may count (all have a pair
// too close): cost 0, combination empty.
struct OrientationWorth {
  double cost_mm2 = -1.0;
  double area_mm2 = 0.0;
  CameraSet combination = 0;
};

// A placement at its worst orientation.
struct PlacementWorth {
  Placement placement;
  OrientationWorth worth;
  int rotation = 0;                                         // index in PlacementSearch::Rotations()
  double min_angle_rad = 0.0, min_nominal_angle_rad = 0.0;  // of the combination; eq. 4.12
  double recon_error_mm = 0.0;                              // eq. 4.6 of the true one
  double Cost() const { return worth.cost_mm2 / kCostUnit_mm2; }
  static constexpr double kCostUnit_mm2 = 1e4;  // the thesis's
};

// One mask in one room.
class PlacementSearch {
 public:
  // `store` must outlive it and may serve several rooms.
  PlacementSearch(const Scenario& scenario, const std::string& mask_name, VisibilityStore& store);

  const Scenario& TheScenario() const { return scenario_; }
  const std::string& MaskName() const { return mask_name_; }
  const Mask& TheMask() const { return store_.TheMask(); }
  const std::vector<MaskRotation>& Rotations() const { return rotations_; }
  // Orientations in which a nozzle can't keep its gap even with its snout contracted.
  int RotationsTooClose() const { return too_close_; }
  const std::vector<PlacedNozzle>& Nozzles(int rotation) const {
    return nozzles_[static_cast<size_t>(rotation)];
  }

  // The worst orientation of each placement. Exact, but not every orientation is looked at with all
  // cameras: one combination that sees more than the worst so far acquits an orientation. Uses all
  // threads; the result does not depend on their number. `known` are the orientations of a
  // placement nearby: the nearer, the less work.
  std::vector<PlacementWorth> Evaluate(std::span<const Placement> placements,
                                       const std::vector<OrientationWorth>& known) const;
  PlacementWorth Evaluate(const Placement& placement,
                          const std::vector<OrientationWorth>& known) const {
    return Evaluate({&placement, 1}, known).front();
  }

  // Every orientation, in the order of Rotations().
  std::vector<OrientationWorth> Orientations(const Placement& placement) const;

  // An evaluation of which only the worst orientation is known.
  PlacementWorth Described(const Placement& placement, const OrientationWorth& worth,
                           int rotation) const;

  // What camera `camera` (from 0) sees in an orientation, nozzles taken out.
  SampleSet SeenBy(const Placement& placement, int camera, int rotation) const;

 private:
  class OrientationViews;
  OrientationWorth Best(const PlacementWeights& weights, const std::vector<Vec3d>& centres,
                        OrientationViews& views) const;

  const Scenario& scenario_;
  std::string mask_name_;
  VisibilityStore& store_;
  ReconstructionError error_;
  std::vector<MaskRotation> rotations_;
  std::vector<std::vector<PlacedNozzle>> nozzles_;  // for each rotation
  int too_close_ = 0;
};

}  // namespace retrolux
