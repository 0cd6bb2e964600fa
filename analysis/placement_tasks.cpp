#include "analysis/placement_tasks.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace retrolux {

size_t PlacementResult::WorstMask() const {
  size_t worst = 0;
  for (size_t i = 1; i < by_mask.size(); ++i) {
    if (by_mask[i].Cost() < by_mask[worst].Cost()) worst = i;
  }
  return worst;
}

namespace {

// Of the continuous refinement: a tenth of the finest step of phi_b that the thesis reports.
constexpr double kRefinementTolerance_deg = 0.1;
constexpr int kMostRefinements = 60;

nlohmann::json ToJson(const Placement& p) {
  return {p.phi_b_deg, p.theta1_deg, p.theta2_deg};
}

nlohmann::json ToJson(const OrientationWorth& worth) {
  return {worth.cost_mm2, worth.area_mm2, worth.combination};
}

OrientationWorth WorthFrom(const nlohmann::json& json) {
  return {json[0].get<double>(), json[1].get<double>(), json[2].get<CameraSet>()};
}

// What a scenario's numbers are named by: all that an evaluation depends on.
nlohmann::json Physics(const Scenario& scenario) {
  nlohmann::json document = scenario.document;
  for (const char* key : {"name", "description", "search", "variations", "thesis", "masks"})
    document.erase(key);
  return document;
}

nlohmann::json Definition(const PlacementSearch& search, nlohmann::json what) {
  what["room"] = Physics(search.TheScenario());
  what["mask"] = search.TheMask().Hash();
  nlohmann::json rotations = nlohmann::json::array();
  for (const MaskRotation& r : search.Rotations()) rotations.push_back({r.x_deg, r.y_deg, r.z_deg});
  what["rotations"] = {search.TheScenario().Mask(search.MaskName()).order, rotations};
  return what;
}

}  // namespace

std::vector<Slice> SlicesOf(const std::vector<Placement>& placements,
                            const std::vector<Placement>& hints) {
  std::map<double, Slice> by_phi_b;
  for (const Placement& placement : placements)
    by_phi_b[placement.phi_b_deg].placements.push_back(placement);
  std::vector<Slice> slices;
  for (auto& [phi_b_deg, slice] : by_phi_b) {
    const auto away = [phi_b = phi_b_deg](const Placement& hint) {
      return std::abs(hint.phi_b_deg - phi_b);
    };
    const auto nearest =
        std::min_element(hints.begin(), hints.end(),
                         [&](const Placement& a, const Placement& b) { return away(a) < away(b); });
    slice.hint = nearest == hints.end() ? slice.placements[slice.placements.size() / 2] : *nearest;
    slices.push_back(std::move(slice));
  }
  return slices;
}

std::vector<PlacementResult> PlacementTasks::Evaluate(const std::string& stage, int phase,
                                                      const Room& room,
                                                      const std::vector<Slice>& slices) {
  std::vector<Task> tasks;
  std::vector<std::pair<const Slice*, const PlacementSearch*>> work;
  for (const Slice& slice : slices) {
    for (const PlacementSearch& search : room.searches) {
      nlohmann::json placements = nlohmann::json::array();
      for (const Placement& p : slice.placements) placements.push_back(ToJson(p));
      tasks.push_back({fmt::format("{}: {}, phi_b {}", stage, search.MaskName(),
                                   slice.placements.front().phi_b_deg),
                       Definition(search, {{"placements", placements}})});
      work.emplace_back(&slice, &search);
    }
  }
  const auto evaluate = [&](size_t task) {
    const auto& [slice, search] = work[task];
    nlohmann::json rows = nlohmann::json::array();
    for (const PlacementWorth& e :
         search->Evaluate(slice->placements, search->Orientations(slice->hint)))
      rows.push_back({ToJson(e.worth), e.rotation});
    placements_ += static_cast<int64_t>(slice->placements.size());
    orientations_ += static_cast<int64_t>(slice->placements.size() * search->Rotations().size());
    return rows;
  };
  const std::vector<nlohmann::json> rows = Run(stage, tasks, evaluate);
  std::vector<PlacementResult> results;
  const size_t masks = room.searches.size();
  for (size_t s = 0; s < slices.size(); ++s) {
    for (size_t i = 0; i < slices[s].placements.size(); ++i) {
      PlacementResult result;
      result.phase = phase;
      for (size_t m = 0; m < masks; ++m) {
        const nlohmann::json& row = rows[s * masks + m][i];
        result.by_mask.push_back(room.searches[m].Described(slices[s].placements[i],
                                                            WorthFrom(row[0]), row[1].get<int>()));
      }
      results.push_back(std::move(result));
    }
  }
  return results;
}

std::vector<std::vector<OrientationWorth>> PlacementTasks::Orientations(
    const std::string& stage, const Room& room, const Placement& placement) {
  std::vector<Task> tasks;
  for (const PlacementSearch& search : room.searches) {
    tasks.push_back({fmt::format("{}: {}", stage, search.MaskName()),
                     Definition(search, {{"orientations", ToJson(placement)}})});
  }
  const auto rows = Run(stage, tasks, [&](size_t mask) {
    nlohmann::json worths = nlohmann::json::array();
    for (const OrientationWorth& worth : room.searches[mask].Orientations(placement))
      worths.push_back(ToJson(worth));
    return worths;
  });
  std::vector<std::vector<OrientationWorth>> orientations;
  for (const nlohmann::json& mask : rows) {
    orientations.emplace_back();
    for (const nlohmann::json& row : mask) orientations.back().push_back(WorthFrom(row));
  }
  return orientations;
}

Refinement PlacementTasks::Refine(const Room& room, const Placement& start) {
  nlohmann::json start_of = {{"refine", ToJson(start)},
                             {"tolerance_deg", kRefinementTolerance_deg},
                             {"most", kMostRefinements},
                             {"search", room.scenario.document["search"]},
                             {"masks", nlohmann::json::array()}};
  for (const PlacementSearch& search : room.searches)
    start_of["masks"].push_back(Definition(search, {}));
  const auto rows = Run("between the grid", {{"continuous refinement", start_of}}, [&](size_t) {
    std::vector<std::vector<OrientationWorth>> known;
    for (const PlacementSearch& search : room.searches) known.push_back(search.Orientations(start));
    const auto cost = [&](const Placement& placement) {
      double least = 1e300;
      for (size_t i = 0; i < known.size(); ++i)
        least = std::min(least, room.searches[i].Evaluate(placement, known[i]).Cost());
      return least;
    };
    const Refinement r =
        RefinePlacement(room.scenario, start, cost, kRefinementTolerance_deg, kMostRefinements);
    placements_ += r.evaluations;
    for (const PlacementSearch& search : room.searches)
      orientations_ += r.evaluations * static_cast<int64_t>(search.Rotations().size());
    return nlohmann::json{ToJson(r.placement), r.cost, r.evaluations};
  });
  const nlohmann::json& row = rows.front();
  return {{row[0][0].get<double>(), row[0][1].get<double>(), row[0][2].get<double>()},
          row[1].get<double>(),
          row[2].get<int>()};
}

std::vector<nlohmann::json> PlacementTasks::Run(const std::string& stage,
                                                const std::vector<Task>& tasks,
                                                const TaskManifest::Work& work) {
  TaskLoop loop;
  loop.parallel = false;  // each uses all threads itself
  return manifest_.Run(stage, tasks, work, progress_, loop);
}

}  // namespace retrolux
