#include "classifier/proposals.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace retrolux {

namespace {

constexpr int kDirections = ShapeModel::kDirections;
constexpr int kRefinements = 3;
// Points of the outline that are compared; more change nothing.
constexpr size_t kMostPoints = 72;

// Turns whose maps are refined, of all markers: the right one is among the best few.
constexpr size_t kMostRefined = 10;

struct Turn {
  size_t model;
  int steps;          // of 2 pi / kDirections
  double difference;  // mean squared difference of the radii
};

// The turns at which the radii agree best: the smallest local minima.
std::vector<Turn> BestTurns(const std::array<double, kDirections>& radii,
                            const std::vector<ShapeModel>& models, size_t model, int turns) {
  std::array<double, kDirections> difference{};
  for (int turn = 0; turn < kDirections; ++turn) {
    double sum = 0.0;
    for (int k = 0; k < kDirections; ++k) {
      const double d = radii[static_cast<size_t>((k + turn) % kDirections)] -
                       models[model].radii[static_cast<size_t>(k)];
      sum += d * d;
    }
    difference[static_cast<size_t>(turn)] = sum / kDirections;
  }
  std::vector<Turn> best;
  for (int turn = 0; turn < kDirections; ++turn) {
    const double here = difference[static_cast<size_t>(turn)];
    const double before = difference[static_cast<size_t>((turn + kDirections - 1) % kDirections)];
    const double after = difference[static_cast<size_t>((turn + 1) % kDirections)];
    if (here <= before && here < after) best.push_back({model, turn, here});
  }
  if (best.empty()) best.push_back({model, 0, difference[0]});  // a disc
  const size_t keep = std::min(best.size(), static_cast<size_t>(turns));
  std::partial_sort(best.begin(), best.begin() + static_cast<ptrdiff_t>(keep), best.end(),
                    [](const Turn& a, const Turn& b) { return a.difference < b.difference; });
  best.resize(keep);
  return best;
}

// The place on a closed outline that is nearest to a point.
struct Nearest {
  size_t piece = 0;
  double along = 0.0;  // 0..1 on the piece
  double squared = std::numeric_limits<double>::infinity();
};

Nearest NearestOn(const Polygon& outline, const Vec2d& p) {
  Nearest nearest;
  for (size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
    const Vec2d& a = outline[j];
    const Vec2d step = outline[i] - a;
    const double along = std::clamp((p - a).dot(step) / step.squaredNorm(), 0.0, 1.0);
    const double squared = (a + along * step - p).squaredNorm();
    if (squared < nearest.squared) nearest = {j, along, squared};
  }
  return nearest;
}

// One step of least squares; returns the mean squared distance before it.
double Refine(const Polygon& points, const ShapeModel& model, OutlineMap& map) {
  const Polygon mapped = map.Of(model.sides);
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
  double squares = 0.0;
  for (const Vec2d& p : points) {
    const Nearest nearest = NearestOn(mapped, p);
    squares += nearest.squared;
    const size_t next = (nearest.piece + 1) % mapped.size();
    const Vec2d edge = (mapped[next] - mapped[nearest.piece]).normalized();
    const Vec2d across(-edge.y(), edge.x());
    const Vec2d seen = model.sides[nearest.piece] +
                       nearest.along * (model.sides[next] - model.sides[nearest.piece]);
    const Vec2d foot =
        mapped[nearest.piece] + nearest.along * (mapped[next] - mapped[nearest.piece]);
    Eigen::Matrix<double, 6, 1> row;
    row << across.x() * Vec3d(1.0, seen.x(), seen.y()), across.y() * Vec3d(1.0, seen.x(), seen.y());
    normal += row * row.transpose();
    right += row * across.dot(p - foot);
  }
  // A disc may turn without any change: hold what nothing says.
  normal.diagonal().array() += 1e-3 * static_cast<double>(points.size());
  const Eigen::Matrix<double, 6, 1> change = normal.ldlt().solve(right);
  map.coefficients.row(0).head<3>() += change.head<3>().transpose();
  map.coefficients.row(1).head<3>() += change.tail<3>().transpose();
  return squares / static_cast<double>(points.size());
}

double RmsDistance(const Polygon& points, const ShapeModel& model, const OutlineMap& map) {
  const Polygon mapped = map.Of(model.sides);
  double squares = 0.0;
  for (const Vec2d& p : points) squares += NearestOn(mapped, p).squared;
  return std::sqrt(squares / static_cast<double>(points.size()));
}

Polygon Thinned(const Polygon& outline) {
  const size_t step = (outline.size() + kMostPoints - 1) / kMostPoints;
  Polygon points;
  for (size_t i = 0; i < outline.size(); i += step) points.push_back(outline[i]);
  return points;
}

Proposal Refined(const Polygon& points, const std::vector<ShapeModel>& models, size_t model,
                 const OutlineMap& guess) {
  Proposal proposal{model, guess, 0.0};
  for (int i = 0; i < kRefinements; ++i) Refine(points, models[model], proposal.map);
  proposal.rms_px = RmsDistance(points, models[model], proposal.map);
  return proposal;
}

}  // namespace

std::vector<Proposal> ProposeMarkers(const Polygon& outline, const std::vector<ShapeModel>& models,
                                     int turns) {
  const AreaMoments moments = MomentsOf(outline);
  const auto radii = SpreadRadii(outline, moments);
  const Polygon points = Thinned(outline);
  std::vector<Turn> best;
  for (size_t m = 0; m < models.size(); ++m) {
    const std::vector<Turn> of_model = BestTurns(radii, models, m, turns);
    best.insert(best.end(), of_model.begin(), of_model.end());
  }
  std::stable_sort(best.begin(), best.end(),
                   [](const Turn& a, const Turn& b) { return a.difference < b.difference; });
  best.resize(std::min(best.size(), kMostRefined));
  std::vector<Proposal> proposals;
  for (const Turn& turn : best) {
    const ShapeModel& model = models[turn.model];
    const Eigen::Matrix2d rotation =
        Eigen::Rotation2Dd(2.0 * kPi * turn.steps / kDirections).toRotationMatrix();
    const Eigen::Matrix2d linear = moments.spread * rotation * model.spread.inverse();
    const Vec2d origin = moments.mean - linear * model.mean;
    proposals.push_back(Refined(points, models, turn.model, OutlineMap::Affine(origin, linear)));
  }
  std::stable_sort(proposals.begin(), proposals.end(),
                   [](const Proposal& a, const Proposal& b) { return a.rms_px < b.rms_px; });
  return proposals;
}

Proposal RefineProposal(const Polygon& outline, const std::vector<ShapeModel>& models, size_t model,
                        const OutlineMap& guess) {
  return Refined(Thinned(outline), models, model, guess);
}

}  // namespace retrolux
