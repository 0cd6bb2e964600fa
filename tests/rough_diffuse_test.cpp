// The energy-preserving Oren-Nayar model.
#include <gtest/gtest.h>

#include "tests/bsdf_testing.h"

namespace retrolux {
namespace {

BsdfPtr Rough(double reflectance, double roughness) {
  return FromJson(fmt::format(R"({{"type": "rough_diffuse", "reflectance": {}, "roughness": {}}})",
                              reflectance, roughness));
}

TEST(RoughDiffuse, WhiteGivesAllLightBack) {
  // E + (1 - E) = 1; the closed form of E against the sampled integral of f. Four standard errors.
  for (const double roughness : {0.1, 0.5, 1.0}) {
    for (const double theta_deg : {0.0, 30.0, 60.0, 80.0, 88.0}) {
      const Albedo albedo = DirectionalAlbedoOf(*Rough(1.0, roughness), theta_deg, 300, 7);
      EXPECT_NEAR(albedo.mean, 1.0, 1e-4 + 4.0 * albedo.standard_error)
          << roughness << " at " << theta_deg;
    }
  }
}

TEST(RoughDiffuse, SmoothIsLamberts) {
  for (const double theta_deg : {0.0, 40.0, 80.0}) {
    const BsdfValue value =
        Rough(0.6, 0.0)->Evaluate(AtAngle(theta_deg), AtAngle(60.0, 90.0), AnyWavelengths());
    EXPECT_NEAR(static_cast<double>(value.f_cos[0]), 0.6 / kPi * 0.5, 1e-6);
  }
}

TEST(RoughDiffuse, FirstTermByHand) {
  // Reflectance 1e-3 leaves the first term only (the second is in rho^2). r = 1:
  // A = 1 / (1.5 - 2/(3 pi)) = 0.776522. Both at 60 degrees, same azimuth: s = 0.75, t = 0.5, so
  // that f = rho / pi A (1 + 1.5); opposite azimuths: s = -0.75, t = 1, f = rho / pi A 0.25.
  const BsdfPtr rough = Rough(1e-3, 1.0);
  const auto f = [&](double phi_deg) {
    const Vec3f wi = AtAngle(60.0, phi_deg);
    return static_cast<double>(rough->Evaluate(AtAngle(60.0), wi, AnyWavelengths()).f_cos[0] /
                               wi.z()) *
           kPi / 1e-3;
  };
  EXPECT_NEAR(f(0.0), 0.776522 * 2.5, 1e-3);
  EXPECT_NEAR(f(180.0), 0.776522 * 0.25, 1e-3);
  EXPECT_NEAR(f(90.0), 0.776522, 1e-3);
}

}  // namespace
}  // namespace retrolux
