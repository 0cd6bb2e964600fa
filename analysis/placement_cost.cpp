#include "analysis/placement_cost.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "core/error.h"

namespace retrolux {

std::vector<double> AreasSeenByAll(std::span<const SampleSet* const> sets,
                                   const std::vector<float>& areas_mm2) {
  const size_t count = sets.size();
  RETROLUX_CHECK(count <= 16, "{} cameras", count);
  // First the area seen by exactly the cameras of each set, then sums over the supersets.
  std::vector<double> areas(size_t{1} << count, 0.0);
  const size_t words = count == 0 ? 0 : sets[0]->size();
  for (size_t word = 0; word < words; ++word) {
    uint64_t any = 0;
    for (const SampleSet* set : sets) any |= (*set)[word];
    for (; any != 0; any &= any - 1) {
      const int bit = std::countr_zero(any);
      size_t seen_by = 0;
      for (size_t k = 0; k < count; ++k)
        seen_by |= static_cast<size_t>(((*sets[k])[word] >> bit) & 1u) << k;
      areas[seen_by] += static_cast<double>(areas_mm2[word * 64 + static_cast<size_t>(bit)]);
    }
  }
  for (size_t k = 0; k < count; ++k) {
    for (size_t subset = 0; subset < areas.size(); ++subset) {
      if ((subset >> k & 1u) == 0) areas[subset] += areas[subset | size_t{1} << k];
    }
  }
  return areas;
}

CameraSet SetOf(const std::vector<int>& cameras) {
  CameraSet set = 0;
  for (const int camera : cameras) set |= CameraSet{1} << camera;
  return set;
}

std::vector<int> CamerasOf(CameraSet set) {
  std::vector<int> cameras;
  for (; set != 0; set &= set - 1) cameras.push_back(std::countr_zero(set));
  return cameras;
}

std::string NameOf(CameraSet set) {
  std::string name;
  for (const int camera : CamerasOf(set))
    name += fmt::format("{}{}", name.empty() ? "" : "-", camera + 1);
  return name;
}

PlacementWeights::PlacementWeights(const Scenario& scenario, const ReconstructionError& error,
                                   const Placement& placement)
    : count_(scenario.cameras.count) {
  const std::vector<Vec3d> centres = CameraCentres(scenario, placement);
  for (int i = 0; i < count_; ++i) {
    for (int j = 0; j < count_; ++j) {
      const double angle =
          SeparationRad(centres[static_cast<size_t>(i)], centres[static_cast<size_t>(j)]);
      angle_.push_back(angle);
      nominal_.push_back(NominalSeparationRad(scenario, placement, i, j));
      weight_.push_back(i == j ? 0.0 : error.Weight(angle));
    }
  }
  const double least = RadFromDeg(scenario.combinations.min_separation_deg);
  for (const std::vector<int>& cameras : CameraCombinations(scenario)) {
    if (MinAngleRad(SetOf(cameras)) >= least) combinations_.push_back(SetOf(cameras));
  }
}

PlacementWeights::Worth PlacementWeights::Of(CameraSet combination,
                                             const std::vector<double>& areas, CameraSet of) const {
  // Bits of the combination's cameras in the index of `areas`.
  const std::vector<int> cameras = CamerasOf(combination);
  std::vector<size_t> bits;
  for (const int camera : cameras) {
    RETROLUX_CHECK((of >> camera & 1u) != 0, "camera {} has no area", camera + 1);
    bits.push_back(size_t{1} << std::popcount(of & ((CameraSet{1} << camera) - 1)));
  }
  const size_t parts = size_t{1} << cameras.size();
  const auto seen_by_all = [&](size_t part) {
    size_t index = 0;
    for (size_t k = 0; k < cameras.size(); ++k) index |= (part >> k & 1u) != 0 ? bits[k] : 0;
    return areas[index];
  };
  Worth worth;
  for (size_t part = 1; part < parts; ++part) {
    const int cameras_in_part = std::popcount(part);
    if (cameras_in_part < 2) continue;
    double exactly = 0.0;  // inclusion and exclusion over the larger parts
    for (size_t larger = part; larger < parts; larger = (larger + 1) | part)
      exactly += (std::popcount(larger ^ part) % 2 == 0 ? 1.0 : -1.0) * seen_by_all(larger);
    double weights = 0.0;
    for (size_t i = 0; i < cameras.size(); ++i) {
      for (size_t j = i + 1; j < cameras.size(); ++j) {
        if ((part >> i & part >> j & 1u) != 0) weights += Pair(weight_, cameras[i], cameras[j]);
      }
    }
    const int pairs = cameras_in_part * (cameras_in_part - 1) / 2;
    worth.cost_mm2 += weights / pairs * exactly;
    worth.area_mm2 += exactly;
  }
  return worth;
}

double PlacementWeights::MinOver(const std::vector<double>& table, CameraSet combination) const {
  double least = std::numeric_limits<double>::infinity();
  const std::vector<int> cameras = CamerasOf(combination);
  for (size_t i = 0; i < cameras.size(); ++i) {
    for (size_t j = i + 1; j < cameras.size(); ++j)
      least = std::min(least, Pair(table, cameras[i], cameras[j]));
  }
  return least;
}

double PlacementWeights::MinAngleRad(CameraSet combination) const {
  return MinOver(angle_, combination);
}

double PlacementWeights::MinNominalAngleRad(CameraSet combination) const {
  return MinOver(nominal_, combination);
}

}  // namespace retrolux
