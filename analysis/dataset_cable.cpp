#include "analysis/dataset_cable.h"

#include <algorithm>
#include <cmath>

namespace retrolux {

namespace {

constexpr int kPoints = 32;
constexpr int kSides = 12;
constexpr double kHalfLength_mm = 230.0;
constexpr double kLeastStep_mm = 1.0;
constexpr int kSmoothings = 6;
constexpr double kAbove_mm = 120.0;  // from where the cable falls onto the mask
constexpr Range kAside_mm{-70.0, 70.0, false};
constexpr Range kLift_mm{0.5, 6.0, false};  // between mask and cable, at most

struct Station {
  Vec3d centre, up;
};

std::vector<Station> WayOver(const DatasetMask& mask, double radius_mm, const SceneDraw& draw,
                             const std::string& name) {
  const double angle = kPi * draw.Uniform(name + " angle");
  const Vec3d along(0.0, std::cos(angle), std::sin(angle));
  const Vec3d aside(0.0, -std::sin(angle), std::cos(angle));
  const double offset = kAside_mm.Draw(draw, name + " aside");
  const double lift = kLift_mm.Draw(draw, name + " lift");
  const double phase = 2.0 * kPi * draw.Uniform(name + " phase");
  std::vector<Station> way;
  for (int i = 0; i < kPoints; ++i) {
    const double t = 2.0 * i / (kPoints - 1) - 1.0;
    Vec3d above = mask.middle + offset * aside + t * kHalfLength_mm * along;
    above.x() = mask.middle.x() + kAbove_mm;
    const SurfacePoint point = NearestSurfacePoint(mask.mesh, above);
    const double wave = 0.5 * (1.0 + std::sin(7.0 * t + phase));
    const Vec3d centre = point.position + (radius_mm + lift * wave) * point.normal;
    // Beyond the rim of an open mask all places have the same point of it.
    if (way.empty() || (centre - way.back().centre).norm() > kLeastStep_mm)
      way.push_back({centre, point.normal});
  }
  // A cable does not follow every fold.
  for (int k = 0; k < kSmoothings; ++k) {
    const std::vector<Station> rough = way;
    for (size_t i = 1; i + 1 < way.size(); ++i) {
      way[i].centre =
          0.25 * rough[i - 1].centre + 0.5 * rough[i].centre + 0.25 * rough[i + 1].centre;
      way[i].up = (rough[i - 1].up + 2.0 * rough[i].up + rough[i + 1].up).normalized();
    }
  }
  return way;
}

}  // namespace

TriangleMesh CableOver(const DatasetMask& mask, double radius_mm, const SceneDraw& draw,
                       const std::string& name) {
  const std::vector<Station> way = WayOver(mask, radius_mm, draw, name);
  TriangleMesh tube;
  for (size_t i = 0; i < way.size(); ++i) {
    const Vec3d ahead =
        way[std::min(i + 1, way.size() - 1)].centre - way[i == 0 ? 0 : i - 1].centre;
    const Vec3d side = ahead.cross(way[i].up).normalized();
    const Vec3d up = side.cross(ahead).normalized();
    for (int k = 0; k < kSides; ++k) {
      const double angle = 2.0 * kPi * k / kSides;
      const Vec3d out = std::cos(angle) * side + std::sin(angle) * up;
      tube.positions.push_back((way[i].centre + radius_mm * out).cast<float>());
      tube.normals.push_back(out.cast<float>());
    }
  }
  for (uint32_t i = 0; i + 1 < way.size(); ++i) {
    for (uint32_t k = 0; k < kSides; ++k) {
      const uint32_t a = i * kSides + k, b = i * kSides + (k + 1) % kSides;
      tube.triangles.push_back({a, a + kSides, b});
      tube.triangles.push_back({b, a + kSides, b + kSides});
    }
  }
  return tube;
}

}  // namespace retrolux
