#include "classifier/ground_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace retrolux {

namespace {

constexpr size_t kPartsOfADisc = 8;
// Coverage below which a pixel is ground.
constexpr float kGround = 1e-2f;
// Fewer pixels say nothing of an edge, or of a plane.
constexpr double kLeastOfEdge = 4.0, kLeastOfPlane = 8.0;

size_t NearestPiece(const Polygon& outline, const Vec2d& p) {
  size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < outline.size(); ++i) {
    const Vec2d& a = outline[i];
    const Vec2d step = outline[(i + 1) % outline.size()] - a;
    const double along = std::clamp((p - a).dot(step) / step.squaredNorm(), 0.0, 1.0);
    const double squared = (a + along * step - p).squaredNorm();
    if (squared < least) {
      least = squared;
      nearest = i;
    }
  }
  return nearest;
}

// Sums of the pixels beside one edge, for fits of a plane.
struct Side {
  Mat3d normal = Mat3d::Zero();
  Vec3d right = Vec3d::Zero();

  double Count() const { return normal(0, 0); }
  void Add(const Vec2d& place, double dn) {
    const Vec3d row(1.0, place.x(), place.y());
    normal += row * row.transpose();
    right += dn * row;
  }
};

}  // namespace

double GroundStep(const Patch& patch, const ShapeModel& model, const Polygon& outline,
                  const Coverage& coverage, double noise, double black_dn) {
  const size_t parts =
      model.straight_edges > 0 ? static_cast<size_t>(model.straight_edges) : kPartsOfADisc;
  std::vector<Side> sides(parts);
  Side all;
  for (int y = 0; y < patch.dn.height; ++y) {
    for (int x = 0; x < patch.dn.width; ++x) {
      if (patch.used(x, y) == 0 || coverage.At(x, y)[0] > kGround) continue;
      const size_t piece = NearestPiece(outline, Vec2d(x, y));
      const Vec2d place = PlaceInPatch(patch, Vec2d(x, y));
      const auto dn = static_cast<double>(patch.dn(x, y));
      sides[piece * parts / outline.size()].Add(place, dn);
      all.Add(place, dn);
    }
  }
  if (all.Count() < kLeastOfPlane) return 0.0;
  const double ground = std::max(std::abs(all.right(0) / all.Count() - black_dn), noise);
  double worst = -std::numeric_limits<double>::infinity();
  for (const Side& side : sides) {
    if (side.Count() < kLeastOfEdge || all.Count() - side.Count() < kLeastOfPlane) continue;
    const Eigen::LDLT<Mat3d> rest(all.normal - side.normal + 1e-6 * Mat3d::Identity());
    const Vec3d plane = rest.solve(all.right - side.right);
    const Vec3d middle = side.normal.col(0) / side.Count();
    const double off = side.right(0) / side.Count() - middle.dot(plane);
    const double error = noise * std::sqrt(1.0 / side.Count() + middle.dot(rest.solve(middle)));
    worst = std::max(worst, (std::abs(off) - 3.0 * error) / ground);
  }
  return worst;
}

}  // namespace retrolux
