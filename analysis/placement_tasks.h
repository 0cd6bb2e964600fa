// Evaluations of placements as tasks of a manifest, so that a search that was interrupted goes on
// where it was.
#pragma once

#include "analysis/mask_stores.h"
#include "analysis/placement_refinement.h"
#include "analysis/placement_search.h"
#include "core/task_manifest.h"

namespace retrolux {

// A placement, with the worst orientation of each mask.
struct PlacementResult {
  int phase = 1;
  std::vector<PlacementWorth> by_mask;  // as VaultStudyOptions::masks

  const Placement& Where() const { return by_mask.front().placement; }
  size_t WorstMask() const;
  const PlacementWorth& Worst() const { return by_mask[WorstMask()]; }
  double Cost() const { return Worst().Cost(); }
};

// A room with the masks in it.
struct Room {
  Scenario scenario;
  std::vector<PlacementSearch> searches;  // by mask

  Room(Scenario the_scenario, const std::vector<std::string>& masks, MaskStores& stores)
      : scenario(std::move(the_scenario)) {
    for (const std::string& mask : masks)
      searches.emplace_back(scenario, mask, stores.For(scenario, mask));
  }
  Room(const Room&) = delete;
  Room& operator=(const Room&) = delete;
};

// Placements of one phi_b, and one nearby whose orientations are looked at first.
struct Slice {
  std::vector<Placement> placements;
  Placement hint;
};

// One slice for each phi_b. Its hint is the nearest of `hints`, or without any its own middle.
std::vector<Slice> SlicesOf(const std::vector<Placement>& placements,
                            const std::vector<Placement>& hints);

class PlacementTasks {
 public:
  PlacementTasks(const std::filesystem::path& folder, const nlohmann::json& options,
                 Progress& progress)
      : manifest_(folder, "vault", options), progress_(progress) {}

  // One task for each slice and mask. The results are in the order of the slices' placements.
  std::vector<PlacementResult> Evaluate(const std::string& stage, int phase, const Room& room,
                                        const std::vector<Slice>& slices);

  // One task for each mask: every orientation of a placement, by mask.
  std::vector<std::vector<OrientationWorth>> Orientations(const std::string& stage,
                                                          const Room& room,
                                                          const Placement& placement);

  // RefinePlacement of the worse mask's cost.
  Refinement Refine(const Room& room, const Placement& start);

  TaskReport Report() const { return manifest_.Report(); }
  // Evaluated by this object, not found done.
  int64_t Placements() const { return placements_; }
  int64_t OrientationsSeen() const { return orientations_; }

 private:
  std::vector<nlohmann::json> Run(const std::string& stage, const std::vector<Task>& tasks,
                                  const TaskManifest::Work& work);

  TaskManifest manifest_;
  Progress& progress_;
  int64_t placements_ = 0, orientations_ = 0;
};

}  // namespace retrolux
