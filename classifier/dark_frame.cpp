#include "classifier/dark_frame.h"

#include <cmath>

namespace retrolux {

namespace {

constexpr int kPointsAlongSide = 8;
constexpr double kDarker = 0.3;
// Of the bright border: how far beyond the square a point lies, and how far inside.
constexpr double kBeyond = 0.5, kInside = 0.5;

std::optional<double> ValueAt(const FloatPlane& plane, const Vec2d& px) {
  const auto x = static_cast<int>(std::lround(px.x()));
  const auto y = static_cast<int>(std::lround(px.y()));
  if (!plane.Contains(x, y)) return std::nullopt;
  return static_cast<double>(plane(x, y));
}

}  // namespace

double DarkFrame(const FloatPlane& negative, const OutlineMap& map, double square,
                 double contrast_dn) {
  const double border = square - 1.0;
  int points = 0, darker = 0;
  for (int i = 0; i < 4 * kPointsAlongSide; ++i) {
    const double along = 2.0 * (i % kPointsAlongSide + 0.5) / kPointsAlongSide - 1.0;
    const Eigen::Rotation2Dd turn(0.5 * kPi * (i / kPointsAlongSide));
    const Vec2d place = turn * Vec2d(1.0, along);
    const auto inside = ValueAt(negative, map.At((square - kInside * border) * place));
    const auto beyond = ValueAt(negative, map.At((square + kBeyond * border) * place));
    if (!inside || !beyond) continue;
    ++points;
    darker += *beyond - *inside > kDarker * contrast_dn;
  }
  return points == 0 ? 0.0 : static_cast<double>(darker) / points;
}

}  // namespace retrolux
