#include "analysis/marker_layout.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/stereo_study.h"
#include "classifier/registration.h"
#include "core/rng.h"

namespace retrolux {

namespace {

constexpr const char* kMask = "mask";
constexpr size_t kLeast = 3;  // markers that fix a pose
// What a pose costs, mm, in which no pair sees enough: far above any TRE.
constexpr double kNoSpare = 1e3, kNoPose = 1e6;
// For each good marker less than three: those with few edges are also left unnamed more often.
constexpr double kFewGood = 3e2;

Vec3d MaskInWorld(const Scene& posed) {
  return posed.Object(kMask).world_from_object.translation;
}

// Two cameras that may work together.
struct Pair {
  size_t a, b;
};

class Search {
 public:
  Search(const Scene& scene, const SightTable& table, const std::vector<MarkerPlace>& places,
         const LayoutOptions& options)
      : table_(table), places_(places), options_(options) {
    for (const CameraSpec& camera : scene.cameras) cameras_.push_back(camera.model);
    for (const Pose& pose : table.poses) masks_.push_back(MaskInWorld(scene.AtPose(pose)));
    for (size_t a = 0; a < cameras_.size(); ++a) {
      for (size_t b = a + 1; b < cameras_.size(); ++b) {
        if (SeparationDeg(cameras_[a], cameras_[b], masks_.front()) >= options.min_separation_deg)
          pairs_.push_back({a, b});
      }
    }
  }

  // Lower is better: of the worst pose, with a little of the mean.
  double Cost(const std::vector<size_t>& layout) const {
    double worst = 0.0, sum = 0.0;
    for (size_t pose = 0; pose < masks_.size(); ++pose) {
      const double cost = PoseCost(layout, pose);
      worst = std::max(worst, cost);
      sum += cost;
    }
    return worst + 0.01 * sum / static_cast<double>(masks_.size());
  }

  bool Fits(const std::vector<size_t>& layout, size_t place, size_t instead_of) const {
    for (size_t i = 0; i < layout.size(); ++i) {
      if (i != instead_of &&
          (places_[layout[i]].at - places_[place].at).norm() < options_.clearance_mm)
        return false;
    }
    return true;
  }

  MarkerLayout Measured(const std::vector<size_t>& layout) const {
    MarkerLayout result{layout, 0.0, static_cast<int>(layout.size())};
    for (size_t pose = 0; pose < masks_.size(); ++pose) {
      double best = std::numeric_limits<double>::infinity();
      size_t most = 0;
      for (const Pair& pair : pairs_) {
        const std::vector<SharedMarker> common = Common(layout, pose, pair);
        best = std::min(best, Tre(common, pose, pair));
        most = std::max(most, common.size());
      }
      result.worst_tre_mm = std::max(result.worst_tre_mm, best);
      result.least_common = std::min(result.least_common, static_cast<int>(most));
    }
    return result;
  }

 private:
  std::vector<SharedMarker> Common(const std::vector<size_t>& layout, size_t pose,
                                   const Pair& pair) const {
    std::vector<SharedMarker> common;
    const auto& seen = table_.seen[pose];
    for (size_t i = 0; i < layout.size(); ++i) {
      if (seen[pair.a][layout[i]] != 0 && seen[pair.b][layout[i]] != 0)
        common.push_back({places_[layout[i]].at, options_.relative_sigma[i]});
    }
    return common;
  }

  double Tre(const std::vector<SharedMarker>& common, size_t pose, const Pair& pair) const {
    return PairTre_mm(common, cameras_[pair.a], cameras_[pair.b], masks_[pose],
                      options_.point_sigma_px);
  }

  double PoseCost(const std::vector<size_t>& layout, size_t pose) const {
    const size_t enough = kLeast + static_cast<size_t>(options_.spare);
    double best = std::numeric_limits<double>::infinity();
    for (const Pair& pair : pairs_) {
      const std::vector<SharedMarker> common = Common(layout, pose, pair);
      double cost = kNoPose * static_cast<double>(1 + kLeast - std::min(kLeast, common.size()));
      if (common.size() >= kLeast) {
        const double tre = Tre(common, pose, pair);
        cost = std::isfinite(tre) ? tre : kNoPose;
        if (common.size() < enough) cost += kNoSpare * static_cast<double>(enough - common.size());
        const auto good = static_cast<size_t>(std::count_if(
            common.begin(), common.end(), [](const auto& m) { return m.relative_sigma <= 1.0; }));
        if (good < kLeast) cost += kFewGood * static_cast<double>(kLeast - good);
      }
      best = std::min(best, cost);
    }
    return best;
  }

