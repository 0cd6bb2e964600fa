// Lobes of the back-vector model of either distribution: energy, closed forms, sampling.
#include "materials/retro_lobe.h"

#include <gtest/gtest.h>

#include "tests/bsdf_testing.h"

namespace retrolux {
namespace {

// Directional albedo of an ordinary microfacet lobe of facets that reflect all light, by quadrature
// over the hemisphere of facet normals, not of the directions that the model is sampled in:
//   E = integral of D(h) G2 / (4 cos_o cos_i) cos_i dwi,   dwi = 4 (wo.h) dh.
// Midpoint rule over u = tan^2 / (tan^2 + alpha^2), which spreads either distribution, and azimuth.
double OrdinaryAlbedo(const Facets& facets, double theta_deg) {
  const Vec3f wo = AtAngle(theta_deg);
  constexpr int kPoints = 700;
  const double alpha = static_cast<double>(facets.alpha);
  double sum = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double u = (i + 0.5) / kPoints;
    const double tan2 = alpha * alpha * u / (1.0 - u);
    const double cosine = 1.0 / std::sqrt(1.0 + tan2);
    // dh = sin dtheta dphi = cos^3 / 2 d(tan^2) dphi;  d(tan^2) = alpha^2 / (1 - u)^2 du.
    const double dh = 0.5 * std::pow(cosine, 3) * alpha * alpha / std::pow(1.0 - u, 2) / kPoints *
                      2.0 * kPi / kPoints;
    for (int j = 0; j < kPoints; ++j) {
      const Vec3f h = AtAngle(DegFromRad(std::atan(std::sqrt(tan2))), 360.0 * (j + 0.5) / kPoints);
      const float along = wo.dot(h);
      const Vec3f wi = ggx::Reflect(wo, h);
      if (along <= 0.0f || wi.z() <= 0.0f) continue;
      sum += static_cast<double>(facets.Distribution(h) * along /
                                 (wo.z() * (1.0f + facets.Lambda(wo) + facets.Lambda(wi)))) *
             dh;
    }
  }
  return sum;
}

BsdfPtr SingleLobe(const Facets& facets) {
  return FromJson(fmt::format(R"({{"type": "retroreflector", "diffuse_reflectance": 0.0, "ior": 1.0,
      "lobes": [{{"roughness": {}, "albedo": 1.0, "distribution": "{}"}}]}})",
                              facets.alpha, facets.shape == FacetShape::kGgx ? "ggx" : "beckmann"));
}

TEST(RetroLobe, ReflectsWhatTheOrdinaryLobeDoes) {
  // Mirroring the view maps the hemisphere onto itself (Portsmouth et al. 2026). 5e-4 for the
  // quadrature, four standard errors.
  for (const FacetShape shape : {FacetShape::kGgx, FacetShape::kBeckmann}) {
    for (const float alpha : {0.005f, 0.2f, 0.5f, 1.0f}) {
      for (const double theta_deg : {0.0, 30.0, 60.0, 80.0}) {
        const Facets facets = {shape, alpha};
        const Albedo albedo = DirectionalAlbedoOf(*SingleLobe(facets), theta_deg, 300, 8);
        EXPECT_NEAR(albedo.mean, OrdinaryAlbedo(facets, theta_deg),
                    5e-4 + 4.0 * albedo.standard_error)
            << (shape == FacetShape::kGgx ? "GGX " : "Beckmann ") << alpha << " at " << theta_deg;
      }
    }
  }
}

TEST(RetroLobe, OrdinaryGgxLobeReflectsWhatIsPublished) {
  // The quadrature of the test above against another: on 2000^2 points, to three digits.
  EXPECT_NEAR(OrdinaryAlbedo({FacetShape::kGgx, 0.2f}, 0.0), 0.948, 5e-4);
  EXPECT_NEAR(OrdinaryAlbedo({FacetShape::kGgx, 0.2f}, 60.0), 0.895, 5e-4);
  EXPECT_NEAR(OrdinaryAlbedo({FacetShape::kGgx, 0.5f}, 30.0), 0.683, 5e-4);
  EXPECT_NEAR(OrdinaryAlbedo({FacetShape::kGgx, 0.5f}, 60.0), 0.698, 5e-4);
}

TEST(RetroLobe, RaOfABeckmannLobe) {
  // In the plane of incidence the back vector tilts by alpha / 2 and the cosines cancel:
  //   R_A = rho / (4 pi a^2) exp(-tan^2(alpha/2) / a^2) / cos^4(alpha/2), and no masking as long as
  // a tan(beta) << 1.
  const double a = 0.0034, rho = 1.0;
  const BsdfPtr lobe = SingleLobe({FacetShape::kBeckmann, static_cast<float>(a)});
  for (const double alpha_deg : {0.0, 0.2, 0.5, 1.0}) {
    for (const double beta_deg : {0.0, 30.0, 60.0}) {
      const double half = 0.5 * RadFromDeg(alpha_deg);
      const double expected = rho / (4.0 * kPi * a * a) *
                              std::exp(-std::pow(std::tan(half) / a, 2)) /
                              std::pow(std::cos(half), 4);
      EXPECT_NEAR(
          CoefficientOfRetroReflection(*lobe, AtAngle(beta_deg + alpha_deg), AtAngle(beta_deg)),
          expected, 2e-3 * expected + 1e-6)
          << alpha_deg << " / " << beta_deg;
    }
  }
}

TEST(Beckmann, MaskingIsTheShareOfFacetsThatShow) {
  // By definition of masking the visible facets' projected area is that of the surface:
  //   G1(w) integral of D(h) (w.h)+ dh = cos(w), with G1 = 1 / (1 + Lambda).
  for (const float alpha : {0.1f, 0.5f, 1.0f}) {
    for (const double theta_deg : {0.0, 40.0, 70.0, 85.0}) {
      const Vec3f w = AtAngle(theta_deg);
      constexpr int kPoints = 800;
      double sum = 0.0;
      for (int i = 0; i < kPoints; ++i) {
        const double theta = 0.5 * kPi * (i + 0.5) / kPoints;
        for (int j = 0; j < kPoints; ++j) {
          const Vec3f h = AtAngle(DegFromRad(theta), 360.0 * (j + 0.5) / kPoints);
          sum += static_cast<double>(beckmann::Distribution(h, alpha) * std::max(0.0f, w.dot(h))) *
                 std::sin(theta) * 0.5 * kPi / kPoints * 2.0 * kPi / kPoints;
        }
      }
      const auto cosine = static_cast<double>(w.z());
      EXPECT_NEAR(sum / (1.0 + static_cast<double>(beckmann::Lambda(w, alpha))), cosine,
                  1e-3 * cosine)
          << alpha << " at " << theta_deg;
    }
  }
}

}  // namespace
}  // namespace retrolux
