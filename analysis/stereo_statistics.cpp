#include "analysis/stereo_statistics.h"

#include <cmath>
#include <map>

#include "analysis/stereo_folder.h"
#include "classifier/registration.h"
#include "classifier/triangulation.h"

namespace retrolux {

namespace {

using Cameras = std::array<CameraModel, 2>;
using PixelPair = std::array<Vec2d, 2>;  // in both pictures

std::optional<Vec3d> InSpace(const Cameras& cameras, const PixelPair& px) {
  // Wide enough to refuse nothing that a picture can show: biases are measured, not sieved.
  TriangulationOptions options;
  options.max_residual_px = 10.0;
  const std::array<Sighting, 2> sightings = {Sighting{&cameras[0], px[0]},
                                             Sighting{&cameras[1], px[1]}};
  const Triangulation found = Triangulate(sightings, options);
  if (!found.point) return std::nullopt;
  return found.point->position;
}

std::optional<PixelPair> FoundPair(const MarkerInPair& marker, size_t exposure, MarkerPoint point) {
  PixelPair pair;
  for (size_t view = 0; view < 2; ++view) {
    const auto& found = marker.views[view].found[exposure];
    if (!found) return std::nullopt;
    pair[view] = point == MarkerPoint::kLight ? found->light : found->centre;
  }
  return pair;
}

size_t Exposures(const MarkerInPair& marker) {
  return marker.views[0].found.size();
}

// Of the exposures in which both cameras found it.
std::vector<PixelPair> FoundPairs(const MarkerInPair& marker, MarkerPoint point) {
  std::vector<PixelPair> pairs;
  for (size_t k = 0; k < Exposures(marker); ++k) {
    if (const auto pair = FoundPair(marker, k, point)) pairs.push_back(*pair);
  }
  return pairs;
}

PixelPair MeanOf(const std::vector<PixelPair>& pairs) {
  PixelPair mean = {Vec2d::Zero(), Vec2d::Zero()};
  for (const PixelPair& pair : pairs) {
    for (size_t view = 0; view < 2; ++view)
      mean[view] += pair[view] / static_cast<double>(pairs.size());
  }
  return mean;
}

// Mean and mean square of numbers or vectors.
struct Sums {
  double count = 0.0, squares = 0.0;
  Vec3d sum = Vec3d::Zero(), axis_squares = Vec3d::Zero();

  void Add(const Vec3d& v) {
    ++count;
    sum += v;
    axis_squares += v.cwiseAbs2();
    squares += v.squaredNorm();
  }
  double Rms() const { return count > 0.0 ? std::sqrt(squares / count) : 0.0; }
};

// Standard error of a mean square whose terms come in clusters of unequal sizes.
double ErrorOfMeanSquare(const std::vector<Sums>& clusters, double mean_square) {
  double all = 0.0, variance = 0.0, used = 0.0;
  for (const Sums& cluster : clusters) {
    if (cluster.count == 0.0) continue;
    all += cluster.count;
    variance += std::pow(cluster.squares - cluster.count * mean_square, 2);
    ++used;
  }
  return used > 1.0 ? std::sqrt(variance * used / (used - 1.0)) / all : mean_square;
}

}  // namespace

SpatialError SpatialErrorOf(const Cameras& cameras, const std::vector<StereoShot>& shots,
                            MarkerPoint point) {
  SpatialError result;
  Sums errors;
  std::vector<Sums> clusters;
  Vec3d scatter = Vec3d::Zero();
  double scatter_px = 0.0, freedoms = 0.0;
  for (const StereoShot& shot : shots) {
    for (const MarkerInPair& marker : shot.markers) {
      result.expected += static_cast<int64_t>(Exposures(marker));
      const std::vector<PixelPair> pairs = FoundPairs(marker, point);
      Sums& cluster = clusters.emplace_back();
      for (const PixelPair& pair : pairs) {
        const auto at = InSpace(cameras, pair);
        if (!at) continue;
        cluster.Add(*at - marker.at);
        errors.Add(*at - marker.at);
      }
      if (cluster.count < 2.0) continue;
      freedoms += cluster.count - 1.0;
      scatter += cluster.axis_squares - cluster.sum.cwiseAbs2() / cluster.count;
      const PixelPair mean = MeanOf(pairs);
      for (const PixelPair& pair : pairs) {
        for (size_t view = 0; view < 2; ++view)
          scatter_px += (pair[view] - mean[view]).squaredNorm() / 4.0;  // a component's
      }
    }
  }
  result.found = static_cast<int64_t>(errors.count);
  if (errors.count == 0.0) return result;
  const double mean_square = errors.squares / errors.count;
  const double spread = 1.96 * ErrorOfMeanSquare(clusters, mean_square);
  result.rms = std::sqrt(mean_square);
  result.rms_low = std::sqrt(std::max(0.0, mean_square - spread));
  result.rms_high = std::sqrt(mean_square + spread);
  result.axis_rms = (errors.axis_squares / errors.count).cwiseSqrt();
  result.bias = errors.sum / errors.count;
  if (freedoms > 0.0) {
    result.noise = (scatter / freedoms).cwiseSqrt();
    result.noise_px = std::sqrt(scatter_px / freedoms);
  }
  return result;
}

namespace {

// Steps of a stage in both pictures and in space.
struct Stage {
  std::string name;
  double squares_px = 0.0;
  Sums space = {};

