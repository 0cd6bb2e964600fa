// The goniometer's geometry and readings against closed forms; the fit of lobes.
#include "analysis/goniometer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/lobe_fit.h"
#include "core/data_path.h"
#include "core/error.h"
#include "renderer/path_tracer.h"
#include "scenes/built_in.h"
#include "tests/message_of.h"

namespace retrolux {
namespace {

TEST(Goniometer, AxesAreThoseOfCie54) {
  // cos beta = cos b1 cos b2, cos nu = cos b2 cos(b1 - alpha), and alpha between the axes.
  for (const double alpha : {0.2, 1.5, 10.0}) {
    for (const double b1 : {-30.0, 5.0, 60.0}) {
      for (const double b2 : {-20.0, 0.0, 45.0}) {
        const GoniometerAxes axes = AxesOf(alpha, b1, b2);
        const auto cosine = [](double deg) { return std::cos(RadFromDeg(deg)); };
        EXPECT_NEAR(axes.illumination.z(), cosine(b1) * cosine(b2), 1e-12);
        EXPECT_NEAR(axes.observation.z(), cosine(b2) * cosine(b1 - alpha), 1e-12);
        EXPECT_NEAR(axes.illumination.dot(axes.observation), cosine(alpha), 1e-12);
        EXPECT_NEAR(axes.observation.norm(), 1.0, 1e-12);
      }
    }
  }
}

TEST(Goniometer, MeasuresALambertianSheet) {
  // R_A = rho / pi cos(beta) cos(nu); 4 standard errors and 0.1 % for the lamp's size.
  GoniometerOptions options;
  options.observation_deg = {0.2, 15.0};
  options.entrance_deg = {-40.0, 5.0, 60.0};
  options.beta2_deg = 10.0;
  const auto readings =
      MeasureRetroReflection({{"type", "diffuse"}, {"reflectance", 0.8}}, options);
  ASSERT_EQ(readings.size(), 6u);
  for (const GoniometerReading& r : readings) {
    const double expected =
        0.8 / kPi * std::cos(RadFromDeg(r.entrance_deg)) * std::cos(RadFromDeg(r.viewing_deg));
    EXPECT_NEAR(r.ra, expected, 4.0 * r.standard_error + 1e-3 * expected)
        << r.observation_deg << " / " << r.beta1_deg;
  }
  EXPECT_EQ(readings[1].beta1_deg, 5.0);
  EXPECT_EQ(readings[3].observation_deg, 15.0);
}

TEST(Goniometer, BuiltInSceneIsOne) {
  // R_A = L cos(nu) d^2 / I of the sheet's centre in the scene's receivers is what the instrument
  // reads at these angles; 4 standard errors, and 0.1 % for the lamp's tenth of a degree, over
  // which R_A bends.
  const Scene scene = BuiltInScene("goniometer");
  GoniometerOptions options;
  options.entrance_deg = {5.0};
  const auto readings = MeasureRetroReflection(LibraryMaterial("retro_bead").spec, options);
  ASSERT_EQ(readings.size(), 4u);
  const RayScene rays(scene);
  const Lights lights(scene, rays, RingChoice::kAll, "lamp");
  const std::vector<PlacedMarker> no_markers;
  constexpr int kSamples = 4096;
  for (size_t i = 0; i < readings.size(); ++i) {
    const CameraSpec& receiver = scene.cameras[i];
    const CameraResponse response(receiver, lights.Spectra(), 1e-3);
    const PathTracer tracer(scene, rays, lights, response, no_markers, {});
    const Vec3d from = receiver.model.Centre();
    double sum = 0.0, sum2 = 0.0;
    for (uint32_t s = 0; s < kSamples; ++s) {
      PixelSampler sampler(Mix64(3), s);
      const Spectral nm = response.SampleWavelengths(sampler.Next1D(), 1.0f);
      const auto value = static_cast<double>(
          tracer.TracePath(from.cast<float>(), (-from).normalized().cast<float>(), nm, sampler)
              .radiance.sum());
      sum += value;
      sum2 += value * value;
    }
    const double mean = sum / kSamples;
    const double to_ra =
        std::cos(RadFromDeg(readings[i].viewing_deg)) * std::pow(from.norm() * 1e-3, 2) / 50.0;
    const double error = to_ra * std::sqrt(std::max(0.0, sum2 / kSamples - mean * mean) / kSamples);
    EXPECT_NEAR(mean * to_ra, readings[i].ra,
                4.0 * std::hypot(error, readings[i].standard_error) + 1e-3 * readings[i].ra)
        << readings[i].observation_deg;
  }
}

TEST(Goniometer, RefusesAnglesThatItCannotSet) {
  GoniometerOptions options;
  options.observation_deg = {0.0};
  EXPECT_EQ(MessageOf([&] { options.Check(); }),
            "observation angle 0 degrees; expected 0.01 to 20");
  options.observation_deg = {1.0};
  options.entrance_deg = {89.0};
  EXPECT_EQ(MessageOf([&] { options.Check(); }), "entrance angle 89 degrees; expected -85 to 85");
  options.entrance_deg = {-84.5};
  EXPECT_THAT(MessageOf([&] { options.Check(); }),
              testing::HasSubstr("85.50 degrees to the normal; expected at most 85"));
  options.entrance_deg = {};
  EXPECT_EQ(MessageOf([&] { options.Check(); }), "no entrance angles; expected one or more");
}

// The rows of a table at some of its entrance angles.
RaTable AtEntrance(const char* file, const std::vector<size_t>& columns) {
  const RaTable table = RaTable::FromFile(DataPath(file));
  RaTable part;
  part.observation_deg = table.observation_deg;
  for (const size_t j : columns) part.entrance_deg.push_back(table.entrance_deg[j]);
  for (const std::vector<double>& row : table.ra) {
    part.ra.emplace_back();
    for (const size_t j : columns) part.ra.back().push_back(row[j]);
  }
  return part;
}

TEST(LobeFit, FindsTheFitsMadeElsewhere) {
  // Least squares of ln R_A by another program (scipy), one lobe, to two digits; rms to 0.01.
  struct Row {
    const char* file;
    size_t column;
    FacetShape shape;
    double roughness, albedo, rms;
  };
  const char* bead = "materials/data/ra_bead_iso20471.csv";
  const Row rows[] = {{bead, 0, FacetShape::kGgx, 0.0054, 0.147, 0.13},
                      {bead, 1, FacetShape::kGgx, 0.0049, 0.108, 0.21},
                      {bead, 2, FacetShape::kGgx, 0.0050, 0.080, 0.19},
                      {bead, 3, FacetShape::kGgx, 0.0069, 0.046, 0.09},
                      {bead, 0, FacetShape::kBeckmann, 0.0069, 0.157, 0.44}};
  for (const Row& row : rows) {
    const LobeFit fit = FitLobes(AtEntrance(row.file, {row.column}), 1, row.shape);
    EXPECT_NEAR(static_cast<double>(fit.lobes[0].facets.alpha), row.roughness,
                0.01 * row.roughness + 5e-5)
        << row.column;
    EXPECT_NEAR(static_cast<double>(fit.lobes[0].albedo), row.albedo, 0.01 * row.albedo + 5e-4)
        << row.column;
    EXPECT_NEAR(fit.rms_ln_ra, row.rms, 0.006) << row.column;
  }
}

TEST(LobeFit, FindsTheLobesThatATableWasMadeOf) {
  // Two lobes and a weight, R_A by the closed form in the plane of incidence.
  const auto ra = [](double alpha_deg) {
    double sum = 0.0;
    for (const auto& [a, rho] : {std::pair{0.004, 0.12}, std::pair{0.03, 0.08}}) {
      const double half = 0.5 * RadFromDeg(alpha_deg);
      const double bracket = 1.0 + std::pow(std::tan(half) / a, 2);
      sum += rho / (4.0 * kPi * a * a) / (std::pow(std::cos(half), 4) * bracket * bracket);
    }
    return sum;
  };
  RaTable table;
  table.observation_deg = {0.1, 0.2, 0.4, 0.8, 1.5, 3.0, 6.0};
  table.entrance_deg = {5.0, 30.0};
  for (const double alpha : table.observation_deg) {
    table.ra.push_back({ra(alpha), 0.6 * ra(alpha)});
  }
  const LobeFit fit = FitLobes(table, 2, FacetShape::kGgx);
  EXPECT_LT(fit.rms_ln_ra, 2e-3);
  EXPECT_NEAR(static_cast<double>(fit.lobes[0].facets.alpha), 0.004, 4e-5);
  EXPECT_NEAR(static_cast<double>(fit.lobes[1].facets.alpha), 0.03, 3e-4);
  EXPECT_NEAR(static_cast<double>(fit.lobes[0].albedo), 0.12, 1.2e-3);
  EXPECT_NEAR(fit.entrance_weight[1], 0.6, 3e-3);
}

TEST(LobeFit, WantsAsManyPointsAsParameters) {
  const RaTable table = AtEntrance("materials/data/ra_prismatic_ldp3970.csv", {0});
  EXPECT_THAT(MessageOf([&] { FitLobes(table, 2, FacetShape::kGgx); }),
              testing::HasSubstr("have 4 parameters, the table 3 points"));
}

}  // namespace
}  // namespace retrolux
