#include "classifier/shape_match.h"

#include <cmath>
#include <limits>

#include "core/error.h"

namespace retrolux {

constexpr double kEqual_px = 1e-6;

ShapeMatch MatchShape(const Polygon& corners_px, const MarkerShape& shape, double size_mm) {
  const auto count = static_cast<Eigen::Index>(corners_px.size());
  RETROLUX_CHECK(corners_px.size() == shape.outline_mm.size(), "{} corners for '{}'",
                 corners_px.size(), shape.name);
  Eigen::MatrixX3d outline(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    outline.row(i) << shape.outline_mm[static_cast<size_t>(i)].transpose(), 1.0;
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixX3d> solver(outline);
  ShapeMatch best;
  best.rms_px = std::numeric_limits<double>::infinity();
  for (Eigen::Index first = 0; first < count; ++first) {
    Eigen::MatrixX2d corners(count, 2);
    for (Eigen::Index i = 0; i < count; ++i) {
      corners.row(i) = corners_px[static_cast<size_t>((first + i) % count)].transpose();
    }
    const Eigen::Matrix<double, 3, 2> map = solver.solve(corners);
    const double rms =
        std::sqrt((outline * map - corners).squaredNorm() / static_cast<double>(count));
    const Vec2d stretch = Eigen::JacobiSVD<Eigen::Matrix2d>(map.topRows<2>()).singularValues();
    const double foreshortening = stretch.x() > 0.0 ? stretch.y() / stretch.x() : 0.0;
    const bool equal = std::abs(rms - best.rms_px) < kEqual_px;
    if (equal ? foreshortening > best.foreshortening : rms < best.rms_px) {
      best = {static_cast<size_t>(first), rms, stretch.x() * size_mm, foreshortening};
    }
  }
  return best;
}

}  // namespace retrolux
