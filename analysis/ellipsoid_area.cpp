#include "analysis/ellipsoid_area.h"

#include <cmath>
#include <vector>

#include "analysis/cap_area.h"

namespace retrolux {

namespace {

struct Node {
  double x, weight;  // on [0, 1]
};

// Gauss-Legendre: the roots of P_n by Newton's method (Abramowitz and Stegun 25.4.29).
std::vector<Node> GaussLegendre(int n) {
  std::vector<Node> nodes;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(kPi * (i + 0.75) / (n + 0.5));
    double slope = 0.0, step = 1.0;
    while (std::abs(step) > 1e-15) {
      double p = 1.0, previous = 0.0;
      for (int k = 1; k <= n; ++k) {
        const double before = previous;
        previous = p;
        p = ((2.0 * k - 1.0) * x * previous - (k - 1.0) * before) / k;
      }
      slope = n * (x * p - previous) / (x * x - 1.0);
      step = p / slope;
      x -= step;
    }
    nodes.push_back({0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope)});
  }
  return nodes;
}

// The map x = diag(s) u stretches the unit sphere's area at u by s_x s_y s_z |u / s|.
double Stretch(const Vec3d& semi_axes, const Vec3d& u) {
  return semi_axes.prod() * u.cwiseQuotient(semi_axes).norm();
}

double SectorIntegral(const Vec3d& semi_axes, const CapFan& fan, const Cap& cap,
                      const CapFan::Sector& sector, const std::vector<Node>& nodes) {
  const double width = sector.end - sector.begin;
  double sum = 0.0;
  for (const Node& a : nodes) {
    const double azimuth = sector.begin + width * a.x;
    const double reach = fan.Reach(cap, azimuth);
    const Vec3d direction = fan.Direction(azimuth);
    for (const Node& b : nodes) {
      const double sine = std::sin(reach * b.x);
      const Vec3d u = std::cos(reach * b.x) * fan.pole + sine * direction;
      sum += a.weight * b.weight * reach * sine * Stretch(semi_axes, u);
    }
  }
  return width * sum;
}

double FanIntegral(const Vec3d& semi_axes, const CapFan& fan, std::span<const Cap> caps, int n) {
  const std::vector<Node> nodes = GaussLegendre(n);
  double sum = 0.0;
  for (const CapFan::Sector& sector : fan.sectors) {
    sum += SectorIntegral(semi_axes, fan, caps[sector.cap], sector, nodes);
  }
  return sum;
}

}  // namespace

double EllipsoidVisibleArea(const Vec3d& semi_axes_mm, std::span<const Vec3d> cameras) {
  // Scaled to the unit sphere, a camera sees a cap of it.
  std::vector<Cap> caps;
  for (const Vec3d& camera : cameras) {
    const Vec3d scaled = camera.cwiseQuotient(semi_axes_mm);
    if (scaled.norm() <= 1.0) return 0.0;
    caps.push_back(VisibleCap(Vec3d::Zero(), 1.0, scaled));
  }
  const CapFan fan(caps);
  constexpr int kMostNodes = 256;
  double area = 0.0, coarser = -1.0;
  for (int n = 16; n <= kMostNodes && std::abs(area - coarser) > 1e-11 * area; n *= 2) {
    coarser = area;
    area = FanIntegral(semi_axes_mm, fan, caps, n);
  }
  return area;
}

}  // namespace retrolux
