#include "analysis/vault_room.h"

#include <algorithm>

#include "analysis/vault_text.h"
#include "core/error.h"
#include "scenes/vault.h"

namespace retrolux {

namespace {

RoomScene State(const VaultStudy& study, const std::string& name, const PlacementResult& placed,
                size_t rotation) {
  const size_t mask = placed.WorstMask();
  const MaskRotation& turned = study.rotations[mask][rotation];
  RoomScene state;
  state.label = fmt::format("{}, {}", name, TextOf(turned));
  state.scene = VaultScene(study.scenario, placed.Where(), study.options.masks[mask], turned);
  state.numbers = CamerasThatSee(state.scene, "mask");
  return state;
}

size_t BestOrientation(const NamedResult& placed) {
  const auto& worths = placed.orientations[placed.result.WorstMask()];
  const auto costs = [](const OrientationWorth& a, const OrientationWorth& b) {
    return a.cost_mm2 < b.cost_mm2;
  };
  return static_cast<size_t>(std::max_element(worths.begin(), worths.end(), costs) -
                             worths.begin());
}

}  // namespace

RoomFigure DrawVaultRoom(const VaultStudy& study) {
  const PlacementResult& best = study.best.result;
  const char* name = study.options.placement ? "the placement" : "optimum";
  std::vector<RoomScene> states = {
      State(study, fmt::format("{}, worst case", name), best, best.Worst().rotation)};
  if (!study.best.orientations.empty()) {
    states.push_back(
        State(study, fmt::format("{}, best case", name), best, BestOrientation(study.best)));
  }
  states.push_back(State(study, name, best, 0));
  if (study.runner_up) {
    const PlacementResult& placed = study.runner_up->result;
    states.push_back(State(study, "runner-up, worst case", placed, placed.Worst().rotation));
  }
  for (const NamedResult& thesis : study.thesis) {
    states.push_back(State(study, fmt::format("thesis's {}, worst case", thesis.name),
                           thesis.result, thesis.result.Worst().rotation));
  }
  return DrawRoom("Placement and orientation", states);
}

}  // namespace retrolux
