// Sheeting by its measured table: the table at its points, what lies between and beyond, energy,
// errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "core/atomic_file.h"
#include "core/data_path.h"
#include "materials/material_library.h"
#include "materials/ra_surface.h"
#include "tests/bsdf_testing.h"
#include "tests/message_of.h"

namespace retrolux {
namespace {

constexpr const char* kTables[][2] = {
    {"retro_bead_table", "materials/data/ra_bead_iso20471.csv"},
    {"retro_high_gain", "materials/data/ra_high_gain.csv"},
    {"retro_prismatic", "materials/data/ra_prismatic_ldp3970.csv"}};

RaTable Table(const char* file) {
  return RaTable::FromFile(DataPath(file));
}

RaSurface SurfaceOf(const RaTable& table) {
  return {table, [](const Vec3f&, const Vec3f&) { return 0.0; }};
}

double RaOf(const RaSurface& surface, double observation_deg, double entrance_deg) {
  const CoplanarDirections at = CoplanarAt(observation_deg, entrance_deg);
  const Vec3f wo = at.to_observer.cast<float>(), wi = at.to_light.cast<float>();
  const float f = surface.At(surface.T(wo, wi), RaSurface::X(wo.z(), wi.z()));
  return static_cast<double>(f * wo.z() * wi.z());
}

TEST(RaTable, GeometryIsThatOfE810) {
  // Observer and light alpha apart, the light at beta; positive beta lies beyond the observer.
  const CoplanarDirections at = CoplanarAt(1.5, 40.0);
  EXPECT_NEAR(DegFromRad(std::acos(at.to_light.z())), 40.0, 1e-4);
  EXPECT_NEAR(DegFromRad(std::acos(at.to_observer.z())), 38.5, 1e-4);
  EXPECT_NEAR(DegFromRad(std::acos(at.to_light.dot(at.to_observer))), 1.5, 1e-6);
  EXPECT_NEAR(DegFromRad(std::acos(CoplanarAt(0.5, -5.0).to_observer.z())), 5.5, 1e-3);
}

TEST(RetroTable, WholeSheetHasTheTablesValuesAtItsPoints) {
  // Lobe, cover and body together; 1e-3 for single precision at 0.2 degrees.
  for (const auto& [name, file] : kTables) {
    const RaTable table = Table(file);
    const BsdfPtr bsdf = LibraryMaterial(name).bsdf;
    for (size_t i = 0; i < table.observation_deg.size(); ++i) {
      for (size_t j = 0; j < table.entrance_deg.size(); ++j) {
        const CoplanarDirections at = CoplanarAt(table.observation_deg[i], table.entrance_deg[j]);
        EXPECT_NEAR(CoefficientOfRetroReflection(*bsdf, at.to_observer.cast<float>(),
                                                 at.to_light.cast<float>()),
                    table.ra[i][j], 1e-3 * table.ra[i][j])
            << name << " " << table.observation_deg[i] << " / " << table.entrance_deg[j];
      }
    }
  }
}

TEST(RetroTable, RoundAboutTheView) {
  // A function of the true angle between view and light: across the plane of incidence as within
  // it, where the entrance angles are nearly the same: 30.5 and 29.5 degrees in the plane, 30.00
  // both across it. 0.2 % for the difference.
  const RaSurface surface = SurfaceOf(Table(kTables[0][1]));
  const double in_plane = RaOf(surface, 1.0, 30.5);
  const Vec3f aside = AtAngle(90.0, 90.0) * static_cast<float>(std::tan(RadFromDeg(0.5)));
  const Vec3f a = (AtAngle(30.0) + aside).normalized(), b = (AtAngle(30.0) - aside).normalized();
  const float f = surface.At(surface.T(a, b), RaSurface::X(a.z(), b.z()));
  EXPECT_NEAR(static_cast<double>(f * a.z() * b.z()), in_plane, 2e-3 * in_plane);
}

TEST(RaSurface, BetweenAndBeyondThePoints) {
  // One entrance angle at normal incidence's side: f does not depend on x. Two points, 0.2 and 0.6
  // degrees, 100 and 10: with c = 0.3 degrees ln f is a line in ln(alpha^2 + c^2),
  //   slope = ln(10 / 100) / ln((0.36 + 0.09) / (0.04 + 0.09)) = -1.85447.
  RaTable table;
  table.observation_deg = {0.2, 0.6};
  table.entrance_deg = {0.0};
  table.ra = {{100.0}, {10.0}};
  const RaSurface surface = SurfaceOf(table);
  const double slope = std::log(0.1) / std::log(0.45 / 0.13);
  const auto expected = [&](double alpha) {
    return 100.0 * std::pow((alpha * alpha + 0.09) / 0.13, slope);
  };
  for (const double alpha : {0.0, 0.1, 0.2, 0.4, 0.6, 2.0, 5.0}) {
    // 0.2 %: chords for angles, cosines of up to 5 degrees.
    EXPECT_NEAR(RaOf(surface, alpha, 0.0), expected(alpha),
                (2e-3 + 1.0 - std::cos(RadFromDeg(alpha))) * expected(alpha))
        << alpha;
  }
  // Far out a power law of twice the slope.
  EXPECT_NEAR(std::log(RaOf(surface, 10.0, 0.0) / RaOf(surface, 5.0, 0.0)) / std::log(2.0),
              2.0 * slope, 0.03);
}

TEST(RaSurface, FallsOffBeyondTheLargestEntranceAngle) {
  for (const auto& [name, file] : kTables) {
    const RaTable table = Table(file);
    const RaSurface surface = SurfaceOf(table);
    for (const double alpha : {0.1, 0.2, 0.5, 1.5, 5.0}) {
      // From where the mean of both angles is the largest of the table.
      const double last = table.entrance_deg.back() + alpha;
      double before = RaOf(surface, alpha, last);
      for (double beta = last + 5.0; beta < 90.0; beta += 5.0) {
        const double here = RaOf(surface, alpha, beta);
        EXPECT_LT(here, before) << name << " " << alpha << " / " << beta;
        before = here;
      }
      EXPECT_LT(RaOf(surface, alpha, 89.9), 1e-3 * RaOf(surface, alpha, 0.0)) << name;
    }
  }
}

TEST(RetroTable, SampledAlbedoIsThatOfAQuadratureOverDirections) {
  // The integral of f cos by the midpoint rule in rings about the view, whose widths grow with the
  // angle, against the mean weight of samples. 0.3 % for the quadrature.
  for (const auto& [name, file] : kTables) {
    const BsdfPtr bsdf = LibraryMaterial(name).bsdf;
    for (const double theta_deg : {0.0, 30.0, 60.0, 80.0}) {
      const Vec3f wo = AtAngle(theta_deg, 35.0);
      const Frame frame(wo);
      constexpr int kRings = 600, kAzimuths = 200;
      double sum = 0.0;
      double inner = 0.0;
      for (int i = 0; i < kRings; ++i) {
        const double outer = RadFromDeg(0.01) * (std::pow(18000.0, (i + 1.0) / kRings) - 0.0);
        const double angle = 0.5 * (inner + outer);
        for (int j = 0; j < kAzimuths; ++j) {
          const double azimuth = 2.0 * kPi * (j + 0.5) / kAzimuths;
          const Vec3f wi =
              frame.WorldFromLocal(Vec3d(std::sin(angle) * std::cos(azimuth),
                                         std::sin(angle) * std::sin(azimuth), std::cos(angle))
                                       .cast<float>());
          sum += static_cast<double>(bsdf->Evaluate(wo, wi, AnyWavelengths()).f_cos[2]) *
                 (std::cos(inner) - std::cos(outer)) * 2.0 * kPi / kAzimuths;
        }
        inner = outer;
      }
      const Albedo albedo = DirectionalAlbedoOf(*bsdf, theta_deg, 500, 9);
      EXPECT_NEAR(albedo.mean, sum, 3e-3 * sum + 4.0 * albedo.standard_error)
          << name << " at " << theta_deg;
      EXPECT_LT(sum, 1.0) << name << " at " << theta_deg;
    }
  }
}

TEST(RaSurface, LeaveOneOutIsBetterThanKnowingTheNeighboursOnly) {
  for (const auto& [name, file] : kTables) {
    const RaTable table = Table(file);
    for (const LeaveOneOut& left_out :
         {LeaveOneOutObservation(table), LeaveOneOutEntrance(table)}) {
      EXPECT_GT(left_out.rms, 0.0) << name;
      EXPECT_GE(left_out.largest, left_out.rms) << name;
      EXPECT_LT(left_out.rms, left_out.rms_range) << name;
    }
  }
  // A table made of the interpolation's own law is found again: ln f linear in t.
  RaTable law;
  law.observation_deg = {0.2, 0.4, 1.0};
  law.entrance_deg = {0.0};
  for (const double alpha : law.observation_deg) {
    law.ra.push_back({std::cos(RadFromDeg(alpha)) / (alpha * alpha + 0.09)});
  }
  EXPECT_LT(LeaveOneOutObservation(law).largest, 1e-3);
  EXPECT_EQ(LeaveOneOutEntrance(law).rms, 0.0);
}

// --- errors ---

class TablesOfOurOwn : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::path(testing::TempDir()) /
        (std::string("retrolux_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
    ASSERT_EQ(setenv("RETROLUX_DATA", folder_.c_str(), 1), 0);
  }
  void TearDown() override {
    unsetenv("RETROLUX_DATA");
    std::filesystem::remove_all(folder_);
  }
  std::string ErrorOf(const std::string& rows, const std::string& rest = "") const {
    WriteTextFile(folder_ / "t.csv", "observation_deg,entrance_deg,ra_cd_lx_m2\n" + rows);
    return MessageOf([&] { FromJson(R"({"type": "retro_table", "table": "t.csv")" + rest + "}"); });
  }
  std::filesystem::path folder_;
};

TEST_F(TablesOfOurOwn, ErrorsNamePlaceFoundAndExpected) {
  using testing::HasSubstr;
  EXPECT_EQ(ErrorOf("0.2,5,100\n0.2,30,50\n1,5,10\n1,30,5\n"), "no error");
  EXPECT_THAT(ErrorOf("0.2,5,100\n0.2,30,50\n1,5,10\n"),
              HasSubstr("t.csv: no value at 1 / 30 degrees; expected one for every"));
  EXPECT_THAT(ErrorOf("0.2,5,100\n0.2,5,90\n1,5,10\n"), HasSubstr("row 2: 0.2 / 5 degrees"));
  EXPECT_THAT(ErrorOf("0.2,5,100\n"), HasSubstr("one observation angle; expected two or more"));
  EXPECT_THAT(ErrorOf("0.2,5,0\n1,5,10\n"),
              HasSubstr("row 1: ra_cd_lx_m2 0; expected a coefficient above 0"));
  EXPECT_THAT(ErrorOf("0,5,100\n1,5,10\n"), HasSubstr("row 1: observation_deg 0; expected"));
  EXPECT_THAT(ErrorOf("0.2,95,100\n1,95,10\n"), HasSubstr("row 1: entrance_deg 95; expected"));
  // The body alone has 0.27 / pi = 0.086 there.
  EXPECT_THAT(ErrorOf("0.2,5,100\n1,5,0.05\n", R"(, "ior": 1)"),
              HasSubstr("R_A 0.05 cd/(lx m2) at 1 / 5 degrees; expected more than the 0.085"));
}

TEST_F(TablesOfOurOwn, MoreLightThanArrivesIsRefused) {
  // 1000 over a cone of 3 degrees is already 1000 pi 0.0524^2 = 8.6 times the light.
  EXPECT_THAT(
      ErrorOf("0.2,5,1000\n3,5,999\n"),
      testing::AllOf(testing::HasSubstr("m.json: /table: found a lobe, cover and body that"),
                     testing::HasSubstr("expected at most 1 at every angle")));
}

}  // namespace
}  // namespace retrolux
