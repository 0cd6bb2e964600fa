// The rough metal: Fresnel's equations, energy.
#include <gtest/gtest.h>

#include <complex>

#include "materials/directional_albedo.h"
#include "tests/bsdf_testing.h"
#include "tests/message_of.h"

namespace retrolux {
namespace {

// |r|^2 of Fresnel's amplitudes with a complex index, both polarisations' mean.
double FresnelReflectance(double cosine, std::complex<double> index) {
  const std::complex<double> inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
  const std::complex<double> s = (cosine - index * inside) / (cosine + index * inside);
  const std::complex<double> p = (index * cosine - inside) / (index * cosine + inside);
  return 0.5 * (std::norm(s) + std::norm(p));
}

TEST(Conductor, ASmoothOneReflectsAsFresnelSays) {
  // A width of 0.001 scatters over 0.1 degrees, over which F hardly changes; facets lose nothing
  // that counts. 2e-3 for the curvature at 85 degrees.
  for (const auto& [n, k] : {std::pair{2.8, 8.5}, {0.2, 3.0}, {3.5, 0.0}}) {
    const BsdfPtr metal = FromJson(
        fmt::format(R"({{"type": "conductor", "roughness": 0.001, "n": {}, "k": {}}})", n, k));
    for (const double theta_deg : {0.0, 30.0, 60.0, 80.0, 85.0}) {
      const double expected = FresnelReflectance(std::cos(RadFromDeg(theta_deg)), {n, k});
      EXPECT_NEAR(DirectionalAlbedoOf(*metal, theta_deg, 100, 3).mean, expected, 2e-3)
          << n << " + i " << k << " at " << theta_deg;
    }
  }
}

TEST(Conductor, WithoutLossNothingIsLost) {
  // E + (1 - E) = 1 at every angle and width: 1e-3 for the table of E, four standard errors.
  for (const double roughness : {0.01, 0.2, 0.5, 1.0}) {
    const BsdfPtr metal = FromJson(
        fmt::format(R"({{"type": "conductor", "roughness": {}, "reflectance": 1.0}})", roughness));
    for (const double theta_deg : {0.0, 30.0, 60.0, 80.0, 88.0}) {
      const Albedo albedo = DirectionalAlbedoOf(*metal, theta_deg, 400, 5);
      EXPECT_NEAR(albedo.mean, 1.0, 1e-3 + 4.0 * albedo.standard_error)
          << roughness << " at " << theta_deg;
    }
  }
}

TEST(Conductor, ManyReflectionsAsKullaAndContySay) {
  // Grey facets of reflectance F at all angles are no metal, but Schlick's F nearly is for F0 near
  // 1; there the albedo is F E + F_ms (1 - E) with F_mean = F0 + (1 - F0) / 21, and F of the facets
  // within (1 - F0) of F0. At normal incidence and alpha = 1, E is that of the mirrors' table.
  const double f0 = 0.98, mean = f0 + (1.0 - f0) / 21.0;
  const DirectionalAlbedo mirrors = DirectionalAlbedo::OfMirrors(1.0f);
  const auto e = static_cast<double>(mirrors.At(1.0f)),
             e_mean = static_cast<double>(mirrors.Mean());
  const double multiple = mean * mean * e_mean / (1.0 - mean * (1.0 - e_mean)) * (1.0 - e);
  const BsdfPtr metal = FromJson(R"({"type": "conductor", "roughness": 1.0, "reflectance": 0.98})");
  const Albedo albedo = DirectionalAlbedoOf(*metal, 0.0, 600, 6);
  EXPECT_GE(albedo.mean, f0 * e + multiple - 4.0 * albedo.standard_error);
  EXPECT_LE(albedo.mean, (f0 + 0.2 * (1.0 - f0)) * e + multiple + 4.0 * albedo.standard_error);
  EXPECT_LT(e, 0.6);  // so that the second term counts
}

TEST(Conductor, WantsEitherReflectanceOrIndex) {
  const auto error = [](const std::string& text) { return MessageOf([&] { FromJson(text); }); };
  EXPECT_EQ(error(R"({"type": "conductor"})"),
            "m.json: /: found neither reflectance nor index; expected either 'reflectance' or 'n' "
            "and 'k'");
  EXPECT_EQ(error(R"({"type": "conductor", "reflectance": 0.9, "n": 1.5})"),
            "m.json: /: found both a reflectance and an index; expected either 'reflectance' or "
            "'n' and 'k'");
  EXPECT_EQ(error(R"({"type": "conductor", "n": 1.5})"),
            "m.json: /: found no key 'k'; expected 'n' and 'k'");
}

}  // namespace
}  // namespace retrolux
