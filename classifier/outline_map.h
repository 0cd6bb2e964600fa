// How a marker lies in a picture: the map from its square onto the pixels.
#pragma once

#include "core/marker_set.h"

namespace retrolux {

// Coordinates of a marker as it is seen: x right, y DOWN, in halves of its square, so that the map
// onto the picture keeps the sense of rotation. Polynomial of second degree:
//   px = coefficients (1, x, y, x^2, x y, y^2)^T
// The linear part is the view of a flat marker from far away. The squares hold what perspective and
// a curved surface add: 15 mm on a radius of 70 mm, seen at 60 degrees from 1600 mm, bend by up to
// 1.3 px and are pulled by 0.06 px; terms of third degree stay below 0.03 px.
struct OutlineMap {
  static constexpr int kTerms = 6;
  Eigen::Matrix<double, 2, kTerms> coefficients = Eigen::Matrix<double, 2, kTerms>::Zero();

  using Terms = Eigen::Matrix<double, kTerms, 1>;
  static Terms TermsAt(const Vec2d& seen);
  static OutlineMap Affine(const Vec2d& origin_px, const Eigen::Matrix2d& linear);

  Vec2d At(const Vec2d& seen) const { return coefficients * TermsAt(seen); }
  Vec2d Origin() const { return coefficients.col(0); }
  Eigen::Matrix2d Linear() const { return coefficients.middleCols<2>(1); }
  Polygon Of(const Polygon& seen) const;
  // The same map in other pixels: px' = (px - origin_px) / scale.
  OutlineMap InPixels(const Vec2d& origin_px, double scale) const;
};

// What the linear part says of the view, up to the sense of the tilt.
struct ViewOfPlane {
  double half_size_px = 0.0;        // half the marker's square, not foreshortened
  double foreshortening = 0.0;      // cosine of the angle of view; 1 frontal
  Vec2d shortened = Vec2d::Zero();  // unit, the way along which the picture is foreshortened
};
ViewOfPlane ViewOf(const Eigen::Matrix2d& linear);

// A shape of the set, prepared for comparison with pictures. Lengths in halves of the square.
struct ShapeModel {
  static constexpr int kDirections = 64;

  int number = 0;
  int straight_edges = 0;
  Polygon corners;  // as seen, in the order of the marker set
  Polygon outline;  // the same with more points, so that its pieces may bend
  Polygon sides;    // the same with as few points as it needs while it does not
  Vec2d mean = Vec2d::Zero();
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();  // root of the covariance of the area
  std::array<double, kDirections> radii{};           // SpreadRadii of the outline
};
// The shapes of a set, then what is often taken for one of them and never is, with the number
// kDecoy: a square, for strips and panes.
inline constexpr int kDecoy = -1;
std::vector<ShapeModel> ModelsOf(const MarkerSet& markers);

// Mean and root of the covariance of the area inside an outline.
struct AreaMoments {
  Vec2d mean = Vec2d::Zero();
  Eigen::Matrix2d spread = Eigen::Matrix2d::Identity();
};
AreaMoments MomentsOf(const Polygon& outline);

// The distance of the outermost point of the outline from its mean in kDirections directions, the
// first along x, after the area has been stretched to the covariance 1. Two outlines that are
// affine images of each other differ by a turn only (a disc has 2 everywhere).
std::array<double, ShapeModel::kDirections> SpreadRadii(const Polygon& outline,
                                                        const AreaMoments& moments);

}  // namespace retrolux
