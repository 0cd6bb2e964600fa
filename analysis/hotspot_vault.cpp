#include "analysis/hotspot_vault.h"

#include <algorithm>

#include "analysis/vault_study.h"
#include "core/json_reader.h"
#include "scenes/built_in.h"
#include "scenes/vault.h"

namespace retrolux {

namespace {

namespace fs = std::filesystem;

Scenario ScenarioOf(JsonReader& solution, const std::string& chosen) {
  if (!chosen.empty()) return LoadScenario(chosen);
  const std::vector<std::string> known = BuiltInScenarioNames();
  const std::string expected = fmt::format(
      "a built-in simulation ({}), or --scenario with that of the vault", JoinNames(known));
  if (!solution.Has("simulation")) solution.Fail("no key 'simulation'", expected);
  const std::string name = solution.String("simulation");
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw InputError::At(solution.File(), "/simulation", fmt::format("found '{}'", name), expected);
  return LoadScenario(name);
}

// Where markers go, in the mask's frame.
std::vector<MarkerSpec> MarkersOn(const MaskSpec& mask) {
  std::vector<MarkerSpec> markers = mask.mesh == "body" ? BodyScene().markers : FaceScene().markers;
  for (MarkerSpec& marker : markers) marker.at *= mask.scale;
  return markers;
}

}  // namespace

HotspotVault ReadHotspotVault(const fs::path& solution, const std::string& scenario) {
  HotspotVault vault;
  vault.placement = ReadPlacement(solution);
  JsonReader json = JsonReader::FromFile(solution);
  vault.scenario = ScenarioOf(json, scenario);
  vault.mask = json.String("mask", "face");
  if (!vault.scenario.masks.contains(vault.mask)) {
    std::vector<std::string> names;
    for (const auto& [name, mask] : vault.scenario.masks) names.push_back(name);
    throw InputError::At(
        solution, "/mask", fmt::format("found '{}'", vault.mask),
        fmt::format("a mask of simulation {}: {}", vault.scenario.name, JoinNames(names)));
  }
  const MaskSpec& mask = vault.scenario.Mask(vault.mask);
  if (mask.mesh != "face" && mask.mesh != "body") {
    throw InputError::At(vault.scenario.file, fmt::format("/masks/{}/mesh", vault.mask),
                         fmt::format("found '{}'", mask.mesh),
                         "face or body, whose places for markers are known");
  }
  if (const std::string why = NotBuildable(vault.scenario, vault.placement); !why.empty())
    throw InputError::At(solution, "/placement", why, "a placement that can be built");
  vault.rotations = MaskRotations(mask);
  return vault;
}

Scene HotspotVaultScene(const HotspotVault& vault, const MaskRotation& rotation,
                        const HotspotSetup& setup) {
  Scene scene = VaultScene(vault.scenario, vault.placement, vault.mask, rotation);
  scene.markers = MarkersOn(vault.scenario.Mask(vault.mask));
  FurnishRoom(setup, scene);
  return scene;
}

}  // namespace retrolux
