// The areas that cameras see, against closed forms.
#include "analysis/area_study.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/area_shapes.h"
#include "analysis/area_tests.h"
#include "analysis/cap_area.h"
#include "analysis/disc_area.h"
#include "analysis/placement_cost.h"
#include "core/rng.h"
#include "scenes/mesh_shapes.h"
#include "scenes/rig_layout.h"
#include "tests/statistics.h"

namespace retrolux {
namespace {

constexpr double kRadius = kAreaSphereRadius_mm;

// Every part of `part_mm2` that a boundary of that length crosses errs by less than itself, and by
// sqrt(1/6) of it in the root mean square where the boundary crosses it at random; they are
// independent. Five of these standard deviations, as 1 in 1.7 million is beyond them.
double FiveSigma(double boundary_mm, double part_mm2) {
  const double crossed = 2.0 * boundary_mm / std::sqrt(part_mm2);  // a triangle is wider than high
  return 5.0 * part_mm2 * std::sqrt(crossed / 6.0);
}

// What the mesh's flat triangles lack of the surface's area.
double Lacking(const Mask& mask, double area_mm2) {
  return 1.0 - mask.Samples().area_mm2 / area_mm2;
}

CameraModel InMask(CameraModel camera, const Mat3d& world_from_mask) {
  camera.camera_from_world =
      camera.camera_from_world * RigidTransform{world_from_mask, Vec3d::Zero()};
  return camera;
}

class EveryRule : public testing::TestWithParam<VisibilityRule> {};
INSTANTIATE_TEST_SUITE_P(Rules, EveryRule,
                         testing::Values(VisibilityRule::kIdBuffer, VisibilityRule::kRays,
                                         VisibilityRule::kTriangles),
                         [](const auto& rule) { return NameOf(rule.param); });

TEST_P(EveryRule, SeesTheCapOfASphere) {
  AreaStudyOptions options;
  options.rule = GetParam();
  options.levels = 5;
  options.part_area_mm2 = 0.5;
  AreaBench bench(options);
  const Mask& sphere = bench.Fine();
  const double half_angle = std::acos(kRadius / bench.Distance_mm());
  const double boundary = 2.0 * kPi * kRadius * std::sin(half_angle);
  const double part =
      sphere.Samples().area_mm2 / static_cast<double>(sphere.Samples().Size());  // the mean one
  const double whole = 4.0 * kPi * kRadius * kRadius;
  const double exact = CapArea(kRadius, half_angle) * (1.0 - Lacking(sphere, whole));
  // Whole triangles turn away together where the mesh is regular.
  const double together = GetParam() == VisibilityRule::kTriangles ? 2.0 : 1.0;
  for (uint64_t key = 0; key < 5; ++key) {
    const CameraModel camera = InMask(bench.Camera(Vec3d::UnitX()), RandomRotation(key));
    EXPECT_NEAR(sphere.AreaOf(sphere.SeenBy(camera)), exact,
                together * FiveSigma(boundary, 1.4 * part))
        << "rotation " << key;
  }
}

// A surface must not hide itself where it is seen at a grazing angle, however far the camera: here
// everything that faces it is seen.
TEST_P(EveryRule, SphereHidesNothingOfWhatFacesTheCamera) {
  AreaStudyOptions options;
  options.rule = GetParam();
  options.levels = 5;
  options.part_area_mm2 = 0.5;
  AreaBench bench(options);
  const Mask& sphere = bench.Fine();
  const CameraModel camera = InMask(bench.Camera(Vec3d::UnitX()), RandomRotation(3));
  const SurfaceSamples& samples = sphere.Samples();
  const SampleSet seen = sphere.SeenBy(camera);
  const Vec3f centre = camera.Centre().cast<float>();
  double facing = 0.0;
  for (size_t i = 0; i < samples.Size(); ++i) {
    if (samples.normals[i].dot(centre - samples.positions[i]) > 0.0f)
      facing += static_cast<double>(samples.areas_mm2[i]);
  }
  EXPECT_NEAR(sphere.AreaOf(seen) / facing, 1.0, 2e-5);
}

TEST_P(EveryRule, SeesWhatASheetLeavesOfADisc) {
  constexpr int kRings = 40;
  constexpr double kHeight = 100.0;
  TriangleMesh mesh = DiscMesh(kRadius, kRings);
  const size_t triangles = mesh.triangles.size();
  mesh.Append(RectangleMesh({0.0, -130.0, kHeight}, {130.0, 0.0, 0.0}, {0.0, 260.0, 0.0}));
  const Mask mask("disc", mesh, GetParam(), 0.5);
  AreaBench bench(AreaStudyOptions{});
  const Disc disc{Vec3d::Zero(), Vec3d::UnitZ(), kRadius};
  const HalfPlane sheet{{0.0, 0.0, kHeight}, Vec3d::UnitY(), Vec3d::UnitX()};
  const double pixel = 1.05 * bench.Distance_mm() / bench.Camera(Vec3d::UnitZ()).fx;
  const double triangle = kPi * kRadius * kRadius / static_cast<double>(triangles);
  for (const double x : {-0.1, 0.03, 0.17}) {
    const Vec3d direction = Vec3d(x, 0.05, 1.0).normalized();
    const CameraModel camera = bench.Camera(direction);
    const SampleSet seen = mask.SeenBy(camera);
    double area = 0.0;
    for (size_t i = 0; i < mask.Samples().Size(); ++i) {
      if (mask.Samples().triangles[i] < triangles && Contains(seen, i))
        area += static_cast<double>(mask.Samples().areas_mm2[i]);
    }
    // The edge of the shadow, 200 mm at most, is known to half a pixel (ids) or by samples; whole
    // triangles lie along it in rows, so they err together: by half their height.
    const double by_rule = GetParam() == VisibilityRule::kIdBuffer ? 0.5 * pixel * 200.0
                           : GetParam() == VisibilityRule::kTriangles
                               ? 0.5 * std::sqrt(triangle) * 200.0
                               : 0.0;
    EXPECT_NEAR(area, DiscVisibleArea(disc, sheet, camera.Centre()),
                by_rule + FiveSigma(200.0, 0.5))
        << "x " << x;
  }
}

TEST(Disc, HasTheAreaOfTheCircleAndFacesUp) {
  const TriangleMesh disc = DiscMesh(kRadius, 7);
  EXPECT_EQ(disc.triangles.size(), 6u * 49u);
  EXPECT_NEAR(disc.Area(), kPi * kRadius * kRadius, 0.05);
  for (const auto& [a, b, c] : disc.triangles) {
    const Vec3f across =
        (disc.positions[b] - disc.positions[a]).cross(disc.positions[c] - disc.positions[a]);
    EXPECT_GT(across.z(), 0.0f);
  }
}

// --- samples ---

TEST(SurfaceSamples, AreasSumToTheMesh) {
  const TriangleMesh oval = EllipsoidMesh({100.0, 100.0, 140.0}, 3);
  const SurfaceSamples samples = SampleSurface(oval, 2.0, 1);
  double sum = 0.0;
  for (const float area : samples.areas_mm2) {
    EXPECT_LE(area, 2.0f);
    sum += static_cast<double>(area);
  }
  EXPECT_NEAR(samples.area_mm2, oval.Area(), 1e-6 * oval.Area());
  EXPECT_NEAR(sum, oval.Area(), 1e-6 * oval.Area());
}

TEST(SurfaceSamples, PartsOfATriangleAreEqual) {
  const SurfaceSamples samples = SampleSurface(EllipsoidMesh({90.0, 100.0, 140.0}, 2), 5.0, 1);
  for (size_t i = 1; i < samples.Size(); ++i) {
    if (samples.triangles[i] == samples.triangles[i - 1]) {
      EXPECT_EQ(samples.areas_mm2[i], samples.areas_mm2[i - 1]);
    }
  }
}

TriangleMesh OneTriangle() {
  TriangleMesh mesh;
  mesh.positions = {{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

// In which of k x k congruent parts of OneTriangle a point lies, the upper ones numbered after the
// lower.
size_t PartAt(const Vec3f& p, int k) {
  const float x = static_cast<float>(k) * p.x(), y = static_cast<float>(k) * p.y();
  const int column = std::min(static_cast<int>(x), k - 1),
            row = std::min(static_cast<int>(y), k - 1);
  const bool upper = x - static_cast<float>(column) + y - static_cast<float>(row) > 1.0f;
  return static_cast<size_t>((row * k + column) * 2 + (upper ? 1 : 0));
}

TEST(SurfaceSamples, EveryPartHoldsOnePoint) {
  constexpr int kParts = 4;
  const SurfaceSamples samples = SampleSurface(OneTriangle(), 0.5 / (kParts * kParts), 1);
  ASSERT_EQ(samples.Size(), size_t{kParts * kParts});
  std::vector<int> points(2 * kParts * kParts, 0);
  for (const Vec3f& position : samples.positions) ++points[PartAt(position, kParts)];
  EXPECT_EQ(std::count(points.begin(), points.end(), 1), kParts * kParts);
}

// One point a triangle, many seeds: they are uniform over 4 x 4 parts, at a significance of 1e-4.
TEST(SurfaceSamples, PointsAreUniformOverATriangle) {
  constexpr int kParts = 4, kPoints = 16000;
  std::vector<double> points(2 * kParts * kParts, 0.0), inside;
  for (uint64_t seed = 0; seed < kPoints; ++seed)
    ++points[PartAt(SampleSurface(OneTriangle(), 1.0, seed).positions[0], kParts)];
  std::copy_if(points.begin(), points.end(), std::back_inserter(inside),
               [](double count) { return count > 0.0; });  // the others lie beside the triangle
  const size_t parts = kParts * kParts;
  ASSERT_EQ(inside.size(), parts);
  const std::vector<double> expected(parts, static_cast<double>(kPoints) / kParts / kParts);
  EXPECT_GT(statistics::ChiSquarePValue(inside, expected), 1e-4);
}

double LargestHeight(int levels) {
  double largest = 0.0;
  for (const Vec3f& position :
       SampleSurface(EllipsoidMesh(Vec3d::Constant(kRadius), levels), 1.0, 1).positions)
    largest = std::max(largest, std::abs(position.cast<double>().norm() - kRadius));
  return largest;
}

// The flat triangle lies up to h^2 / 8 R (or more exactly its circumradius^2 / 2 R) inside the
// sphere; the lifted point by the fourth power of h. Halving h twice must take it down by 256.
TEST(SurfaceSamples, LiftedPointsLieOnTheSphereToTheFourthOrder) {
  const double coarse = LargestHeight(1), fine = LargestHeight(3);
  EXPECT_LT(fine, 0.01);
  EXPECT_NEAR(std::log2(coarse / fine), 8.0, 1.0);
}

// --- areas of several cameras ---

TEST(AreasSeenByAll, AgreesWithCountingSampleBySample) {
  constexpr size_t kSamples = 1000, kCameras = 4;
  KeyedRng rng(7);
  std::vector<float> areas(kSamples);
  for (float& area : areas) area = 0.5f + rng.NextFloat();
  std::vector<SampleSet> sets(kCameras, SampleSet((kSamples + 63) / 64, 0));
  for (SampleSet& set : sets) {
    for (size_t i = 0; i < kSamples; ++i)
      set[i / 64] |= uint64_t{rng.NextDouble() < 0.4 ? 1u : 0u} << (i % 64);
  }
  std::vector<const SampleSet*> pointers;
  for (const SampleSet& set : sets) pointers.push_back(&set);
  const std::vector<double> by_set = AreasSeenByAll(pointers, areas);
  ASSERT_EQ(by_set.size(), size_t{1} << kCameras);
  for (size_t subset = 0; subset < by_set.size(); ++subset) {
    double expected = 0.0;
    for (size_t i = 0; i < kSamples; ++i) {
      bool any = false, all = true;
      for (size_t k = 0; k < kCameras; ++k) {
        any = any || Contains(sets[k], i);
        if ((subset >> k & 1u) != 0) all = all && Contains(sets[k], i);
      }
      if (any && all) expected += static_cast<double>(areas[i]);
    }
    EXPECT_NEAR(by_set[subset], expected, 1e-6) << subset;
  }
  // Inclusion and exclusion: the union from the intersections.
  double together = 0.0;
  for (size_t subset = 1; subset < by_set.size(); ++subset)
    together += (std::popcount(subset) % 2 == 1 ? 1.0 : -1.0) * by_set[subset];
  EXPECT_NEAR(together, by_set[0], 1e-6);
}

// --- the study ---

TEST(AreaStudy, LineThroughPoints) {
  const LineFit fit = FitLine({0.0, 1.0, 2.0, 3.0}, {1.0, 3.0, 5.0, 7.0});
  EXPECT_NEAR(fit.offset, 1.0, 1e-12);
  EXPECT_NEAR(fit.gradient, 2.0, 1e-12);
}

class SmallStudy : public testing::Test {
 protected:
  static AreaStudyOptions Options() {
    AreaStudyOptions options;
    options.levels = 5;
    options.part_area_mm2 = 0.1;
    options.seed = 11;
    return options;
  }
  static double LargestOf(const std::vector<AreaRow>& rows, const std::string& test) {
    std::vector<const AreaRow*> pointers;
    for (const AreaRow& row : rows) {
      if (row.test == test) pointers.push_back(&row);
    }
    EXPECT_FALSE(pointers.empty());
    return LargestError(pointers);
  }
  // The mesh lacks 0.027 % of the sphere; then the samples.
  static double Bound(double area_mm2, double boundary_mm) {
    return 3e-4 + FiveSigma(boundary_mm, 0.1) / area_mm2;
  }
  AreaBench bench_{Options()};
};

TEST_F(SmallStudy, SinglesPairsAndTriplets) {
  EXPECT_LT(LargestOf(MeasureSingles(bench_), "single"), Bound(58900.0, 630.0));
  EXPECT_LT(LargestOf(MeasurePairs(bench_, 3), "pair"), Bound(17150.0, 560.0));
  EXPECT_LT(LargestOf(MeasurePairs(bench_, 4), "pair"), Bound(3503.0, 480.0));
  const std::vector<AreaRow> triplets = MeasureRigTriplets(bench_);
  EXPECT_LT(LargestOf(triplets, "triplet"), Bound(29000.0, 630.0));
  EXPECT_LT(LargestOf(triplets, "triplet_cost"), Bound(29000.0, 630.0));
}

TEST_F(SmallStudy, FarPairsFollowTheLine) {
  std::vector<double> psi, area;
  for (const AreaRow& row : MeasureFarPairs(bench_)) {
    psi.push_back(RadFromDeg(row.x));
    area.push_back(*row.rendered_mm2 / (kRadius * kRadius));
  }
  const LineFit fit = FitLine(psi, area);
  EXPECT_NEAR(fit.offset, 2.0 * kPi, 0.01);
  EXPECT_NEAR(fit.gradient, -2.0, 0.005);
}

TEST_F(SmallStudy, NozzlesHideWithoutAddingAnything) {
  for (const AreaRow& row : MeasureBeam(bench_, false)) {
    EXPECT_LE(*row.rendered_mm2, 1.005 * *row.analytic_mm2) << row.Case();
    if (row.x > 60.0) {
      EXPECT_TRUE(row.comparable) << row.Case();
      EXPECT_NEAR(*row.RelError(), 0.0, 0.005) << row.Case();
    }
  }
}

TEST_F(SmallStudy, DiscsAndEllipsoids) {
  EXPECT_LT(LargestOf(MeasureDiscs(bench_), "disc"), 1e-5);
  // Boundaries of less than 800 mm, samples of 0.4 mm2.
  EXPECT_LT(LargestOf(MeasureEllipsoids(bench_), "ellipsoid"),
            4e-4 + FiveSigma(800.0, 0.4) / 23000.0);
}

}  // namespace
}  // namespace retrolux
