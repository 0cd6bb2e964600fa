#include "analysis/vault_study.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/json_reader.h"
#include "scenes/mask_mesh.h"

namespace retrolux {

namespace {

// Of the continuous refinement: a tenth of the finest step of phi_b that the thesis reports.
constexpr double kRefinementTolerance_deg = 0.1;
constexpr int kMostRefinements = 60;

std::string KeyOf(const MaskSpec& spec, const std::filesystem::path& file) {
  return fmt::format("{} {} {} {} {}", spec.mesh, spec.unit, spec.scale, spec.relief,
                     file.parent_path().string());
}

}  // namespace

VisibilityStore& MaskStores::For(const Scenario& scenario, const std::string& mask_name) {
  const MaskSpec& spec = scenario.Mask(mask_name);
  std::unique_ptr<Entry>& entry = entries_[KeyOf(spec, scenario.file)];
  if (!entry) {
    entry = std::make_unique<Entry>(
        Mask(mask_name, MaskMesh(spec, scenario.file), rule_, part_area_mm2_));
  }
  return entry->store;
}

int64_t MaskStores::Made() const {
  int64_t sum = 0;
  for (const auto& [key, entry] : entries_) sum += entry->store.Made();
  return sum;
}

int64_t MaskStores::Asked() const {
  int64_t sum = 0;
  for (const auto& [key, entry] : entries_) sum += entry->store.Asked();
  return sum;
}

size_t PlacementResult::WorstMask() const {
  size_t worst = 0;
  for (size_t i = 1; i < by_mask.size(); ++i) {
    if (by_mask[i].Cost() < by_mask[worst].Cost()) worst = i;
  }
  return worst;
}

namespace {

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

// The hint of a slice is the nearest of `hints`, or without any its own middle.
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

// Runs evaluations as tasks of a manifest.
class Evaluator {
 public:
  Evaluator(const std::filesystem::path& folder, const nlohmann::json& options, Progress& progress)
      : manifest_(folder, "vault", options), progress_(progress) {}

  // One task for each slice and mask.
  std::vector<PlacementResult> Evaluate(const std::string& stage, int phase, const Room& room,
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
      for (const Evaluation& e :
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
          result.by_mask.push_back(room.searches[m].Described(
              slices[s].placements[i], WorthFrom(row[0]), row[1].get<int>()));
        }
        results.push_back(std::move(result));
      }
    }
    return results;
  }

  // One task for each mask: every orientation of a placement.
  void AddOrientations(const std::string& stage, const Room& room, NamedResult& named) {
    std::vector<Task> tasks;
    for (const PlacementSearch& search : room.searches) {
      tasks.push_back({fmt::format("{}: {}", stage, search.MaskName()),
                       Definition(search, {{"orientations", ToJson(named.result.Where())}})});
    }
    const auto rows = Run(stage, tasks, [&](size_t mask) {
      nlohmann::json worths = nlohmann::json::array();
      for (const OrientationWorth& worth : room.searches[mask].Orientations(named.result.Where()))
        worths.push_back(ToJson(worth));
      return worths;
    });
    for (const nlohmann::json& mask : rows) {
      named.orientations.emplace_back();
      for (const nlohmann::json& row : mask) named.orientations.back().push_back(WorthFrom(row));
    }
  }

