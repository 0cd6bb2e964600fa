#include "classifier/outline_map.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace retrolux {

namespace {

constexpr int kPiecesOfAnEdge = 6;
// Corners of a disc in the marker set beyond these are more than a picture shows.
constexpr size_t kRoundPieces = 48, kRoundSides = 24;

double Cross(const Vec2d& a, const Vec2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

Polygon Seen(const Polygon& outline_mm, double half_mm) {
  Polygon seen;
  for (const Vec2d& p : outline_mm) seen.push_back(Vec2d(p.x(), -p.y()) / half_mm);
  return seen;
}

// A disc with fewer corners and the same area.
Polygon Thinned(const Polygon& round, size_t count) {
  Polygon thin;
  for (size_t i = 0; i < count; ++i) thin.push_back(round[i * round.size() / count]);
  const double grow = std::sqrt(SignedArea(round) / SignedArea(thin));
  const Vec2d centre = Centroid(thin);
  for (Vec2d& p : thin) p = centre + grow * (p - centre);
  return thin;
}

Polygon Divided(const Polygon& corners) {
  Polygon outline;
  for (size_t i = 0; i < corners.size(); ++i) {
    const Vec2d& a = corners[i];
    const Vec2d& b = corners[(i + 1) % corners.size()];
    for (int k = 0; k < kPiecesOfAnEdge; ++k) outline.push_back(a + (b - a) * k / kPiecesOfAnEdge);
  }
  return outline;
}

ShapeModel ModelOf(const MarkerShape& shape, double half_mm) {
  ShapeModel model;
  model.number = shape.number;
  model.straight_edges = shape.straight_edges;
  model.corners = Seen(shape.outline_mm, half_mm);
  const bool round = shape.straight_edges == 0 && model.corners.size() > kRoundPieces;
  model.outline = round ? Thinned(model.corners, kRoundPieces) : Divided(model.corners);
  model.sides = round ? Thinned(model.corners, kRoundSides) : model.corners;
  const AreaMoments moments = MomentsOf(model.outline);
  model.mean = moments.mean;
  model.spread = moments.spread;
  model.radii = SpreadRadii(model.outline, moments);
  return model;
}

}  // namespace

OutlineMap::Terms OutlineMap::TermsAt(const Vec2d& seen) {
  const double x = seen.x();
  const double y = seen.y();
  Terms terms;
  terms << 1.0, x, y, x * x, x * y, y * y;
  return terms;
}

OutlineMap OutlineMap::Affine(const Vec2d& origin_px, const Eigen::Matrix2d& linear) {
  OutlineMap map;
  map.coefficients.col(0) = origin_px;
  map.coefficients.middleCols<2>(1) = linear;
  return map;
}

Polygon OutlineMap::Of(const Polygon& seen) const {
  Polygon points;
  points.reserve(seen.size());
  for (const Vec2d& p : seen) points.push_back(At(p));
  return points;
}

OutlineMap OutlineMap::InPixels(const Vec2d& origin_px, double scale) const {
  OutlineMap map{coefficients / scale};
  map.coefficients.col(0) -= origin_px / scale;
  return map;
}

ViewOfPlane ViewOf(const Eigen::Matrix2d& linear) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(linear * linear.transpose());
  const Vec2d lengths = axes.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  if (!(lengths.y() > 0.0)) return {};
  return {lengths.y(), lengths.x() / lengths.y(), axes.eigenvectors().col(0)};
}

std::vector<ShapeModel> ModelsOf(const MarkerSet& markers) {
  std::vector<ShapeModel> models;
  for (const MarkerShape& shape : markers.shapes) {
    models.push_back(ModelOf(shape, 0.5 * markers.size_mm));
  }
  const MarkerShape square{kDecoy, "square", {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, 4};
  models.push_back(ModelOf(square, 1.0));
  return models;
}

AreaMoments MomentsOf(const Polygon& outline) {
  AreaMoments moments;
  moments.mean = Centroid(outline);
  // By triangles from the mean: integral of p p^T over the triangle (0, a, b) is
  // cross(a, b) / 24 (a a^T + b b^T + (a + b)(a + b)^T).
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  double area = 0.0;
  for (size_t i = 0; i < outline.size(); ++i) {
    const Vec2d a = outline[i] - moments.mean;
    const Vec2d b = outline[(i + 1) % outline.size()] - moments.mean;
    const double cross = Cross(a, b);
    area += 0.5 * cross;
    squares +=
        cross / 24.0 * (a * a.transpose() + b * b.transpose() + (a + b) * (a + b).transpose());
  }
  moments.spread = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(squares / area).operatorSqrt();
  return moments;
}

std::array<double, ShapeModel::kDirections> SpreadRadii(const Polygon& outline,
                                                        const AreaMoments& moments) {
  constexpr int kCount = ShapeModel::kDirections;
  constexpr double kStep = 2.0 * kPi / kCount;
  static const std::array<Vec2d, kCount> directions = [] {
    std::array<Vec2d, kCount> all;
    for (int k = 0; k < kCount; ++k) {
      all[static_cast<size_t>(k)] = {std::cos(k * kStep), std::sin(k * kStep)};
    }
    return all;
  }();
  const Eigen::Matrix2d stretch = moments.spread.inverse();
  std::array<double, kCount> radii{};
  Vec2d a = stretch * (outline.back() - moments.mean);
  double angle_a = std::atan2(a.y(), a.x());
  for (const Vec2d& p : outline) {
    const Vec2d b = stretch * (p - moments.mean);
    const double angle_b = std::atan2(b.y(), b.x());
    // The directions between a and b, the short way round.
    const double turn = std::remainder(angle_b - angle_a, 2.0 * kPi);
    const double low = turn >= 0.0 ? angle_a : angle_a + turn;
    const int first = static_cast<int>(std::ceil(low / kStep));
    const int last = static_cast<int>(std::floor((low + std::abs(turn)) / kStep));
    for (int k = first; k <= last; ++k) {
      const auto i = static_cast<size_t>((k % kCount + kCount) % kCount);
      const double across = Cross(directions[i], b - a);
      if (across != 0.0) radii[i] = std::max(radii[i], Cross(a, b - a) / across);
    }
    a = b;
    angle_a = angle_b;
  }
  return radii;
}

}  // namespace retrolux