  void Add(const Cameras& cameras, const PixelPair& from, const PixelPair& to) {
    const auto a = InSpace(cameras, from), b = InSpace(cameras, to);
    if (!a || !b) return;
    for (size_t view = 0; view < 2; ++view)
      squares_px += 0.5 * (to[view] - from[view]).squaredNorm();
    space.Add(*b - *a);
  }
  BudgetLine Line() const {
    return {name, std::sqrt(squares_px / space.count), space.Rms(), space.sum / space.count};
  }
};

struct NoiselessPoints {
  PixelPair projected, outline, radiometric;
};

std::optional<NoiselessPoints> NoiselessOf(const MarkerInPair& marker) {
  NoiselessPoints points;
  for (size_t view = 0; view < 2; ++view) {
    const MarkerInView& in_view = marker.views[view];
    if (!in_view.outline_px || !in_view.radiometric_px) return std::nullopt;
    points.projected[view] = in_view.projected_px;
    points.outline[view] = *in_view.outline_px;
    points.radiometric[view] = *in_view.radiometric_px;
  }
  return points;
}

}  // namespace

std::vector<BudgetLine> ErrorBudget(const Cameras& cameras, const std::vector<StereoShot>& shots,
                                    std::optional<int> number) {
  std::array<Stage, 8> stages = {
      Stage{"geometry"},    Stage{"illumination"},        Stage{"detector"},
      Stage{"sensor"},      Stage{"all of the centroid"}, Stage{"fit: detector"},
      Stage{"fit: sensor"}, Stage{"all of the fit"}};
  for (const StereoShot& shot : shots) {
    for (const MarkerInPair& marker : shot.markers) {
      if (number && marker.known.number != *number) continue;
      const auto noiseless = NoiselessOf(marker);
      const std::vector<PixelPair> light = FoundPairs(marker, MarkerPoint::kLight);
      const std::vector<PixelPair> centre = FoundPairs(marker, MarkerPoint::kCentre);
      if (!noiseless || light.empty()) continue;
      const PixelPair mean_light = MeanOf(light), mean_centre = MeanOf(centre);
      stages[0].Add(cameras, noiseless->projected, noiseless->outline);
      stages[1].Add(cameras, noiseless->outline, noiseless->radiometric);
      stages[2].Add(cameras, noiseless->radiometric, mean_light);
      stages[5].Add(cameras, noiseless->projected, mean_centre);
      for (size_t k = 0; k < light.size(); ++k) {
        stages[3].Add(cameras, mean_light, light[k]);
        stages[4].Add(cameras, noiseless->projected, light[k]);
        stages[6].Add(cameras, mean_centre, centre[k]);
        stages[7].Add(cameras, noiseless->projected, centre[k]);
      }
    }
  }
  std::vector<BudgetLine> lines;
  if (stages[0].space.count == 0.0) return lines;
  for (const Stage& stage : stages) lines.push_back(stage.Line());
  return lines;
}

PoseErrors PoseErrorsOf(const Cameras& cameras, const std::vector<StereoShot>& shots,
                        MarkerPoint point) {
  constexpr size_t kMarkers = 6;
  PoseErrors result;
  double shift2 = 0.0, turn2 = 0.0, fre2 = 0.0, tre2 = 0.0;
  for (const StereoShot& shot : shots) {
    const size_t exposures = Exposures(shot.markers.front());
    for (size_t k = 0; k < exposures; ++k) {
      ++result.exposures;
      std::vector<PointPair> pairs;
      for (const MarkerInPair& marker : shot.markers) {
        const auto pair = FoundPair(marker, k, point);
        if (marker.known.number == 0 || !pair) continue;
        const int edges = DefaultMarkerSet().ByNumber(marker.known.number).straight_edges;
        const double weight = std::pow(RelativeSigma(edges, point), -2);
        if (const auto at = InSpace(cameras, *pair))
          pairs.push_back({marker.known.at, *at, weight});
      }
      if (pairs.size() < kMarkers) continue;
      const Registration found = RegisterPoints(pairs);
      const PoseError error = ErrorOf(found.b_from_a, shot.world_from_target);
      ++result.poses;
      shift2 += error.translation_mm.squaredNorm();
      turn2 += error.rotation_deg * error.rotation_deg;
      fre2 += found.fre_mm * found.fre_mm;
      tre2 += std::pow(
          ExpectedTre_mm(pairs, FleFromFre_mm(found.fre_mm, pairs.size()), Vec3d::Zero()), 2);
    }
  }
  if (result.poses == 0) return result;
  const auto count = static_cast<double>(result.poses);
  result.translation_rms_mm = std::sqrt(shift2 / count);
  result.rotation_rms_deg = std::sqrt(turn2 / count);
  result.fre_rms_mm = std::sqrt(fre2 / count);
  result.expected_tre_mm = std::sqrt(tre2 / count);
  return result;
}

}  // namespace retrolux
