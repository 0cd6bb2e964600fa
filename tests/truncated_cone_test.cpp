#include "core/truncated_cone.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/rng.h"
#include "tests/statistics.h"

namespace retrolux {
namespace {

Vec3d RandomDirection(KeyedRng& rng) {
  const double z = 2.0 * rng.NextDouble() - 1.0;
  const double phi = 2.0 * kPi * rng.NextDouble();
  const double rho = std::sqrt(1.0 - z * z);
  return {rho * std::cos(phi), rho * std::sin(phi), z};
}

Vec3d PointInBall(KeyedRng& rng, double radius) {
  return radius * std::cbrt(rng.NextDouble()) * RandomDirection(rng);
}

Mat3d RandomRotation(KeyedRng& rng) {
  return Eigen::AngleAxisd(2.0 * kPi * rng.NextDouble(), RandomDirection(rng)).toRotationMatrix();
}

// A nozzle, a cylinder, a whole cone with its tip up and down, a blunt disc, a needle.
std::vector<TruncatedCone> Shapes() {
  KeyedRng rng(1);
  const std::vector<Vec3d> length_and_radii = {{300, 200, 75}, {400, 150, 150}, {250, 120, 0},
                                               {250, 0, 120},  {10, 300, 250},  {500, 1, 2}};
  std::vector<TruncatedCone> shapes;
  shapes.reserve(length_and_radii.size());
  for (const Vec3d& s : length_and_radii) {
    shapes.push_back({PointInBall(rng, 100.0), RandomDirection(rng), s[0], s[1], s[2]});
  }
  return shapes;
}

// Negative inside, positive outside, convex in p: each of the three terms is (the distance to the
// axis is convex, heights are linear), and so is the greatest of convex functions.
double Implicit(const TruncatedCone& cone, const Vec3d& p) {
  const Vec3d v = p - cone.base;
  const double height = v.dot(cone.axis);
  const double share = height / cone.length_mm;
  const double radius = cone.base_radius_mm * (1.0 - share) + cone.top_radius_mm * share;
  return std::max({-height, height - cone.length_mm, v.cross(cone.axis).norm() - radius});
}

// The least value of a convex function on [begin, end], by ternary search.
template <typename F>
double ArgMinConvex(const F& f, double begin, double end) {
  for (int i = 0; i < 90; ++i) {
    const double left = begin + (end - begin) / 3.0, right = end - (end - begin) / 3.0;
    (f(left) < f(right) ? end : begin) = f(left) < f(right) ? right : left;
  }
  return 0.5 * (begin + end);
}

template <typename F>
double Bisect(const F& f, double outside, double inside) {
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (outside + inside);
    (f(middle) <= 0.0 ? inside : outside) = middle;
  }
  return inside;
}

// FirstHit found without the quadratic: the least value of the convex implicit function along the
// ray says whether it enters, a bisection before (or behind) the least place where it crosses.
std::optional<double> FirstHitBySearch(const TruncatedCone& cone, const Ray& ray, double far) {
  const auto along = [&](double t) {
    return Implicit(cone, Vec3d(ray.origin + t * ray.direction));
  };
  const double deepest = ArgMinConvex(along, 0.0, far);
  if (along(deepest) > 0.0) return std::nullopt;
  if (along(0.0) > 0.0) return Bisect(along, 0.0, deepest);
  return Bisect(along, far, deepest);
}

TEST(TruncatedCone, RaysHitWhereASearchOfTheImplicitFunctionFindsTheSurface) {
  KeyedRng rng(2);
  int hits = 0, from_inside = 0, left_out = 0;
  for (const TruncatedCone& cone : Shapes()) {
    for (int i = 0; i < 1500; ++i) {
      const Vec3d from = PointInBall(rng, 600.0);
      const Vec3d aim = cone.base + cone.axis * cone.length_mm * rng.NextDouble() +
                        PointInBall(rng, 1.3 * (cone.base_radius_mm + cone.top_radius_mm));
      const Ray ray = {from, (aim - from).normalized()};
      const auto along = [&](double t) { return Implicit(cone, Vec3d(from + t * ray.direction)); };
      const auto expected = FirstHitBySearch(cone, ray, 4000.0);
      const auto found = FirstHit(cone, ray);
      // A ray that touches within rounding may be called either way.
      if (std::abs(along(ArgMinConvex(along, 0.0, 4000.0))) < 1e-9) {
        ++left_out;
        continue;
      }
      ASSERT_EQ(found.has_value(), expected.has_value()) << "ray " << i;
      if (!found) continue;
      ++hits;
      from_inside += along(0.0) < 0.0 ? 1 : 0;
      // The surface is met to rounding; the place along the ray as well as the angle allows.
      EXPECT_LT(std::abs(along(*found)), 1e-9) << "ray " << i;
      EXPECT_NEAR(*found, *expected, 1e-5) << "ray " << i;
    }
  }
  EXPECT_GT(hits, 2000);
  EXPECT_GT(from_inside, 50);
  EXPECT_LT(left_out, 10);
}

TEST(TruncatedCone, SegmentsHitIfAndOnlyIfTheImplicitFunctionTurnsNegative) {
  KeyedRng rng(3);
  int hits = 0, left_out = 0;
  const int trials = 1500;
  for (const TruncatedCone& cone : Shapes()) {
    const double size = cone.length_mm + cone.base_radius_mm + cone.top_radius_mm;
    for (int i = 0; i < trials; ++i) {
      const Vec3d a = cone.base + PointInBall(rng, size);
      const Vec3d b = cone.base + 0.5 * cone.length_mm * cone.axis + PointInBall(rng, 0.5 * size);
      const auto along = [&](double s) { return Implicit(cone, Vec3d(a + s * (b - a))); };
      const double least = along(ArgMinConvex(along, 0.0, 1.0));
      if (std::abs(least) < 1e-9) {
        ++left_out;
        continue;
      }
      hits += least < 0.0 ? 1 : 0;
      ASSERT_EQ(SegmentHits(cone, a, b), least < 0.0) << "segment " << i;
      ASSERT_EQ(SegmentHits(cone, b, a), least < 0.0) << "segment " << i;
    }
  }
  EXPECT_GT(hits, 2000);
  EXPECT_LT(hits, 7000);
  EXPECT_LT(left_out, 10);
}

// Uniform isotropic lines (Cauchy, Crofton): of those that meet a ball of radius R, the share that
// meets a convex body of surface S inside it is S / (4 pi R^2), and their mean chord is 4 V / S.
// Here V = pi L (R1^2 + R1 R2 + R2^2) / 3 and S = pi (R1^2 + R2^2 + (R1 + R2) sqrt(L^2 + (R1 -
// R2)^2)).
TEST(TruncatedCone, UniformLinesMeetItByItsSurfaceAndCrossItByItsVolume) {
  KeyedRng rng(4);
  std::vector<double> p_values;
  for (const TruncatedCone& cone : Shapes()) {
    const double l = cone.length_mm, r1 = cone.base_radius_mm, r2 = cone.top_radius_mm;
    const double volume = kPi * l * (r1 * r1 + r1 * r2 + r2 * r2) / 3.0;
    const double surface = kPi * (r1 * r1 + r2 * r2 + (r1 + r2) * std::hypot(l, r1 - r2));
    const Vec3d centre = cone.base + 0.5 * l * cone.axis;
    const double ball = std::hypot(0.5 * l, std::max(r1, r2));
    const double share = surface / (4.0 * kPi * ball * ball);

    const int lines = 50000;
    double count = 0.0, sum = 0.0, sum_of_squares = 0.0;
    for (int i = 0; i < lines; ++i) {
      const Vec3d direction = RandomDirection(rng);
      const Vec3d u = direction.unitOrthogonal(), v = direction.cross(u);
      const double rho = ball * std::sqrt(rng.NextDouble()), phi = 2.0 * kPi * rng.NextDouble();
      const Vec3d near = centre + rho * (std::cos(phi) * u + std::sin(phi) * v) - ball * direction;
      const Vec3d far = near + 2.0 * ball * direction;
      const auto enter = FirstHit(cone, {near, direction});
      ASSERT_EQ(enter.has_value(), SegmentHits(cone, near, far));
      if (!enter) continue;
      const double chord = 2.0 * ball - *enter - *FirstHit(cone, {far, -direction});
      ++count;
      sum += chord;
      sum_of_squares += chord * chord;
    }
    const double mean = sum / count;
    const double variance = sum_of_squares / count - mean * mean;
    p_values.push_back(statistics::NormalPValue((count - lines * share) /
                                                std::sqrt(lines * share * (1.0 - share))));
    p_values.push_back(
        statistics::NormalPValue((mean - 4.0 * volume / surface) / std::sqrt(variance / count)));
  }
  const double significance = statistics::Sidak(0.01, static_cast<double>(p_values.size()));
  for (const double p : p_values) EXPECT_GT(p, significance);
}

TEST(TruncatedCone, AlongTheAxis) {
  const TruncatedCone cone = {{0, 0, 10}, Vec3d::UnitZ(), 300, 200, 75};
  EXPECT_EQ(FirstHit(cone, {{0, 0, -90}, Vec3d::UnitZ()}), 100.0);   // base cap
  EXPECT_EQ(FirstHit(cone, {{0, 0, 410}, -Vec3d::UnitZ()}), 100.0);  // top cap
  EXPECT_EQ(FirstHit(cone, {{0, 0, 60}, Vec3d::UnitZ()}), 250.0);    // from inside, out of the top
  EXPECT_EQ(FirstHit(cone, {{0, 0, 410}, Vec3d::UnitZ()}), std::nullopt);  // behind the start
  // Beside the axis by x, the mantle is met at the height where its radius 200 - 125 h / 300 is x.
  EXPECT_NEAR(*FirstHit(cone, {{0, 100, 410}, -Vec3d::UnitZ()}), 400.0 - 240.0, 1e-9);
  EXPECT_EQ(FirstHit(cone, {{0, 200.001, 410}, -Vec3d::UnitZ()}), std::nullopt);
}

TEST(TruncatedCone, ChordOfACylinder) {
  // Across the axis at a distance x from it: half a chord sqrt(R^2 - x^2) before the middle.
  const TruncatedCone cylinder = {Vec3d::Zero(), Vec3d::UnitZ(), 400, 150, 150};
  for (const double x : {0.0, 1.0, 90.0, 149.0, 149.999999}) {
    const Ray ray = {{x, -1600, 50}, Vec3d::UnitY()};
    EXPECT_NEAR(*FirstHit(cylinder, ray), 1600.0 - std::sqrt(150.0 * 150.0 - x * x), 1e-8) << x;
  }
  EXPECT_EQ(FirstHit(cylinder, {{150.000001, -1600, 50}, Vec3d::UnitY()}), std::nullopt);
}

TEST(TruncatedCone, LinesAlongTheMantle) {
  // A whole cone, tip up at z = 200, half-angle 45 degrees. A line of the mantle's direction (-1,
  // 0, 1) through (200 - e, 0, 0) has x = 200 - e - z. It is inside while |x| <= 200 - z: it enters
  // through the base cap if e > 0 and leaves on the far side, -x = 200 - z, at z = 200 - e / 2.
  // Rounding turns the line by 1e-16: it moves that place by 200^2 / e times as much.
  const TruncatedCone cone = {Vec3d::Zero(), Vec3d::UnitZ(), 200, 200, 0};
  const Vec3d up = Vec3d(-1, 0, 1).normalized();
  for (const double e : {1e-6, 1.0, 50.0}) {
    const Ray ray = {Vec3d(200 - e, 0, 0) - 100.0 * up, up};
    EXPECT_NEAR(*FirstHit(cone, ray), 100.0, 1e-9) << e;
    const Ray inside = {Vec3d(200 - e, 0, 0) + 0.1 * up, up};
    EXPECT_NEAR(*FirstHit(cone, inside), (200.0 - 0.5 * e) * std::sqrt(2.0) - 0.1, 1e-9 + 1e-12 / e)
        << e;
    EXPECT_EQ(FirstHit(cone, {Vec3d(200 + e, 0, 0) - 100.0 * up, up}), std::nullopt) << e;
  }
}

TEST(TruncatedCone, TipAndRimBelongToIt) {
  const TruncatedCone cone = {Vec3d::Zero(), Vec3d::UnitZ(), 200, 100, 0};
  EXPECT_EQ(FirstHit(cone, {{-500, 0, 200}, Vec3d::UnitX()}), 500.0);
  EXPECT_EQ(FirstHit(cone, {{-500, 1e-6, 200}, Vec3d::UnitX()}), std::nullopt);
  EXPECT_TRUE(SegmentHits(cone, {-500, 0, 200}, {500, 0, 200}));
  EXPECT_TRUE(SegmentHits(cone, {0, 0, 200}, {0, 0, 900}));
  EXPECT_TRUE(SegmentHits(cone, {100, 0, 0}, {100, 0, -50}));
  EXPECT_TRUE(SegmentHits(cone, {100, -80, 0}, {100, 80, 0}));  // touches the rim
  EXPECT_FALSE(SegmentHits(cone, {100.000001, -80, 0}, {100.000001, 80, 0}));
  // The other nappe of the same double cone is not part of the solid.
  EXPECT_FALSE(SegmentHits(cone, {-50, 0, 250}, {50, 0, 250}));
  EXPECT_FALSE(SegmentHits(cone, {0, 0, 200.001}, {0, 0, 900}));
}

TEST(TruncatedCone, SegmentsThatEndInOnOrBeforeIt) {
  const TruncatedCone cylinder = {Vec3d::Zero(), Vec3d::UnitZ(), 100, 50, 50};
  EXPECT_TRUE(SegmentHits(cylinder, {10, 0, 20}, {0, 10, 60}));   // wholly inside
  EXPECT_TRUE(SegmentHits(cylinder, {10, 0, 20}, {10, 0, 20}));   // a point inside
  EXPECT_FALSE(SegmentHits(cylinder, {60, 0, 20}, {60, 0, 20}));  // a point outside
  EXPECT_TRUE(SegmentHits(cylinder, {300, 0, 20}, {50, 0, 20}));  // ends on the mantle
  EXPECT_FALSE(SegmentHits(cylinder, {300, 0, 20}, {50.001, 0, 20}));
  EXPECT_TRUE(SegmentHits(cylinder, {0, 0, 300}, {0, 0, 100}));  // ends on a cap
  EXPECT_FALSE(SegmentHits(cylinder, {0, 0, 300}, {0, 0, 100.001}));
  EXPECT_TRUE(SegmentHits(cylinder, {50, 0, -10}, {50, 0, 110}));  // along the mantle
  EXPECT_FALSE(SegmentHits(cylinder, {51, 0, -10}, {51, 0, 110}));
}

TEST(TruncatedCone, TurningEverythingTurnsNothing) {
  KeyedRng rng(5);
  for (const TruncatedCone& cone : Shapes()) {
    for (int i = 0; i < 500; ++i) {
      const Mat3d r = RandomRotation(rng);
      const Vec3d offset = PointInBall(rng, 1000.0);
      const TruncatedCone turned = {r * cone.base + offset, r * cone.axis, cone.length_mm,
                                    cone.base_radius_mm, cone.top_radius_mm};
      const Vec3d a = PointInBall(rng, 600.0), b = cone.base + PointInBall(rng, 300.0);
      const Vec3d direction = (b - a).normalized();
      const auto straight = FirstHit(cone, {a, direction});
      const auto other = FirstHit(turned, {r * a + offset, r * direction});
      ASSERT_EQ(straight.has_value(), other.has_value());
      if (straight) {
        EXPECT_NEAR(*straight, *other, 1e-7);
      }
      ASSERT_EQ(SegmentHits(cone, a, b), SegmentHits(turned, r * a + offset, r * b + offset));
    }
  }
}

}  // namespace
}  // namespace retrolux