  Refinement Refine(const Room& room, const Placement& start) {
    nlohmann::json start_of = {{"refine", ToJson(start)},
                               {"tolerance_deg", kRefinementTolerance_deg},
                               {"most", kMostRefinements},
                               {"masks", nlohmann::json::array()}};
    for (const PlacementSearch& search : room.searches)
      start_of["masks"].push_back(Definition(search, {}));
    const auto rows = Run("between the grid", {{"continuous refinement", start_of}}, [&](size_t) {
      std::vector<std::vector<OrientationWorth>> known;
      for (const PlacementSearch& search : room.searches)
        known.push_back(search.Orientations(start));
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

  TaskReport Report() const { return manifest_.Report(); }
  int64_t Placements() const { return placements_; }
  int64_t OrientationsSeen() const { return orientations_; }

 private:
  static nlohmann::json Definition(const PlacementSearch& search, nlohmann::json what) {
    what["room"] = Physics(search.TheScenario());
    what["mask"] = search.TheMask().Hash();
    nlohmann::json rotations = nlohmann::json::array();
    for (const MaskRotation& r : search.Rotations())
      rotations.push_back({r.x_deg, r.y_deg, r.z_deg});
    what["rotations"] = {search.TheScenario().Mask(search.MaskName()).order, rotations};
    return what;
  }

  std::vector<nlohmann::json> Run(const std::string& stage, const std::vector<Task>& tasks,
                                  const TaskManifest::Work& work) {
    TaskLoop loop;
    loop.parallel = false;  // each uses all threads itself
    return manifest_.Run(stage, tasks, work, progress_, loop);
  }

  TaskManifest manifest_;
  Progress& progress_;
  int64_t placements_ = 0, orientations_ = 0;
};

const PlacementResult& BestOf(const std::vector<PlacementResult>& results) {
  return *std::max_element(results.begin(), results.end(),
                           [](const auto& a, const auto& b) { return a.Cost() < b.Cost(); });
}

std::vector<double> CostsOf(const std::vector<PlacementResult>& results) {
  std::vector<double> costs;
  for (const PlacementResult& result : results) costs.push_back(result.Cost());
  return costs;
}

std::vector<Placement> PlacesOf(const std::vector<PlacementResult>& results) {
  std::vector<Placement> places;
  for (const PlacementResult& result : results) places.push_back(result.Where());
  return places;
}

// What phase 2 looks at: around the centres, without what `known` holds.
std::vector<Placement> AroundAll(const Scenario& scenario, const std::vector<Placement>& centres,
                                 std::vector<Placement> known) {
  const auto same = [](const Placement& a, const Placement& b) {
    constexpr double kSlack_deg = 1e-9;
    return std::abs(a.phi_b_deg - b.phi_b_deg) < kSlack_deg &&
           std::abs(a.theta1_deg - b.theta1_deg) < kSlack_deg &&
           std::abs(a.theta2_deg - b.theta2_deg) < kSlack_deg;
  };
  std::vector<Placement> found;
  for (const Placement& centre : centres) {
    for (const Placement& p : RefinedGrid(scenario, centre)) {
      if (std::any_of(known.begin(), known.end(), [&](const Placement& k) { return same(k, p); }))
        continue;
      known.push_back(p);
      found.push_back(p);
    }
  }
  return found;
}

// The optimum with one variable moved to either side, as far as it can be built.
std::vector<std::pair<std::string, Placement>> Moved(const Scenario& scenario,
                                                     const Placement& best) {
  const SearchSpec& spec = scenario.search;
  std::vector<std::pair<std::string, Placement>> moved;
  const auto add = [&](const char* variable, double Placement::*which, double by) {
    Placement placement = best;
    placement.*which += by;
    if (scenario.rigs.same_height) placement.theta2_deg = placement.theta1_deg;
    const bool again = std::any_of(moved.begin(), moved.end(),
                                   [&](const auto& other) { return other.second == placement; });
    const bool beside = placement.phi_b_deg < spec.phi_b_deg.from ||
                        placement.phi_b_deg > spec.phi_b_deg.to;  // of what is searched
    if (!again && !beside && NotBuildable(scenario, placement).empty())
      moved.emplace_back(fmt::format("{} {:+g} deg", variable, by), placement);
  };
  for (const double sign : {-1.0, 1.0}) {
    if (scenario.cameras.arrangement == Arrangement::kBesideBeam) {
      for (const double step : {spec.refined_phi_b_step_deg, spec.snap_phi_b_deg})
        add("phi_b", &Placement::phi_b_deg, sign * step);
    }
    for (const double step : {spec.refined_theta_step_deg, spec.theta_deg.step}) {
      add("theta_1", &Placement::theta1_deg, sign * step);
      if (!scenario.rigs.same_height) add("theta_2", &Placement::theta2_deg, sign * step);
    }
  }
  return moved;
}

void CountCutViews(const Room& room, VaultStudy& study) {
  for (size_t m = 0; m < room.searches.size(); ++m) {
    const PlacementSearch& search = room.searches[m];
    for (const Vec3d& centre : CameraCentres(room.scenario, study.best.result.Where())) {
      const CameraModel camera = VaultCamera(room.scenario, "", centre);
      for (const MaskRotation& rotation : search.Rotations()) {
        CameraModel from_mask = camera;
        from_mask.camera_from_world =
            camera.camera_from_world * RigidTransform{rotation.world_from_mask, Vec3d::Zero()};
        ++study.views;
        if (search.TheMask().AreaOutsidePicture(from_mask) > 0.0) ++study.views_cut;
      }
    }
    study.rotations_too_close += search.RotationsTooClose();
  }
}

// One name for the placements that a study looks at beside its grid.
std::vector<NamedResult> EvaluateNamed(Evaluator& evaluator, const std::string& stage,
                                       const Room& room,
                                       const std::vector<std::pair<std::string, Placement>>& named,
                                       const Placement& hint) {
  std::vector<NamedResult> results;
  if (named.empty()) return results;
  Slice slice;
  slice.hint = hint;
  for (const auto& [name, placement] : named) slice.placements.push_back(placement);
  std::vector<PlacementResult> evaluated = evaluator.Evaluate(stage, 0, room, {slice});
  for (size_t i = 0; i < named.size(); ++i)
    results.push_back({named[i].first, std::move(evaluated[i]), {}});
  return results;
}

void EvaluateVariations(Evaluator& evaluator, const Scenario& scenario, MaskStores& stores,
                        VaultStudy& study) {
  for (const Variation& variation : scenario.variations) {
    const Room room(scenario.With(variation), study.options.masks, stores);
    const std::vector<PlacementResult> results =
        evaluator.Evaluate(variation.name, 1, room, SlicesOf(PlacementGrid(room.scenario), {}));
    const Placement& ours = study.best.result.Where();
    const auto distance = [&](const Placement& p) {
      return std::abs(p.phi_b_deg - ours.phi_b_deg) + std::abs(p.theta1_deg - ours.theta1_deg) +
             std::abs(p.theta2_deg - ours.theta2_deg);
    };
    const auto nearest = std::min_element(results.begin(), results.end(),
                                          [&](const PlacementResult& a, const PlacementResult& b) {
                                            return distance(a.Where()) < distance(b.Where());
                                          });
    study.variations.push_back({variation.name, BestOf(results), nearest->Cost()});
  }
}

// The mean over all orientations, of the mask that is worse off.
double MeanCost(const NamedResult& named) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::vector<OrientationWorth>& mask : named.orientations) {
    double sum = 0.0;
    for (const OrientationWorth& worth : mask) sum += worth.cost_mm2;
    least = std::min(least, sum / static_cast<double>(mask.size()));
  }
  return least;
}

// The highest cost. Where the worst orientation is seen best by cameras of one rig alone, the
// height of the other rig does not matter to it and several placements are equal: then the one that
// is best in the mean.
NamedResult Optimum(Evaluator& evaluator, const Room& room,
                    const std::vector<PlacementResult>& results) {
  const double highest = BestOf(results).Cost();
  std::optional<NamedResult> best;
  for (const PlacementResult& result : results) {
    if (result.Cost() < highest) continue;
    NamedResult tied = {"optimum", result, {}};
    const Placement& at = result.Where();
    evaluator.AddOrientations(fmt::format("all orientations at {:g} {:g} {:g}", at.phi_b_deg,
                                          at.theta1_deg, at.theta2_deg),
                              room, tied);
    if (!best || MeanCost(tied) > MeanCost(*best)) best = std::move(tied);
  }
  return *best;
}

void Search(Evaluator& evaluator, const Room& room, VaultStudy& study) {
  const Scenario& scenario = room.scenario;
  std::vector<Placement> centres;
  if (study.options.placement) {
    centres = {*study.options.placement};
    study.results = evaluator.Evaluate("placement", 1, room, {{centres, centres.front()}});
  } else {
    study.results = evaluator.Evaluate("phase 1", 1, room, SlicesOf(PlacementGrid(scenario), {}));
    const std::vector<Placement> grid = PlacesOf(study.results);
    for (const size_t i : LocalOptima(scenario, grid, CostsOf(study.results),
                                      static_cast<size_t>(scenario.search.refined_optima)))
      centres.push_back(grid[i]);
  }
  if (study.options.refine) {
    const std::vector<Placement> around = AroundAll(scenario, centres, PlacesOf(study.results));
    for (PlacementResult& result :
         evaluator.Evaluate("phase 2", 2, room, SlicesOf(around, centres)))
      study.results.push_back(std::move(result));
  }
  if (BestOf(study.results).Worst().worth.combination == 0) {
    throw InputError::At(scenario.file, "/combinations",
                         fmt::format("no combination with {} degrees between any two cameras, at "
                                     "any placement",
                                     scenario.combinations.min_separation_deg),
                         "a smaller min_separation_deg");
  }
  study.best = Optimum(evaluator, room, study.results);
  std::vector<PlacementResult> far;
  for (const PlacementResult& result : study.results) {
    if (!Near(scenario, result.Where(), study.best.result.Where())) far.push_back(result);
  }
  if (far.empty()) return;
  study.runner_up = NamedResult{"best away from the optimum", BestOf(far), {}};
  evaluator.AddOrientations("runner-up, all orientations", room, *study.runner_up);
}

void AddThesis(Evaluator& evaluator, const Room& room, VaultStudy& study) {
  std::vector<std::pair<std::string, Placement>> rows;
  for (const ThesisSolution& row : room.scenario.thesis)
    rows.push_back({row.name, {row.phi_b_deg, row.theta1_deg, row.theta2_deg}});
  if (rows.empty()) return;
  study.thesis =
      EvaluateNamed(evaluator, "the thesis's placements", room, rows, rows.front().second);
  for (NamedResult& row : study.thesis)
    evaluator.AddOrientations(fmt::format("thesis {}, all orientations", row.name), room, row);
}

}  // namespace

