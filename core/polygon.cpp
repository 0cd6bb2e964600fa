#include "core/polygon.h"

#include <algorithm>

namespace retrolux {

namespace {

double Cross(const Vec2d& a, const Vec2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

double SignedArea(const Polygon& polygon) {
  double twice = 0.0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    twice += Cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  }
  return 0.5 * twice;
}

Vec2d Centroid(const Polygon& polygon) {
  // About the first corner, so that a small polygon far from the origin keeps its digits.
  const Vec2d origin = polygon.front();
  double twice = 0.0;
  Vec2d moment = Vec2d::Zero();
  for (size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Vec2d a = polygon[i] - origin;
    const Vec2d b = polygon[i + 1] - origin;
    twice += Cross(a, b);
    moment += Cross(a, b) * (a + b) / 3.0;
  }
  return origin + moment / twice;
}

bool Contains(const Polygon& polygon, const Vec2d& point) {
  bool inside = false;
  for (size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Vec2d& a = polygon[i];
    const Vec2d& b = polygon[j];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double x = a.x() + (b.x() - a.x()) * (point.y() - a.y()) / (b.y() - a.y());
    if (point.x() < x) inside = !inside;
  }
  return inside;
}

Polygon ConvexHull(Polygon points) {
  // Andrew's monotone chain.
  std::sort(points.begin(), points.end(), [](const Vec2d& a, const Vec2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  if (points.size() < 3) return points;
  Polygon hull;
  const auto extend = [&](const Vec2d& p, size_t keep) {
    while (hull.size() >= keep + 2 &&
           Cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0.0) {
      hull.pop_back();
    }
    hull.push_back(p);
  };
  for (const Vec2d& p : points) extend(p, 0);
  const size_t lower = hull.size() - 1;
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) extend(*p, lower);
  hull.pop_back();
  return hull;
}

}  // namespace retrolux