  const SightTable& table_;
  const std::vector<MarkerPlace>& places_;
  const LayoutOptions& options_;
  std::vector<CameraModel> cameras_;
  std::vector<Vec3d> masks_;  // origin in the world, by pose
  std::vector<Pair> pairs_;
};

// Places that some camera sees in some pose.
std::vector<size_t> UsefulPlaces(const SightTable& table, size_t count) {
  std::vector<size_t> useful;
  for (size_t place = 0; place < count; ++place) {
    const bool seen = std::any_of(table.seen.begin(), table.seen.end(), [&](const auto& cameras) {
      return std::any_of(cameras.begin(), cameras.end(),
                         [&](const auto& places) { return places[place] != 0; });
    });
    if (seen) useful.push_back(place);
  }
  return useful;
}

std::optional<std::vector<size_t>> RandomLayout(const Search& search,
                                                const std::vector<size_t>& useful, size_t markers,
                                                KeyedRng& rng) {
  constexpr int kTries = 1000;
  if (useful.empty()) return std::nullopt;
  std::vector<size_t> layout;
  for (int i = 0; i < kTries && layout.size() < markers; ++i) {
    const auto n = static_cast<double>(useful.size());
    const size_t place = useful[static_cast<size_t>(rng.NextDouble() * n)];
    if (search.Fits(layout, place, layout.size())) layout.push_back(place);
  }
  if (layout.size() < markers) return std::nullopt;
  return layout;
}

// All layouts that differ in one place, or in which two markers have changed places.
std::vector<std::vector<size_t>> Neighbours(const Search& search, const std::vector<size_t>& useful,
                                            const std::vector<size_t>& layout) {
  std::vector<std::vector<size_t>> neighbours;
  for (size_t i = 0; i < layout.size(); ++i) {
    for (const size_t place : useful) {
      if (!search.Fits(layout, place, i)) continue;
      neighbours.push_back(layout);
      neighbours.back()[i] = place;
    }
    for (size_t k = 0; k < i; ++k) {
      neighbours.push_back(layout);
      std::swap(neighbours.back()[i], neighbours.back()[k]);
    }
  }
  return neighbours;
}

// The best exchange; false if none is better.
bool Exchange(const Search& search, const std::vector<size_t>& useful, std::vector<size_t>& layout,
              double& cost) {
  std::vector<std::vector<size_t>> neighbours = Neighbours(search, useful, layout);
  std::vector<double> costs(neighbours.size());
  ParallelFor(static_cast<int64_t>(costs.size()), [&](int64_t index) {
    const auto i = static_cast<size_t>(index);
    costs[i] = search.Cost(neighbours[i]);
  });
  const auto best = std::min_element(costs.begin(), costs.end());
  if (best == costs.end() || !(*best < cost)) return false;
  layout = std::move(neighbours[static_cast<size_t>(best - costs.begin())]);
  cost = *best;
  return true;
}

}  // namespace

double SeparationDeg(const CameraModel& a, const CameraModel& b, const Vec3d& from) {
  const Vec3d u = (a.Centre() - from).normalized(), v = (b.Centre() - from).normalized();
  return DegFromRad(std::acos(std::clamp(u.dot(v), -1.0, 1.0)));
}

double PairTre_mm(const std::vector<SharedMarker>& markers, const CameraModel& a,
                  const CameraModel& b, const Vec3d& mask_in_world, double point_sigma_px) {
  std::vector<PointPair> pairs;
  double weights = 0.0;
  for (const SharedMarker& m : markers) {
    pairs.push_back({m.at, m.at, 1.0 / (m.relative_sigma * m.relative_sigma)});
    weights += pairs.back().weight;
  }
  if (pairs.size() < kLeast || RegistrationFault(pairs))
    return std::numeric_limits<double>::infinity();
  const double distance_mm =
      0.5 * ((a.Centre() - mask_in_world).norm() + (b.Centre() - mask_in_world).norm());
  const double sigma_mm = point_sigma_px * distance_mm / (0.5 * (a.fx + b.fx));
  const double fle_mm = RaySigma_mm(sigma_mm, SeparationDeg(a, b, mask_in_world)).norm();
  // ExpectedTre_mm asks for that of a point of mean weight.
  const double mean_weight = weights / static_cast<double>(pairs.size());
  return ExpectedTre_mm(pairs, fle_mm / std::sqrt(mean_weight), Vec3d::Zero());
}

MarkerLayout FindLayout(const Scene& scene, const SightTable& table,
                        const std::vector<MarkerPlace>& places, const LayoutOptions& options,
                        Progress& progress) {
  const Search search(scene, table, places, options);
  const std::vector<size_t> useful = UsefulPlaces(table, places.size());
  std::optional<std::vector<size_t>> best;
  double best_cost = std::numeric_limits<double>::infinity();
  progress.Begin("search", options.starts, "starts");
  for (int start = 0; start < options.starts; ++start) {
    KeyedRng rng(CombineKeys(options.seed, static_cast<uint64_t>(start)));
    auto layout = RandomLayout(search, useful, options.relative_sigma.size(), rng);
    if (layout) {
      double cost = search.Cost(*layout);
      while (Exchange(search, useful, *layout, cost)) {
      }
      if (cost < best_cost) {
        best_cost = cost;
        best = layout;
      }
    }
    progress.Advance(1);
  }
  progress.End();
  if (!best || best_cost >= kNoPose) {
    throw InputError(fmt::format(
        "{}: no {} places let a pair of cameras see three markers below {} degrees in every pose; "
        "expected cameras {} degrees apart or more that share a part of the mask",
        scene.name, options.relative_sigma.size(), options.sight.max_incidence_deg,
        options.min_separation_deg));
  }
  return search.Measured(*best);
}

}  // namespace retrolux