VaultStudy RunVaultStudy(const Scenario& scenario, const VaultStudyOptions& options,
                         MaskStores& stores, const std::filesystem::path& folder,
                         Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const int64_t made = stores.Made(), asked = stores.Asked();
  VaultStudy study;
  study.scenario = scenario;
  study.options = options;
  const Room room(scenario, options.masks, stores);
  for (const PlacementSearch& search : room.searches) {
    study.mask_area_mm2.push_back(search.TheMask().Samples().area_mm2);
    study.rotations.push_back(search.Rotations());
  }
  Evaluator evaluator(folder, {{"rule", NameOf(room.searches.front().TheMask().Rule())}}, progress);
  Search(evaluator, room, study);
  AddThesis(evaluator, room, study);
  if (options.extras && !options.placement) {
    const Placement& best = study.best.result.Where();
    study.sensitivity = EvaluateNamed(evaluator, "sensitivity", room, Moved(scenario, best), best);
    study.snapped =
        EvaluateNamed(evaluator, "snapped", room, {{"snapped", Snapped(scenario, best)}}, best)
            .front();
    study.refined = evaluator.Refine(room, best);
    EvaluateVariations(evaluator, scenario, stores, study);
  }
  CountCutViews(room, study);
  study.tasks = evaluator.Report();
  study.rates = {evaluator.Placements(), evaluator.OrientationsSeen(), stores.Made() - made,
                 stores.Asked() - asked,
                 std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
  return study;
}

}  // namespace retrolux
