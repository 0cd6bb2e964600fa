// Hot spots in a vault placement: what is read of a solution.json, and what made-up pictures say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/cross_highlight.h"
#include "analysis/hotspot_placement_files.h"
#include "analysis/hotspot_placement_verdict.h"
#include "core/atomic_file.h"
#include "message_of.h"
#include "own_folder.h"

namespace retrolux {
namespace {

// What `study vault` writes of a placement.
std::filesystem::path SolutionFile(const nlohmann::json& change) {
  nlohmann::json solution = {
      {"schema", "retrolux/vault-solution-1"},
      {"simulation", "1a"},
      {"mask", "face"},
      {"placement", {{"phi_b_deg", 48.0}, {"theta1_deg", 31.67}, {"theta2_deg", 70.52}}}};
  solution.merge_patch(change);
  const std::filesystem::path file = OwnFolder() / "solution.json";
  WriteTextFile(file, solution.dump());
  return file;
}

TEST(HotspotVault, IsThatOfTheSolution) {
  const HotspotVault vault = ReadHotspotVault(SolutionFile(nlohmann::json::object()), "");
  EXPECT_EQ(vault.rotations.size(), 162u);
  const Scene scene = HotspotVaultScene(vault, vault.rotations[5], HotspotSetup{});
  ASSERT_EQ(scene.cameras.size(), 9u);
  // Cameras 2 and 4 hang on rig 1, 2 x 33 degrees of azimuth apart: sin(psi / 2) = sin(33)
  // sin(theta).
  const double half = std::asin(std::sin(RadFromDeg(33.0)) * std::sin(RadFromDeg(31.67)));
  EXPECT_NEAR(Separation_deg(scene.cameras[1].model, scene.cameras[3].model),
              DegFromRad(2.0 * half), 1e-9);
  // All markers lie on the turned mask, every identifiable one is there.
  const SceneObject& mask = scene.Object("mask");
  EXPECT_EQ(mask.world_from_object.rotation, vault.rotations[5].world_from_mask);
  std::vector<int> numbers;
  for (const MarkerSpec& marker : scene.markers) numbers.push_back(marker.number);
  EXPECT_THAT(numbers, testing::ElementsAre(1, 2, 3, 4, 5, 6, 0));
}

TEST(HotspotVault, SaysWhatIsWrong) {
  const auto message = [](const nlohmann::json& change) {
    return MessageOf([&] { ReadHotspotVault(SolutionFile(change), ""); });
  };
  EXPECT_THAT(message({{"placement", {{"phi_b_deg", nullptr}}}}),
              testing::HasSubstr("solution.json: /placement: "));
  EXPECT_THAT(message({{"simulation", "2b"}}),
              testing::HasSubstr("solution.json: /simulation: found '2b'; expected a built-in"));
  EXPECT_NO_THROW(ReadHotspotVault(SolutionFile({{"simulation", "2b"}}), "1b"));
  EXPECT_THAT(message({{"simulation", nullptr}}), testing::HasSubstr("no key 'simulation'"));
  EXPECT_THAT(
      message({{"mask", "hat"}}),
      testing::HasSubstr("/mask: found 'hat'; expected a mask of simulation 1a: body, face"));
  EXPECT_THAT(message({{"placement", {{"theta1_deg", 20.0}}}}),
              testing::HasSubstr("/placement: a rig radius of 547.2 mm, below 838.2 mm"));
}

// Three cameras, two rotations; of the first rotation `peaks` by (camera, ring): a highlight of so
// many e- in noise of 10.
HotspotPlacement MadeUpPlacement(const std::map<std::pair<size_t, size_t>, double>& peaks) {
  HotspotPlacement placement;
  placement.cameras = {"a", "b", "c"};
  placement.options.vault.rotations.resize(2);
  placement.rendered = {0};
  placement.mask_noise_e = 10.0;
  const double separations_deg[3][3] = {{0, 10, 50}, {10, 0, 40}, {50, 40, 0}};
  for (size_t rotation = 0; rotation < 2; ++rotation) {
    for (size_t camera = 0; camera < 3; ++camera) {
      for (size_t ring = 0; ring < 3; ++ring) {
        if (ring == camera) continue;
        PlacementTriple triple{camera, ring, rotation, separations_deg[camera][ring], {}, {}, {}};
        triple.forecast.peak_e = static_cast<double>(100 * rotation + 10 * camera + ring);
        if (rotation == 0) {
          NeighbourChange change;
          change.light.highlight.peak_e = peaks.at({camera, ring});
          change.highlight = {peaks.at({camera, ring}), 10.0, {}};
          change.methods = {{"edges", {}}, {"robust", {}}};
          change.methods.at("robust").hits = {7, 8};
          change.methods.at("robust").lost = 1;
          triple.change = change;
        }
        placement.triples.push_back(triple);
      }
    }
  }
  SortWorstFirst(placement.triples);
  return placement;
}

const std::map<std::pair<size_t, size_t>, double> kPeaks = {
    {{0, 1}, 20}, {{1, 0}, 25}, {{0, 2}, 90}, {{2, 0}, 10}, {{1, 2}, 40}, {{2, 1}, 45}};

TEST(HotspotPlacement, WorstFirst) {
  const HotspotPlacement placement = MadeUpPlacement(kPeaks);
  std::vector<double> sigmas, forecasts;
  for (const PlacementTriple& triple : placement.triples) {
    if (triple.change)
      sigmas.push_back(triple.change->Sigmas());
    else
      forecasts.push_back(triple.forecast.peak_e);
  }
  EXPECT_TRUE(placement.triples[5].change && !placement.triples[6].change);
  EXPECT_THAT(sigmas, testing::ElementsAre(9.0, 4.5, 4.0, 2.5, 2.0, 1.0));
  EXPECT_THAT(forecasts, testing::ElementsAre(121, 120, 112, 110, 102, 101));
  NeighbourChange change;
  change.highlight = {30.0, 10.0, {}};
  change.tail = {500.0, 100.0, {}};
  EXPECT_DOUBLE_EQ(change.Sigmas(), 5.0);
  EXPECT_STREQ(change.Largest(), "retro tail");
  EXPECT_FALSE(change.IsHotSpot());  // not more than three times the noise
}

TEST(HotspotPlacement, CountsPairsAndSaysWhetherNearOnesAreWorse) {
  const HotspotPlacement placement = MadeUpPlacement(kPeaks);
  const std::vector<PlacementPair> pairs = PairsOf(placement);
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_EQ(std::make_pair(pairs[0].a, pairs[0].b), std::make_pair(size_t{0}, size_t{2}));
  EXPECT_EQ(pairs[0].hot, 1);
  EXPECT_EQ(pairs[0].rendered, 1);
  EXPECT_EQ(pairs[0].forecast_hot, 1);  // 120 > 30 in the second rotation, 20 in the first
  EXPECT_EQ(pairs[0].names, 16);
  EXPECT_EQ(pairs[0].lost, 2);
  EXPECT_EQ(pairs[2].separation_deg, 10.0);
  EXPECT_EQ(pairs[2].hot, 0);
  const std::vector<std::string> verdict = VerdictOf(placement);
  EXPECT_THAT(verdict[0], testing::StartsWith("**2 of 3 pairs of cameras have hot spots**"));
  EXPECT_THAT(verdict[1], testing::HasSubstr("are no worse than the others"));
  EXPECT_THAT(verdict[1], testing::HasSubstr("up to 25 e- against 90"));
  auto near_worse = kPeaks;
  near_worse[{0, 1}] = 200;
  EXPECT_THAT(VerdictOf(MadeUpPlacement(near_worse))[1],
              testing::HasSubstr("are worse than the others"));
}

// Each pair's worst rotation before any pair's second one.
TEST(HotspotPlacement, RendersTheWorstRotationOfEachPairFirst) {
  const auto triple = [](size_t camera, size_t ring, size_t rotation, double forecast_e) {
    PlacementTriple made{camera, ring, rotation, 30.0, {}, {}, {}};
    made.forecast.peak_e = forecast_e;
    return made;
  };
  const std::vector<PlacementTriple> triples = {triple(0, 1, 4, 100), triple(1, 0, 3, 90),
                                                triple(0, 2, 2, 50), triple(1, 2, 4, 40),
                                                triple(2, 1, 1, 30)};
  EXPECT_THAT(WorstRotations(triples, 1), testing::ElementsAre(4));
  EXPECT_THAT(WorstRotations(triples, 2), testing::ElementsAre(2, 4));
  EXPECT_THAT(WorstRotations(triples, 3), testing::ElementsAre(2, 3, 4));
  EXPECT_THAT(WorstRotations(triples, 9), testing::ElementsAre(1, 2, 3, 4));
}

TEST(HotspotPlacement, TableHasEveryTripleWorstFirst) {
  WritePlacementFiles(MadeUpPlacement(kPeaks), OwnFolder());
  const std::string table = ReadTextFile(OwnFolder() / "placement.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1 + 12);
  const std::string first = table.substr(table.find('\n') + 1);
  EXPECT_THAT(first, testing::StartsWith("a,c,50,0,0,0,2,0,0,0,1,9,highlight,1,90,9,"));
}

}  // namespace
}  // namespace retrolux
