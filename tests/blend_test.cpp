// The blend of two BSDFs: a linear mix in value and density, at every share.
#include "materials/blend.h"

#include <gtest/gtest.h>

#include "tests/bsdf_testing.h"
#include "tests/message_of.h"

namespace retrolux {
namespace {

const char* kRetro = R"({"type": "retroreflector", "diffuse_reflectance": 0.0, "ior": 1.0,
                         "lobes": [{"roughness": 0.01, "albedo": 1.0}]})";
const char* kDiffuse = R"({"type": "diffuse", "reflectance": "materials/data/qe_unity.csv"})";

TEST(Blend, IsLinearInValueAndDensity) {
  // f = s / (4 pi a^2) + (1 - s) / pi with a = 0.01 at the exact retro direction of normal
  // incidence, the peak of the lobe (tests/materials_test.cpp) and Lambert's surface of reflectance
  // 1; the densities there are the same numbers, for both weights are 1. Single precision.
  const BsdfPtr retro = FromJson(kRetro), diffuse = FromJson(kDiffuse);
  const Vec3f up = Vec3f::UnitZ();
  for (const float share : {0.0f, 0.25f, 0.9f, 1.0f}) {
    const BsdfBlend blend{retro.get(), diffuse.get(), share};
    const BsdfValue value = blend.Evaluate(up, up, AnyWavelengths());
    const auto s = static_cast<double>(share);
    const double expected = s / (4.0 * kPi * 1e-4) + (1.0 - s) / kPi;
    EXPECT_NEAR(static_cast<double>(value.f_cos[2]), expected, 1e-5 * expected) << share;
    EXPECT_NEAR(static_cast<double>(value.pdf), expected, 1e-5 * expected) << share;
  }
}

TEST(Blend, AlbedoIsTheMixOfBoth) {
  // The share of light reflected is linear in f. Four standard errors of the three means.
  const BsdfPtr dark = FromJson(R"({"type": "diffuse", "reflectance": 0.1})");
  const BsdfPtr metal = FromJson(R"({"type": "conductor", "reflectance": 0.9, "roughness": 0.1})");
  const BsdfPtr blend = FromJson(R"({"type": "blend", "share": 0.3,
      "one": {"type": "conductor", "reflectance": 0.9, "roughness": 0.1},
      "zero": {"type": "diffuse", "reflectance": 0.1}})");
  for (const double theta_deg : {0.0, 60.0, 85.0}) {
    const Albedo a = DirectionalAlbedoOf(*metal, theta_deg, 300, 1);
    const Albedo b = DirectionalAlbedoOf(*dark, theta_deg, 300, 2);
    const Albedo mix = DirectionalAlbedoOf(*blend, theta_deg, 300, 3);
    const double error = mix.standard_error + 0.3 * a.standard_error + 0.7 * b.standard_error;
    EXPECT_NEAR(mix.mean, 0.3 * a.mean + 0.7 * b.mean, 4.0 * error) << theta_deg;
    EXPECT_LT(error, 0.003);
  }
}

TEST(Blend, WithoutASecondPartIsTheFirst) {
  const BsdfPtr retro = FromJson(kRetro);
  const BsdfBlend alone{retro.get(), nullptr, 0.3f};
  const Vec3f wo = AtAngle(30.0), wi = AtAngle(30.5, 1.0);
  const Spectral nm = AnyWavelengths();
  EXPECT_EQ(alone.Evaluate(wo, wi, nm).pdf, retro->Evaluate(wo, wi, nm).pdf);
  EXPECT_EQ(alone.Evaluate(wo, wi, nm).f_cos[1], retro->Evaluate(wo, wi, nm).f_cos[1]);
  EXPECT_EQ(alone.Sample(wo, 0.4f, {0.2f, 0.7f}, nm)->wi,
            retro->Sample(wo, 0.4f, {0.2f, 0.7f}, nm)->wi);
}

TEST(Blend, ErrorsNameThePart) {
  EXPECT_EQ(MessageOf([] {
              FromJson(R"({"type": "blend", "share": 0.5, "one": {"type": "diffuse"},
                           "zero": {"type": "diffuse", "reflectance": 2}})");
            }),
            "m.json: /zero/reflectance: found number 2; expected a number from 0 to 1");
  EXPECT_EQ(MessageOf([] {
              FromJson(R"({"type": "blend", "share": 1.5, "one": {"type": "diffuse"},
                           "zero": {"type": "diffuse"}})");
            }),
            "m.json: /share: found number 1.5; expected a number from 0 to 1");
  EXPECT_EQ(
      MessageOf([] { FromJson(R"({"type": "blend", "share": 0.5, "one": {"type": "diffuse"}})"); }),
      "m.json: /: found no key 'zero'; expected 'zero'");
}

}  // namespace
}  // namespace retrolux
