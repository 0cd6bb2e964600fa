#include "analysis/placement_search.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <numeric>

#include "core/parallel.h"

namespace retrolux {

PlacementSearch::PlacementSearch(const Scenario& scenario, const std::string& mask_name,
                                 VisibilityStore& store)
    : scenario_(scenario),
      mask_name_(mask_name),
      store_(store),
      error_(scenario.error_points, scenario.gamma_max_mm),
      rotations_(MaskRotations(scenario.Mask(mask_name))) {
  for (const MaskRotation& rotation : rotations_) {
    std::vector<Vec3d> points;
    for (const Vec3f& position : store.TheMask().Mesh().positions)
      points.push_back(rotation.world_from_mask * position.cast<double>());
    std::vector<PlacedNozzle> nozzles;
    for (const Beam& beam : scenario.beams)
      nozzles.push_back(PlaceNozzle(scenario.nozzle, beam, points));
    too_close_ += std::any_of(nozzles.begin(), nozzles.end(),
                              [](const PlacedNozzle& nozzle) { return nozzle.too_close; });
    nozzles_.push_back(std::move(nozzles));
  }
}

// What cameras see in one orientation; each camera is looked through once.
class PlacementSearch::OrientationViews {
 public:
  OrientationViews(const PlacementSearch& search, size_t rotation)
      : search_(search), rotation_(rotation) {}

  const SampleSet& SeenBy(const Vec3d& centre) {
    const auto [entry, is_new] = seen_.try_emplace({centre.x(), centre.y(), centre.z()});
    if (is_new) {
      const Mat3d& world_from_mask = search_.rotations_[rotation_].world_from_mask;
      entry->second = *search_.store_.SeenBy(search_.scenario_, centre, world_from_mask);
      search_.store_.TheMask().RemoveHidden(entry->second, world_from_mask,
                                            search_.nozzles_[rotation_], centre);
    }
    return entry->second;
  }

  // AreasSeenByAll over the cameras of a set.
  std::vector<double> Areas(const std::vector<Vec3d>& centres, CameraSet cameras) {
    std::vector<const SampleSet*> sets;
    for (const int camera : CamerasOf(cameras))
      sets.push_back(&SeenBy(centres[static_cast<size_t>(camera)]));
    return AreasSeenByAll(sets, search_.store_.TheMask().Samples().areas_mm2);
  }

 private:
  const PlacementSearch& search_;
  size_t rotation_;
  std::map<std::array<double, 3>, SampleSet> seen_;  // its references stay
};

OrientationWorth PlacementSearch::Best(const PlacementWeights& weights,
                                       const std::vector<Vec3d>& centres,
                                       OrientationViews& views) const {
  OrientationWorth best = {0.0, 0.0, 0};
  if (weights.Combinations().empty()) return best;
  const CameraSet all = (CameraSet{1} << centres.size()) - 1;
  const std::vector<double> areas = views.Areas(centres, all);
  for (const CameraSet combination : weights.Combinations()) {
    const PlacementWeights::Worth worth = weights.Of(combination, areas, all);
    if (best.combination == 0 || worth.cost_mm2 > best.cost_mm2)
      best = {worth.cost_mm2, worth.area_mm2, combination};
  }
  return best;
}

namespace {

// A placement while its orientations are looked at.
struct Candidate {
  PlacementWeights weights;
  std::vector<Vec3d> centres;
  std::vector<OrientationWorth> worths;  // cost -1: acquitted
  std::atomic<double> worst = std::numeric_limits<double>::infinity();

  Candidate(const Scenario& scenario, const ReconstructionError& error, const Placement& placement,
            size_t rotations)
      : weights(scenario, error, placement),
        centres(CameraCentres(scenario, placement)),
        worths(rotations) {}

  void Record(size_t rotation, const OrientationWorth& worth) {
    worths[rotation] = worth;
    double known = worst.load();
    while (worth.cost_mm2 < known && !worst.compare_exchange_weak(known, worth.cost_mm2)) {
    }
  }
  bool Counts(CameraSet combination) const {
    const auto& all = weights.Combinations();
    return std::find(all.begin(), all.end(), combination) != all.end();
  }
};

}  // namespace

std::vector<PlacementWorth> PlacementSearch::Evaluate(
    std::span<const Placement> placements, const std::vector<OrientationWorth>& known) const {
  std::vector<std::unique_ptr<Candidate>> candidates;
  for (const Placement& placement : placements)
    candidates.push_back(
        std::make_unique<Candidate>(scenario_, error_, placement, rotations_.size()));

  // The orientations that were worst nearby come first, and the combinations that were best for
  // them are tried first: both only save work.
  std::vector<size_t> order(rotations_.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return known[a].cost_mm2 < known[b].cost_mm2; });
  ParallelFor(static_cast<int64_t>(order.size()), [&](int64_t index) {
    const size_t rotation = order[static_cast<size_t>(index)];
    OrientationViews views(*this, rotation);
    CameraSet likely = known[rotation].combination;
    for (const auto& candidate : candidates) {
      if (likely != 0 && candidate->Counts(likely)) {
        const std::vector<double> areas = views.Areas(candidate->centres, likely);
        if (candidate->weights.Of(likely, areas, likely).cost_mm2 > candidate->worst) continue;
      }
      const OrientationWorth best = Best(candidate->weights, candidate->centres, views);
      candidate->Record(rotation, best);
      likely = best.combination;
    }
  });

  std::vector<PlacementWorth> evaluations;
  for (size_t i = 0; i < candidates.size(); ++i) {
    size_t worst = rotations_.size();
    const std::vector<OrientationWorth>& worths = candidates[i]->worths;
    for (size_t rotation = 0; rotation < rotations_.size(); ++rotation) {
      if (worths[rotation].cost_mm2 < 0.0) continue;
      if (worst == rotations_.size() || worths[rotation].cost_mm2 < worths[worst].cost_mm2)
        worst = rotation;
    }
    evaluations.push_back(Described(placements[i], worths[worst], static_cast<int>(worst)));
  }
  return evaluations;
}

PlacementWorth PlacementSearch::Described(const Placement& placement, const OrientationWorth& worth,
                                          int rotation) const {
  PlacementWorth evaluation = {placement, worth, rotation};
  if (worth.combination != 0) {
    const PlacementWeights weights(scenario_, error_, placement);
    evaluation.min_angle_rad = weights.MinAngleRad(worth.combination);
    evaluation.min_nominal_angle_rad = weights.MinNominalAngleRad(worth.combination);
    evaluation.recon_error_mm = error_.Error_mm(evaluation.min_angle_rad);
  }
  return evaluation;
}

std::vector<OrientationWorth> PlacementSearch::Orientations(const Placement& placement) const {
  const PlacementWeights weights(scenario_, error_, placement);
  const std::vector<Vec3d> centres = CameraCentres(scenario_, placement);
  std::vector<OrientationWorth> worths(rotations_.size());
  ParallelFor(static_cast<int64_t>(rotations_.size()), [&](int64_t rotation) {
    OrientationViews views(*this, static_cast<size_t>(rotation));
    worths[static_cast<size_t>(rotation)] = Best(weights, centres, views);
  });
  return worths;
}

SampleSet PlacementSearch::SeenBy(const Placement& placement, int camera, int rotation) const {
  OrientationViews views(*this, static_cast<size_t>(rotation));
  return views.SeenBy(CameraCentres(scenario_, placement)[static_cast<size_t>(camera)]);
}

}  // namespace retrolux
