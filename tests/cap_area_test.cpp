#include "analysis/cap_area.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/disc_area.h"
#include "analysis/ellipsoid_area.h"
#include "core/rng.h"
#include "tests/statistics.h"

namespace retrolux {
namespace {

constexpr double kRightAngle = 0.5 * kPi;

Vec3d RandomDirection(KeyedRng& rng) {
  const double z = 2.0 * rng.NextDouble() - 1.0;
  const double phi = 2.0 * kPi * rng.NextDouble();
  const double rho = std::sqrt(1.0 - z * z);
  return {rho * std::cos(phi), rho * std::sin(phi), z};
}

// A direction at the angle psi from z.
Vec3d Tilted(double psi) {
  return {std::sin(psi), 0.0, std::cos(psi)};
}

bool Contains(const Cap& cap, const Vec3d& u) {
  return cap.axis.dot(u) >= std::cos(cap.half_angle);
}

bool InAll(const std::vector<Cap>& caps, const Vec3d& u) {
  return std::all_of(caps.begin(), caps.end(), [&](const Cap& c) { return Contains(c, u); });
}

// How surprising `hits` of `trials` are where each hits with probability `share`.
double BinomialPValue(double hits, double trials, double share) {
  return statistics::NormalPValue((hits - trials * share) /
                                  std::sqrt(trials * share * (1.0 - share)));
}

void ExpectUnsurprising(const std::vector<double>& p_values) {
  const double significance = statistics::Sidak(0.01, static_cast<double>(p_values.size()));
  for (size_t i = 0; i < p_values.size(); ++i) EXPECT_GT(p_values[i], significance) << i;
}

// Caps that have something in common: all contain one point.
std::vector<Cap> RandomCaps(KeyedRng& rng, int count) {
  const Vec3d common = RandomDirection(rng);
  std::vector<Cap> caps;
  while (static_cast<int>(caps.size()) < count) {
    const Cap cap = {RandomDirection(rng), RadFromDeg(20.0 + 69.0 * rng.NextDouble())};
    if (Contains(cap, common)) caps.push_back(cap);
  }
  return caps;
}

TEST(CapArea, WhatTheCamerasOfTheVaultSeeOfASphere) {
  // r = 100 mm at 1600 mm: half-angle acos(1/16), 2 pi (1 - 1/16) r^2 = 5.890 r^2; a pair 80
  // degrees apart 3.1045 r^2 (not 2 pi and 2 pi - 2 psi = 3.4907, which holds for cameras at
  // infinity).
  const Cap cap = VisibleCap({1, 2, 3}, 100.0, {1, 2, 1603});
  EXPECT_NEAR(cap.half_angle, std::acos(1.0 / 16.0), 1e-15);
  EXPECT_EQ(cap.axis, Vec3d::UnitZ());
  EXPECT_NEAR(CapArea(100.0, cap.half_angle), 2.0 * kPi * 15.0 / 16.0 * 1e4, 1e-9);
  EXPECT_NEAR(TwoCapArea(100.0, cap.half_angle, cap.half_angle, RadFromDeg(80)), 3.1045e4, 0.5);
  EXPECT_NEAR(FarPairArea(100.0, RadFromDeg(80)), 3.4907e4, 0.5);
}

TEST(CapArea, TwoHemispheresShareALune) {
  // A lune of angle pi - psi is the share (pi - psi) / 2 pi of 4 pi.
  for (const double deg : {1e-6, 1.0, 56.0, 90.0, 179.0, 179.999999}) {
    EXPECT_NEAR(TwoCapArea(1.0, kRightAngle, kRightAngle, RadFromDeg(deg)),
                2.0 * (kPi - RadFromDeg(deg)), 1e-13);
    EXPECT_NEAR(FarPairArea(1.0, RadFromDeg(deg)), 2.0 * (kPi - RadFromDeg(deg)), 1e-13);
  }
}

TEST(CapArea, TwoCapsApartInsideAndAllAround) {
  EXPECT_EQ(TwoCapArea(3.0, 0.5, 0.7, 1.2), 0.0);
  EXPECT_EQ(TwoCapArea(3.0, 0.5, 0.7, 3.0), 0.0);
  EXPECT_EQ(TwoCapArea(3.0, 0.5, 0.7, 0.0), CapArea(3.0, 0.5));
  EXPECT_EQ(TwoCapArea(3.0, 0.7, 0.5, 0.19), CapArea(3.0, 0.5));
  // Caps of 2 and 2.2 rad, axes opposite: a belt between polar angles pi - 2.2 and 2.
  EXPECT_NEAR(TwoCapArea(1.0, 2.0, 2.2, kPi), 2.0 * kPi * (std::cos(kPi - 2.2) - std::cos(2.0)),
              1e-14);
  // No jump where the cases meet.
  for (const double psi : {0.2, 1.2}) {
    EXPECT_NEAR(TwoCapArea(1.0, 0.5, 0.7, psi - 1e-9), TwoCapArea(1.0, 0.5, 0.7, psi + 1e-9), 1e-8);
  }
}

TEST(CapArea, ACapAndItsComplementShareOutAnotherCap) {
  // The complement of (axis, a) is (-axis, pi - a).
  KeyedRng rng(1);
  for (int i = 0; i < 10000; ++i) {
    const double a = kPi * rng.NextDouble(), b = kPi * rng.NextDouble(),
                 psi = kPi * rng.NextDouble();
    EXPECT_NEAR(TwoCapArea(1.0, a, b, psi) + TwoCapArea(1.0, a, kPi - b, kPi - psi),
                CapArea(1.0, a), 1e-12)
        << a << " " << b << " " << psi;
    EXPECT_NEAR(TwoCapArea(1.0, a, b, psi), TwoCapArea(1.0, b, a, psi), 1e-12);
  }
}

TEST(CapArea, TwoCapsAsRandomPointsCountThem) {
  KeyedRng rng(2);
  std::vector<double> p_values;
  const int trials = 50000;
  for (const Vec3d& case_deg : {Vec3d(86.4, 86.4, 80), Vec3d(40, 60, 50), Vec3d(120, 100, 60),
                                Vec3d(20, 150, 140), Vec3d(130, 130, 170)}) {
    const Vec3d c = case_deg * RadFromDeg(1.0);
    const std::vector<Cap> caps = {{Vec3d::UnitZ(), c[0]}, {Tilted(c[2]), c[1]}};
    int hits = 0;
    for (int i = 0; i < trials; ++i) hits += InAll(caps, RandomDirection(rng)) ? 1 : 0;
    p_values.push_back(
        BinomialPValue(hits, trials, TwoCapArea(1.0, c[0], c[1], c[2]) / (4.0 * kPi)));
  }
  ExpectUnsurprising(p_values);
}

TEST(CapIntersectionArea, OneAndTwoCapsAsTheirOwnFormulas) {
  KeyedRng rng(3);
  for (int i = 0; i < 2000; ++i) {
    const Cap a = {RandomDirection(rng), kRightAngle * rng.NextDouble()};
    const Cap b = {RandomDirection(rng), kRightAngle * rng.NextDouble()};
    const double psi = std::atan2(a.axis.cross(b.axis).norm(), a.axis.dot(b.axis));
    EXPECT_NEAR(CapIntersectionArea(2.0, std::vector{a}), CapArea(2.0, a.half_angle), 1e-12);
    EXPECT_NEAR(CapIntersectionArea(2.0, std::vector{a, b}),
                TwoCapArea(2.0, a.half_angle, b.half_angle, psi), 1e-10);
    EXPECT_NEAR(CapIntersectionArea(2.0, std::vector{a, b, a, b}),
                TwoCapArea(2.0, a.half_angle, b.half_angle, psi), 1e-10);
  }
}

TEST(CapIntersectionArea, ThreeOfOneRigWhereTheMiddleOneDoesNotMatter) {
  // Axes in one plane at -psi, 0, psi, equal half-angles a: the lens of the outer two has its
  // corners at acos(cos(a) / cos(psi)) < a from the middle axis, and lies in the middle cap.
  const double a = std::acos(1.0 / 16.0);
  for (const double psi_deg : {5.0, 20.0, 40.0, 80.0, 86.0}) {
    const double psi = RadFromDeg(psi_deg);
    std::vector<Cap> caps = {{Tilted(-psi), a}, {Tilted(0), a}, {Tilted(psi), a}};
    const double lens = TwoCapArea(1.0, a, a, 2.0 * psi);
    EXPECT_NEAR(CapIntersectionArea(1.0, caps), lens, 1e-13) << psi_deg;
    // The middle one's edge through those corners, and a rounding to either side.
    for (const double error : {-1e-12, -1e-15, 0.0, 1e-15, 1e-12}) {
      caps[1].half_angle = std::acos(std::cos(a) / std::cos(psi)) + error;
      EXPECT_NEAR(CapIntersectionArea(1.0, caps), lens, 1e-10) << psi_deg << " " << error;
    }
  }
}

TEST(CapIntersectionArea, AnOctantOfTheSphere) {
  // Three hemispheres at right angles, 4 pi / 8; each shrunk by e, they lose a strip of length pi /
  // 2 and width e at each of three sides.
  const double e = 1e-9;
  const std::vector<Cap> caps = {{Vec3d::UnitX(), kRightAngle - e},
                                 {Vec3d::UnitY(), kRightAngle - e},
                                 {Vec3d::UnitZ(), kRightAngle - e}};
  EXPECT_NEAR(CapIntersectionArea(1.0, caps), kRightAngle - 3.0 * kRightAngle * e, 1e-12);
}

TEST(CapIntersectionArea, NothingInCommonAndWhollyContained) {
  const Cap z = {Vec3d::UnitZ(), 1.0}, far = {Tilted(2.1), 1.0}, small = {Tilted(0.3), 0.2};
  EXPECT_EQ(CapIntersectionArea(1.0, std::vector{z, far}), 0.0);
  EXPECT_EQ(CapIntersectionArea(1.0, std::vector{far, small, z}), 0.0);
  EXPECT_NEAR(CapIntersectionArea(1.0, std::vector{z, small}), CapArea(1.0, 0.2), 1e-14);
  EXPECT_NEAR(CapIntersectionArea(1.0, {}), 4.0 * kPi, 1e-14);
  // Three that share something two by two but not together: axes on a circle of 0.6 rad around z.
  std::vector<Cap> ring;
  for (const double azimuth : {0.0, 2.0, 4.0}) {
    ring.push_back({Eigen::AngleAxisd(azimuth, Vec3d::UnitZ()) * Tilted(0.6), 0.58});
  }
  EXPECT_GT(CapIntersectionArea(1.0, std::vector{ring[0], ring[1]}), 0.01);
  EXPECT_EQ(CapIntersectionArea(1.0, ring), 0.0);
  // Two that touch: acos(-1/3) apart, each of half that.
  const double touch = std::acos(std::sqrt(1.0 / 3.0));
  const std::vector<Cap> tangent = {{Vec3d(-2, 1, 2) / 3.0, touch}, {-Vec3d::UnitY(), touch}};
  EXPECT_NEAR(CapIntersectionArea(1.0, tangent), 0.0, 1e-12);
}

TEST(CapIntersectionArea, TwoHalvesMakeTheWhole) {
  // Hemispheres (less 1e-10) around +-u share out anything.
  KeyedRng rng(4);
  for (int count = 1; count <= 7; ++count) {
    for (int i = 0; i < 200; ++i) {
      std::vector<Cap> caps = RandomCaps(rng, count);
      const double whole = CapIntersectionArea(1.0, caps);
      const Vec3d u = RandomDirection(rng);
      double halves = 0.0;
      for (const double sign : {-1.0, 1.0}) {
        std::vector<Cap> half = caps;
        half.insert(half.begin() + i % (count + 1), {sign * u, kRightAngle - 1e-10});
        halves += CapIntersectionArea(1.0, half);
      }
      EXPECT_NEAR(halves, whole, 1e-8) << count << " caps, " << i;
    }
  }
}

TEST(CapIntersectionArea, EdgesThatTouchAndCornersThatCoincide) {
  // Axes on a lattice and few half-angles: tangent caps, equal ones, three edges through one point.
  // Shrinking all half-angles by up to e takes no more than e times the boundary, < 2 pi, and no
  // jump; two halves still make the whole.
  KeyedRng rng(8);
  const auto small = [&](int count) { return std::floor(count * rng.NextDouble()); };
  const double e = 1e-8;
  int some = 0;
  for (int i = 0; i < 3000; ++i) {
    std::vector<Cap> caps;
    while (caps.size() < 2 + static_cast<size_t>(i) % 6) {
      const Vec3d axis = {small(5) - 2.0, small(5) - 2.0, small(3)};
      const double cosines[] = {0.5, 0.25, 1.0 / 16.0, std::sqrt(1.0 / 3.0), std::sqrt(0.5)};
      const double half_angle = std::acos(cosines[static_cast<size_t>(small(5))]);
      if (!axis.isZero()) caps.push_back({axis.normalized(), half_angle});
    }
    const double whole = CapIntersectionArea(1.0, caps);
    some += whole > 0.0 ? 1 : 0;
    const Vec3d u = RandomDirection(rng);
    double halves = 0.0;
    for (const double sign : {-1.0, 1.0}) {
      std::vector<Cap> half = caps;
      half.push_back({sign * u, kRightAngle - 1e-10});
      halves += CapIntersectionArea(1.0, half);
    }
    EXPECT_NEAR(halves, whole, 1e-8) << i;
    for (Cap& cap : caps) cap.half_angle -= e * rng.NextDouble();
    EXPECT_NEAR(CapIntersectionArea(1.0, caps), whole, 2.0 * kPi * e) << i;
  }
  EXPECT_GT(some, 1000);
}

TEST(CapIntersectionArea, RandomPointsFallIntoItAndIntoTheUnion) {
  KeyedRng rng(5);
  std::vector<double> p_values;
  const int trials = 20000;
  for (int i = 0; i < 60; ++i) {
    const std::vector<Cap> caps = RandomCaps(rng, 2 + i % 6);
    int hits = 0;
    for (int k = 0; k < trials; ++k) hits += InAll(caps, RandomDirection(rng)) ? 1 : 0;
    const double share = CapIntersectionArea(1.0, caps) / (4.0 * kPi);
    if (share * trials > 20.0) p_values.push_back(BinomialPValue(hits, trials, share));
  }
  EXPECT_GT(p_values.size(), 40u);
  // Inclusion-exclusion: |A or B or C| = sum |A| - sum |A and B| + |A and B and C|.
  for (int i = 0; i < 10; ++i) {
    const std::vector<Cap> c = RandomCaps(rng, 3);
    double share = CapIntersectionArea(1.0, c);
    for (int k = 0; k < 3; ++k) {
      share += CapArea(1.0, c[k].half_angle);
      share -= CapIntersectionArea(1.0, std::vector{c[k], c[(k + 1) % 3]});
    }
    int hits = 0;
    for (int k = 0; k < trials; ++k) {
      const Vec3d u = RandomDirection(rng);
      hits += std::any_of(c.begin(), c.end(), [&](const Cap& cap) { return Contains(cap, u); });
    }
    p_values.push_back(BinomialPValue(hits, trials, share / (4.0 * kPi)));
  }
  ExpectUnsurprising(p_values);
}

TEST(EllipsoidVisibleArea, ASphereIsACap) {
  const std::vector<Vec3d> cameras = {{0, 0, 1600}, 1600.0 * Tilted(RadFromDeg(80))};
  const double a = std::acos(1.0 / 16.0);
  EXPECT_NEAR(EllipsoidVisibleArea({100, 100, 100}, cameras[0]) / CapArea(100, a), 1.0, 1e-12);
  EXPECT_NEAR(
      EllipsoidVisibleArea({100, 100, 100}, cameras) / TwoCapArea(100, a, a, RadFromDeg(80)), 1.0,
      1e-12);
  EXPECT_EQ(EllipsoidVisibleArea({100, 100, 100}, Vec3d(0, 0, 99)), 0.0);
}

// From a camera on the axis of a spheroid (a, a, c), at the height d > c, the polar plane lies at
// z_0 = c^2 / d. The zone above it is 2 pi a times the integral of sqrt(1 - k^2 z^2), k^2 = (c^2 -
// a^2) / c^4, which is (z sqrt(1 - k^2 z^2) + asin(k z) / k) / 2.
double SpheroidZone(double a, double c, double d) {
  const double k = std::sqrt(c * c - a * a) / (c * c);
  const auto integral = [&](double z) {
    return 0.5 * (z * std::sqrt(1.0 - k * k * z * z) + std::asin(k * z) / k);
  };
  return 2.0 * kPi * a * (integral(c) - integral(c * c / d));
}

TEST(EllipsoidVisibleArea, ASpheroidFromItsAxis) {
  EXPECT_NEAR(
      EllipsoidVisibleArea({100, 100, 140}, Vec3d(0, 0, 1600)) / SpheroidZone(100, 140, 1600), 1.0,
      1e-11);
  EXPECT_NEAR(EllipsoidVisibleArea({30, 300, 30}, Vec3d(0, -400, 0)) / SpheroidZone(30, 300, 400),
              1.0, 1e-9);
  // From very far away half of it, from any side: the oval's face half is 80,133 mm^2.
  for (const Vec3d& far : {Vec3d(1e9, 0, 0), Vec3d(1e9, 2e9, -3e9), Vec3d(0, 0, 1e9)}) {
    EXPECT_NEAR(EllipsoidVisibleArea({100, 100, 140}, far), 80133.0, 1.0);
  }
}

TEST(EllipsoidVisibleArea, RandomPointsOfATriaxialOne) {
  // The mean over the unit sphere of (stretch of area) x (seen) is the area / 4 pi.
  const Vec3d semi = {90, 60, 150};
  const std::vector<Vec3d> cameras = {{600, 100, 900}, {-200, 400, 700}, {500, 500, -300}};
  KeyedRng rng(6);
  std::vector<double> p_values;
  for (size_t seen_by = 1; seen_by <= cameras.size(); ++seen_by) {
    double sum = 0.0, sum_of_squares = 0.0;
    const int trials = 100000;
    for (int i = 0; i < trials; ++i) {
      const Vec3d u = RandomDirection(rng);
      const Vec3d normal = u.cwiseQuotient(semi);
      bool seen = true;
      for (size_t c = 0; c < seen_by; ++c) {
        seen = seen && normal.dot(cameras[c] - semi.cwiseProduct(u)) > 0.0;
      }
      const double area = seen ? 4.0 * kPi * semi.prod() * normal.norm() : 0.0;
      sum += area;
      sum_of_squares += area * area;
    }
    const double mean = sum / trials;
    const double error = std::sqrt((sum_of_squares / trials - mean * mean) / trials);
    p_values.push_back(statistics::NormalPValue(
        (mean - EllipsoidVisibleArea(semi, std::span(cameras).first(seen_by))) / error));
  }
  ExpectUnsurprising(p_values);
}

TEST(DiscVisibleArea, AllOfItFromItsFrontOnly) {
  const Disc disc = {{0, 0, 10}, Vec3d::UnitZ(), 5};
  EXPECT_DOUBLE_EQ(DiscVisibleArea(disc, {3, 0, 1600}), 25.0 * kPi);
  EXPECT_DOUBLE_EQ(DiscVisibleArea(disc, {1600, 0, 10.1}), 25.0 * kPi);
  EXPECT_EQ(DiscVisibleArea(disc, {0, 0, 9}), 0.0);
}

TEST(DiscVisibleArea, PastTheEdgeOfASheet) {
  // Camera 1000 above the disc, the sheet half-way up over x >= e: its shadow begins at x = 2 e,
  // and the segment that stays seen has the area r^2 (acos(-q) + q sqrt(1 - q^2)), q = 2 e / r.
  const Disc disc = {Vec3d::Zero(), Vec3d::UnitZ(), 100};
  const Vec3d camera = {0, 0, 1000};
  const auto seen = [&](double e) {
    return DiscVisibleArea(disc, HalfPlane{{e, 77, 500}, Vec3d::UnitY(), Vec3d::UnitX()}, camera);
  };
  EXPECT_NEAR(seen(0), 0.5 * kPi * 1e4, 1e-9);
  EXPECT_NEAR(seen(25), 1e4 * (std::acos(-0.5) + 0.5 * std::sqrt(0.75)), 1e-9);
  EXPECT_NEAR(seen(25) + seen(-25), kPi * 1e4, 1e-9);  // mirror images
  EXPECT_NEAR(seen(50.001), kPi * 1e4, 1e-9);
  EXPECT_EQ(seen(-50.001), 0.0);
  EXPECT_EQ(DiscVisibleArea(disc, HalfPlane{{0, 0, 500}, Vec3d::UnitY(), Vec3d::UnitX()},
                            Vec3d(0, 0, -1000)),
            0.0);
}

TEST(DiscVisibleArea, LinesOfSightPastTheEdgeOfASheet) {
  KeyedRng rng(7);
  std::vector<double> p_values;
  const int trials = 20000;
  for (int k = 0; k < 40; ++k) {
    // The sheet stands across the line of sight, half-way; the disc is tilted at random.
    const Vec3d camera = 1600.0 * RandomDirection(rng);
    Vec3d normal = RandomDirection(rng);
    if (normal.dot(camera) < 0.0) normal = -normal;
    const Disc disc = {Vec3d::Zero(), normal, 100};
    const Vec3d across = camera.normalized().cross(RandomDirection(rng)).normalized();
    const Vec3d inward = camera.normalized().cross(across) + 0.3 * across;
    const HalfPlane sheet = {0.5 * camera + 60.0 * (rng.NextDouble() - 0.5) * inward, across,
                             inward};
    const Vec3d sheet_normal = across.cross(inward);
    const double share = DiscVisibleArea(disc, sheet, camera) / DiscVisibleArea(disc, camera);
    int hits = 0;
    const Vec3d u = normal.unitOrthogonal(), v = normal.cross(u);
    for (int i = 0; i < trials; ++i) {
      const double rho = 100.0 * std::sqrt(rng.NextDouble()), phi = 2.0 * kPi * rng.NextDouble();
      const Vec3d p = rho * (std::cos(phi) * u + std::sin(phi) * v);
      const double t = sheet_normal.dot(sheet.edge_point - camera) / sheet_normal.dot(p - camera);
      // In the sheet's plane, edge_point + s across + t inward: t by what is at right angles to
      // across.
      const Vec3d in_plane = camera + t * (p - camera) - sheet.edge_point;
      hits +=
          sheet_normal.cross(across).dot(in_plane) * sheet_normal.cross(across).dot(inward) < 0.0;
    }
    if (share * trials > 20.0 && (1.0 - share) * trials > 20.0) {
      p_values.push_back(BinomialPValue(hits, trials, share));
    } else {
      EXPECT_NEAR(hits, share * trials, 40.0);
    }
  }
  EXPECT_GT(p_values.size(), 20u);
  ExpectUnsurprising(p_values);
}

}  // namespace
}  // namespace retrolux
