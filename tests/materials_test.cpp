// Every material of the library, and some that it does not hold: sampling against density,
// reciprocity, energy, closed forms; spectra and filters.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numeric>

#include "core/atomic_file.h"
#include "core/data_path.h"
#include "core/hash.h"
#include "materials/directional_albedo.h"
#include "materials/entrance_weight.h"
#include "materials/filter.h"
#include "materials/material_library.h"
#include "tests/bsdf_testing.h"
#include "tests/message_of.h"
#include "tests/statistics.h"

namespace retrolux {
namespace {

struct NamedBsdf {
  std::string name;
  BsdfPtr bsdf;
};

// The library, and parameters far from the library's.
std::vector<NamedBsdf> AllMaterials() {
  std::vector<NamedBsdf> all;
  for (const std::string& name : LibraryMaterialNames()) {
    all.push_back({name, LibraryMaterial(name).bsdf});
  }
  const char* variations[] = {
      R"({"type": "diffuse", "reflectance": "materials/data/qe_interline_ccd.csv"})",
      R"({"type": "coated_diffuse", "reflectance": 0.0, "ior": 2.5, "roughness": 0.02})",
      R"({"type": "coated_diffuse", "reflectance": 1.0, "ior": 1.3, "roughness": 0.7})",
      R"({"type": "retroreflector", "diffuse_reflectance": 0.0, "ior": 1.0,
          "lobes": [{"roughness": 0.001, "albedo": 1.0}]})",
      R"({"type": "retroreflector", "diffuse_reflectance": 0.0, "ior": 1.0,
          "lobes": [{"roughness": 0.5, "albedo": 1.0}]})",
      R"({"type": "retroreflector", "diffuse_reflectance": 0.2, "ior": 1.6, "cover_roughness": 0.4,
          "entrance_weight": "materials/data/entrance_weight_iso20471.csv",
          "lobes": [{"roughness": 0.02, "albedo": 0.3}, {"roughness": 0.2, "albedo": 0.2}]})",
      R"({"type": "retroreflector", "diffuse_reflectance": 0.0, "ior": 1.0,
          "lobes": [{"roughness": 0.003, "albedo": 0.6, "distribution": "beckmann"},
                    {"roughness": 0.4, "albedo": 0.4, "distribution": "beckmann"}]})",
      R"({"type": "retro_table", "diffuse_reflectance": 0.05, "ior": 1.0,
          "table": "materials/data/ra_prismatic_ldp3970.csv"})",
      R"({"type": "blend", "share": 0.3,
          "one": {"type": "retroreflector", "diffuse_reflectance": 0.0, "ior": 1.0,
                  "lobes": [{"roughness": 0.004, "albedo": 1.0}]},
          "zero": {"type": "blend", "share": 0.6,
                   "one": {"type": "conductor", "reflectance": 0.9, "roughness": 0.02},
                   "zero": {"type": "diffuse",
                            "reflectance": "materials/data/qe_interline_ccd.csv"}}})",
      R"({"type": "back_vector", "of": {"type": "conductor", "reflectance": 0.6,
          "roughness": 0.01}})",
      R"({"type": "back_vector", "of": {"type": "coated_diffuse", "reflectance": 1.0, "ior": 2.0,
          "roughness": 0.4}})",
      R"({"type": "conductor", "reflectance": 1.0, "roughness": 1.0})",
      R"({"type": "conductor", "n": 2.8, "k": 8.5, "roughness": 0.02})",
      R"({"type": "conductor", "n": 0.2, "k": 3.0, "roughness": 0.5})",
      R"({"type": "rough_diffuse", "reflectance": 1.0, "roughness": 1.0})",
      R"({"type": "rough_diffuse", "reflectance": 0.3, "roughness": 0.0})"};
  for (const char* text : variations) all.push_back({text, FromJson(text)});
  return all;
}

Vec3f MirroredAboutNormal(const Vec3f& w) {
  return {-w.x(), -w.y(), w.z()};
}

// --- sampling against density ---

// The sphere of directions in cells: fine polar grids about the retro direction and the mirror
// direction, with rings that grow by 1.47 from 0.02 to 20 degrees, so that lobes of a fraction of a
// degree are resolved; all other directions above the surface in a grid over angle and azimuth; and
// one cell for samples that found no direction. Cells of the coarse grid that a polar grid cuts,
// whose quadrature is poor, are taken together.
class DirectionCells {
 public:
  explicit DirectionCells(const Vec3f& wo) {
    caps_.emplace_back(wo);
    const Vec3f mirrored = MirroredAboutNormal(wo);
    // Otherwise the mirror direction is the retro direction.
    if (wo.dot(mirrored) < 0.9f) caps_.emplace_back(mirrored);
  }

  size_t Count() const { return 1 + caps_.size() * kCapCells + kThetas * kPhis; }
  static size_t Nothing() { return 0; }

  // The probability of counts that lie at least this far from those that the density makes
  // expected.
  double PValue(const std::vector<double>& counts,
                const std::function<double(const Vec3f& wi)>& pdf) const {
    const double samples = std::accumulate(counts.begin(), counts.end(), 0.0);
    const Quadrature quadrature = Integrate(pdf);
    // Never more than 1; 0.1 % for the quadrature.
    EXPECT_GT(quadrature.probabilities[Nothing()], -1e-3);
    std::vector<double> observed, expected;
    // The last cell expects most: what ChiSquarePValue cannot pool at the end it leaves out. No
    // direction belongs to it where that is rare, so that the error of the quadrature does not
    // weigh on a small number.
    double rest_observed = 0.0, rest_expected = 0.0;
    for (size_t i = 0; i < counts.size(); ++i) {
      const double e = quadrature.probabilities[i] * samples;
      if (quadrature.cut[i] || (i == Nothing() && quadrature.probabilities[i] < 0.01)) {
        rest_observed += counts[i];
        rest_expected += e;
      } else {
        observed.push_back(counts[i]);
        expected.push_back(e);
      }
    }
    observed.push_back(rest_observed);
    expected.push_back(rest_expected);
    const auto largest = std::max_element(expected.begin(), expected.end()) - expected.begin();
    std::swap(expected[static_cast<size_t>(largest)], expected.back());
    std::swap(observed[static_cast<size_t>(largest)], observed.back());
    return statistics::ChiSquarePValue(observed, expected);
  }

  size_t CellOf(const Vec3f& wi) const {
    for (size_t i = 0; i < caps_.size(); ++i) {
      const Polar p = InCap(caps_[i], wi);
      if (p.radius >= RingEdge(kRings)) continue;
      size_t ring = 0;
      while (p.radius >= RingEdge(ring + 1)) ++ring;
      return 1 + i * kCapCells + ring * kAzimuths + Slice(p.azimuth, kAzimuths);
    }
    const double theta = std::acos(static_cast<double>(wi.z()));
    const auto row = std::min(kThetas - 1, static_cast<size_t>(theta / (0.5 * kPi) * kThetas));
    const double phi = std::atan2(static_cast<double>(wi.y()), static_cast<double>(wi.x()));
    return 1 + caps_.size() * kCapCells + row * kPhis + Slice(phi, kPhis);
  }

  // Integral of the density over every cell by the midpoint rule; the first cell holds what is left
  // of 1.
  struct Quadrature {
    std::vector<double> probabilities;
    std::vector<bool> cut;
  };
  Quadrature Integrate(const std::function<double(const Vec3f& wi)>& pdf) const {
    constexpr int kPoints = 28;
    std::vector<double> cells(Count(), 0.0);
    std::vector<bool> cut(Count(), false);
    for (size_t i = 0; i < caps_.size(); ++i) {
      for (size_t ring = 0; ring < kRings; ++ring) {
        const double r0 = RingEdge(ring), dr = (RingEdge(ring + 1) - r0) / kPoints;
        const double dphi = 2.0 * kPi / (kAzimuths * kPoints);
        for (int a = 0; a < kPoints; ++a) {
          const double r = r0 + (a + 0.5) * dr;
          for (size_t b = 0; b < kAzimuths * kPoints; ++b) {
            const double phi = (static_cast<double>(b) + 0.5) * dphi;
            const Vec3f local =
                Vec3d(std::sin(r) * std::cos(phi), std::sin(r) * std::sin(phi), std::cos(r))
                    .cast<float>();
            cells[1 + i * kCapCells + ring * kAzimuths + b / kPoints] +=
                pdf(caps_[i].WorldFromLocal(local)) * std::sin(r) * dr * dphi;
          }
        }
      }
    }
    const double dt = 0.5 * kPi / (kThetas * kPoints), dp = 2.0 * kPi / (kPhis * kPoints);
    const size_t first = 1 + caps_.size() * kCapCells;
    for (size_t a = 0; a < kThetas * kPoints; ++a) {
      const double theta = (static_cast<double>(a) + 0.5) * dt;
      for (size_t b = 0; b < kPhis * kPoints; ++b) {
        const Vec3f wi =
            AtAngle(DegFromRad(theta), DegFromRad((static_cast<double>(b) + 0.5) * dp));
        const size_t cell = first + a / kPoints * kPhis + b / kPoints;
        if (CellOf(wi) < first) {
          cut[cell] = true;
        } else {
          cells[cell] += pdf(wi) * std::sin(theta) * dt * dp;
        }
      }
    }
    double sum = 0.0;
    for (const double cell : cells) sum += cell;
    cells[Nothing()] = 1.0 - sum;
    return {cells, cut};
  }

 private:
  static constexpr size_t kRings = 19, kAzimuths = 8, kCapCells = kRings * kAzimuths;
  static constexpr size_t kThetas = 9, kPhis = 12;
  struct Polar {
    double radius, azimuth;
  };

  static double RingEdge(size_t i) {
    static const std::vector<double> edges = [] {
      std::vector<double> radians = {0.0};
      for (size_t k = 0; k < kRings; ++k) {
        radians.push_back(
            RadFromDeg(0.02 * std::pow(1000.0, static_cast<double>(k) / (kRings - 1))));
      }
      return radians;
    }();
    return edges[i];
  }
  static size_t Slice(double azimuth, size_t count) {
    const double turns = azimuth / (2.0 * kPi);
    return std::min(count - 1,
                    static_cast<size_t>((turns - std::floor(turns)) * static_cast<double>(count)));
  }
  static Polar InCap(const Frame& cap, const Vec3f& wi) {
    const auto x = static_cast<double>(wi.dot(cap.tangent));
    const auto y = static_cast<double>(wi.dot(cap.bitangent));
    return {std::atan2(std::hypot(x, y), static_cast<double>(wi.dot(cap.normal))),
            std::atan2(y, x)};
  }

  std::vector<Frame> caps_;
};

constexpr double kViewAngles_deg[] = {0.0, 30.0, 60.0, 80.0};

TEST(Bsdf, SamplesFollowTheirDensity) {
  // Counts in the cells of DirectionCells against N times the integral of Evaluate's pdf over each
  // cell. Directions under the surface, for which Sample returns nothing, are 1 minus the integral
  // over the hemisphere. Significance 1 % for all materials and angles together.
  constexpr int kSamples = 1 << 17;
  const std::vector<NamedBsdf> materials = AllMaterials();
  const double significance =
      statistics::Sidak(0.01, static_cast<double>(materials.size() * std::size(kViewAngles_deg)));
  const Spectral nm = AnyWavelengths();
  for (const NamedBsdf& material : materials) {
    for (const double theta_deg : kViewAngles_deg) {
      SCOPED_TRACE(fmt::format("{} at {} degrees", material.name, theta_deg));
      const Vec3f wo = AtAngle(theta_deg, 35.0);
      const DirectionCells cells(wo);
      std::vector<double> observed(cells.Count(), 0.0);
      KeyedRng rng(CombineKeys(HashBytes(material.name), static_cast<uint64_t>(theta_deg)));
      for (int i = 0; i < kSamples; ++i) {
        const float lobe = rng.NextFloat();
        const Vec2f u(rng.NextFloat(), rng.NextFloat());
        const auto sample = material.bsdf->Sample(wo, lobe, u, nm);
        observed[sample ? cells.CellOf(sample->wi) : DirectionCells::Nothing()] += 1.0;
      }
      const auto pdf = [&](const Vec3f& wi) {
        return static_cast<double>(material.bsdf->Evaluate(wo, wi, nm).pdf);
      };
      EXPECT_GT(cells.PValue(observed, pdf), significance);
    }
  }
}

TEST(Bsdf, WeightIsValueOverDensity) {
  // The definitions of BsdfSample: weight = f |cos| / pdf with the pdf of Evaluate. 1e-5 for single
  // precision.
  const Spectral nm = AnyWavelengths();
  for (const NamedBsdf& material : AllMaterials()) {
    SCOPED_TRACE(material.name);
    KeyedRng rng(2);
    for (int i = 0; i < 4000; ++i) {
      const Vec3f wo = SampleCosineHemisphere({rng.NextFloat(), rng.NextFloat()});
      const float lobe = rng.NextFloat();
      const Vec2f u(rng.NextFloat(), rng.NextFloat());
      const auto sample = material.bsdf->Sample(wo, lobe, u, nm);
      if (!sample) continue;
      ASSERT_GT(sample->wi.z(), 0.0f);
      ASSERT_NEAR(static_cast<double>(sample->wi.norm()), 1.0, 1e-5);
      const BsdfValue value = material.bsdf->Evaluate(wo, sample->wi, nm);
      ASSERT_NEAR(static_cast<double>(sample->pdf), static_cast<double>(value.pdf),
                  1e-5 * static_cast<double>(value.pdf));
      for (int k = 0; k < kMaxSpectra; ++k) {
        const auto weight = static_cast<double>(value.f_cos[k] / value.pdf);
        ASSERT_NEAR(static_cast<double>(sample->weight[k]), weight, 1e-5 * weight + 1e-12);
      }
    }
  }
}

TEST(Bsdf, NothingBelowTheSurface) {
  const Spectral nm = AnyWavelengths();
  const Vec3f up = AtAngle(30.0), down = -up;
  for (const NamedBsdf& material : AllMaterials()) {
    SCOPED_TRACE(material.name);
    EXPECT_FALSE(material.bsdf->Sample(down, 0.5f, {0.5f, 0.5f}, nm).has_value());
    for (const auto& [wo, wi] : {std::pair(up, down), std::pair(down, up), std::pair(down, down)}) {
      const BsdfValue value = material.bsdf->Evaluate(wo, wi, nm);
      EXPECT_EQ(value.pdf, 0.0f);
      EXPECT_TRUE((value.f_cos == 0.0f).all());
    }
  }
}

TEST(Bsdf, FiniteAtGrazingDirections) {
  // Far below what a dot product of unit vectors in single precision can be.
  const Spectral nm = AnyWavelengths();
  for (const NamedBsdf& material : AllMaterials()) {
    SCOPED_TRACE(material.name);
    KeyedRng rng(9);
    for (const float z : {1e-2f, 1e-4f, 1e-6f, 1e-8f, 1e-10f}) {
      const Vec3f wo(std::sqrt(1.0f - z * z), 0.0f, z);
      for (int i = 0; i < 200; ++i) {
        const float lobe = rng.NextFloat();
        const Vec2f u(rng.NextFloat(), rng.NextFloat());
        for (const Vec3f& wi : {SampleCosineHemisphere(u), wo, MirroredAboutNormal(wo)}) {
          const BsdfValue value = material.bsdf->Evaluate(wo, wi, nm);
          ASSERT_TRUE(std::isfinite(value.pdf) && value.pdf >= 0.0f) << z;
          ASSERT_TRUE(value.f_cos.isFinite().all() && (value.f_cos >= 0.0f).all()) << z;
        }
        if (const auto sample = material.bsdf->Sample(wo, lobe, u, nm)) {
          ASSERT_TRUE(sample->weight.isFinite().all() && (sample->weight >= 0.0f).all()) << z;
        }
      }
    }
  }
}

// --- reciprocity and energy ---

TEST(Bsdf, Reciprocal) {
  // Helmholtz: f(wo, wi) = f(wi, wo), with f = f_cos / cos(wi). Half of the pairs anywhere, half
  // within the retro-reflective lobe, 0.01 to 10 degrees apart.
  const Spectral nm = AnyWavelengths();
  for (const NamedBsdf& material : AllMaterials()) {
    SCOPED_TRACE(material.name);
    KeyedRng rng(3);
    for (int i = 0; i < 20000; ++i) {
      const Vec3f wo = SampleCosineHemisphere({rng.NextFloat(), rng.NextFloat()});
      Vec3f wi = SampleCosineHemisphere({rng.NextFloat(), rng.NextFloat()});
      const float apart = static_cast<float>(RadFromDeg(0.01)) * std::pow(1000.0f, rng.NextFloat());
      const float azimuth = 2.0f * kPiF * rng.NextFloat();
      if (i % 2 == 0) {
        const Vec3f local(std::sin(apart) * std::cos(azimuth), std::sin(apart) * std::sin(azimuth),
                          std::cos(apart));
        wi = Frame(wo).WorldFromLocal(local);
      }
      if (wo.z() < 0.01f || wi.z() < 0.01f) continue;
      const Spectral there = material.bsdf->Evaluate(wo, wi, nm).f_cos / wi.z();
      const Spectral back = material.bsdf->Evaluate(wi, wo, nm).f_cos / wo.z();
      for (int k = 0; k < kMaxSpectra; ++k) {
        const auto f = static_cast<double>(there[k]);
        ASSERT_NEAR(static_cast<double>(back[k]), f, 1e-4 * f + 1e-12)
            << wo.transpose() << " / " << wi.transpose();
      }
    }
  }
}

TEST(Bsdf, NeverMoreLightThanArrives) {
  // Directional albedo <= 1, within four standard errors and 1e-3 for the tables of the coat's
  // albedo.
  for (const NamedBsdf& material : AllMaterials()) {
    for (const double theta_deg : {0.0, 30.0, 60.0, 80.0, 88.0}) {
      SCOPED_TRACE(fmt::format("{} at {} degrees", material.name, theta_deg));
      const Albedo albedo = DirectionalAlbedoOf(*material.bsdf, theta_deg, 200, 4);
      EXPECT_LE(albedo.mean, 1.0 + 4.0 * albedo.standard_error + 1e-3);
      EXPECT_EQ(albedo.least_weight, 0.0);  // no weight is negative
    }
  }
}

TEST(Retroreflector, WhateverIsAcceptedConservesEnergy) {
  // Lobes, body and cover together must not reflect more than arrives at any angle, or the factory
  // must refuse them.
  int accepted = 0;
  for (const double lobe : {0.1, 0.7, 0.95, 1.0}) {
    for (const double body : {0.0, 0.05, 0.3}) {
      for (const double ior : {1.0, 1.5, 2.5}) {
        const std::string text = fmt::format(
            R"({{"type": "retroreflector", "diffuse_reflectance": {}, "ior": {}, "cover_roughness": 0.1,
                "lobes": [{{"roughness": 0.005, "albedo": {}}}]}})",
            body, ior, lobe);
        BsdfPtr bsdf;
        try {
          bsdf = FromJson(text);
        } catch (const InputError&) {
          continue;
        }
        ++accepted;
        for (const double theta_deg : {0.0, 60.0, 80.0, 88.0}) {
          const Albedo albedo = DirectionalAlbedoOf(*bsdf, theta_deg, 100, 5);
          ASSERT_LE(albedo.mean, 1.0 + 4.0 * albedo.standard_error + 1e-3)
              << text << " at " << theta_deg << " degrees";
        }
      }
    }
  }
  EXPECT_GE(accepted, 8);
}

TEST(Diffuse, ReflectsItsReflectance) {
  // f = rho / pi, so that the albedo is rho at any angle, and each cosine-weighted sample carries
  // exactly rho.
  for (const double theta_deg : kViewAngles_deg) {
    const Albedo albedo =
        DirectionalAlbedoOf(*LibraryMaterial("white_paint").bsdf, theta_deg, 32, 6);
    EXPECT_NEAR(albedo.mean, 0.7, 1e-6);
    const BsdfValue value =
        LibraryMaterial("white_paint")
            .bsdf->Evaluate(AtAngle(theta_deg), AtAngle(60.0, 90.0), AnyWavelengths());
    EXPECT_NEAR(static_cast<double>(value.f_cos[0]), 0.7 / kPi * 0.5, 1e-6);
  }
  // A reflectance from a table: each wavelength has its own.
  const char* table = "materials/data/qe_interline_ccd.csv";
  const Spectrum spectrum = Spectrum::FromTable(DataPath(table));
  const Spectral nm = AnyWavelengths();
  const auto sample = FromJson(fmt::format(R"({{"type": "diffuse", "reflectance": "{}"}})", table))
                          ->Sample(AtAngle(30.0), 0.5f, {0.3f, 0.6f}, nm);
  for (int k = 0; k < kMaxSpectra; ++k) EXPECT_FLOAT_EQ(sample->weight[k], spectrum.At(nm[k]));
}

TEST(Absorber, ReflectsNothing) {
  EXPECT_EQ(DirectionalAlbedoOf(*LibraryMaterial("black").bsdf, 30.0, 8, 7).mean, 0.0);
}

TEST(Coat, SmoothLimitIsFresnels) {
  // Reflectance of a smooth dielectric of index 1.5: ((n - 1) / (n + 1))^2 = 0.04 at normal
  // incidence, 0.0892 at 60 degrees, and under diffuse light (Walsh 1926)
  //   1/2 + (n-1)(3n+1) / (6 (n+1)^2) + n^2 (n^2-1)^2 / (n^2+1)^3 ln((n-1)/(n+1))
  //   - 2 n^3 (n^2+2n-1) / ((n^2+1)(n^4-1)) + 8 n^4 (n^4+1) / ((n^2+1)(n^4-1)^2) ln n = 0.0918.
  const DirectionalAlbedo albedo(1.5f, 0.001f);
  const double n = 1.5, n2 = n * n, n4 = n2 * n2;
  const double walsh =
      0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
      n2 * (n2 - 1) * (n2 - 1) / std::pow(n2 + 1, 3) * std::log((n - 1) / (n + 1)) -
      2 * n2 * n * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
      8 * n4 * (n4 + 1) / ((n2 + 1) * (n4 - 1) * (n4 - 1)) * std::log(n);
  EXPECT_NEAR(walsh, 0.0918, 5e-5);
  EXPECT_NEAR(static_cast<double>(albedo.At(1.0f)), 0.04, 1e-4);
  EXPECT_NEAR(static_cast<double>(albedo.At(0.5f)), 0.0892, 2e-4);
  EXPECT_NEAR(static_cast<double>(albedo.Mean()), walsh, 5e-4);  // of the table's 129 angles
}

// --- the retroreflector's closed forms ---

BsdfPtr SingleLobe(double roughness) {
  return FromJson(fmt::format(R"({{"type": "retroreflector", "diffuse_reflectance": 0.0, "ior": 1.0,
                                  "lobes": [{{"roughness": {}, "albedo": 1.0}}]}})",
                              roughness));
}

TEST(Retroreflector, LobeReflectsWhatTheMicrofacetsDo) {
  // Mirroring the view about the normal maps the hemisphere onto itself, so that the back-vector
  // lobe reflects as much as the ordinary GGX lobe of that width (Portsmouth et al. 2026;
  // quadrature on 2000^2 points). Half a unit of the last digit, and four standard errors.
  struct Row {
    double roughness, theta_deg, albedo;
  };
  const Row rows[] = {{0.2, 0, 0.948}, {0.2, 30, 0.939}, {0.2, 60, 0.895},
                      {0.5, 0, 0.688}, {0.5, 30, 0.683}, {0.5, 60, 0.698}};
  for (const Row& row : rows) {
    const Albedo albedo = DirectionalAlbedoOf(*SingleLobe(row.roughness), row.theta_deg, 600, 8);
    EXPECT_NEAR(albedo.mean, row.albedo, 5e-4 + 4.0 * albedo.standard_error)
        << row.roughness << " at " << row.theta_deg;
  }
}

constexpr const char* kLibraryLobes =
    R"([{"roughness": 0.0043, "albedo": 0.109}, {"roughness": 0.0255, "albedo": 0.075}])";

TEST(Retroreflector, PeakIsThatOfTheLobes) {
  // At wi = wo the back vector is the normal: R_A = sum rho D(0) G2 / 4 with D(0) = 1 / (pi a^2)
  // and, at normal incidence, G2 = 1: sum rho / (4 pi a^2) = 478.3 /sr for the library's two lobes.
  // Away from normal incidence 1 / G2 = sqrt(1 + a^2 tan^2).
  const BsdfPtr lobes = FromJson(fmt::format(
      R"({{"type": "retroreflector", "diffuse_reflectance": 0.0, "ior": 1.0, "lobes": {}}})",
      kLibraryLobes));
  const double peaks[] = {0.109 / (4.0 * kPi * 0.0043 * 0.0043),
                          0.075 / (4.0 * kPi * 0.0255 * 0.0255)};
  EXPECT_NEAR(peaks[0] + peaks[1], 478.3, 0.05);
  for (const double beta_deg : {0.0, 30.0, 60.0, 80.0}) {
    const double tan2 = std::pow(std::tan(RadFromDeg(beta_deg)), 2);
    const double expected = peaks[0] / std::sqrt(1.0 + 0.0043 * 0.0043 * tan2) +
                            peaks[1] / std::sqrt(1.0 + 0.0255 * 0.0255 * tan2);
    const Vec3f w = AtAngle(beta_deg, 35.0);
    EXPECT_NEAR(CoefficientOfRetroReflection(*lobes, w, w), expected, 1e-4 * expected) << beta_deg;
  }
}

TEST(Retroreflector, BrightestTowardsTheSource) {
  // Among directions around that of the source, none sends more than the source's own.
  const BsdfPtr bead = LibraryMaterial("retro_bead").bsdf;
  for (const double beta_deg : {0.0, 5.0, 30.0, 60.0}) {
    const Vec3f wi = AtAngle(beta_deg);
    const double peak = CoefficientOfRetroReflection(*bead, wi, wi);
    for (double deg = -5.0; deg <= 5.0; deg += 0.25) {
      if (deg == 0.0) continue;
      EXPECT_LT(CoefficientOfRetroReflection(*bead, AtAngle(beta_deg + deg), wi), peak)
          << beta_deg << " + " << deg;
      EXPECT_LT(
          CoefficientOfRetroReflection(
              *bead, (wi + AtAngle(90.0, 90.0) * static_cast<float>(RadFromDeg(deg))).normalized(),
              wi),
          peak);
    }
  }
}

TEST(Retroreflector, FallsOffWithTheEntranceAngleAsTheStandardSays) {
  // R_A at 0.2 degrees over entrance angles 5, 20, 30, 40 degrees (EN ISO 20471): 330, 290, 180,
  // 65, over the first: 1, 0.88, 0.55, 0.20. The lobes are far narrower than the angles change, so
  // that the ratio is the weight's alone.
  const auto lobes = [](const std::string& weight) {
    return FromJson(fmt::format(
        R"({{"type": "retroreflector", "diffuse_reflectance": 0.0, "ior": 1.0, {}"lobes": {}}})",
        weight, kLibraryLobes));
  };
  const BsdfPtr weighted =
                    lobes(R"("entrance_weight": "materials/data/entrance_weight_iso20471.csv", )"),
                plain = lobes("");
  for (const auto& [beta_deg, weight] :
       {std::pair{0.0, 1.0}, {5.0, 1.0}, {20.0, 0.88}, {30.0, 0.55}, {40.0, 0.20}}) {
    // The source at beta, the camera 0.2 degrees beside it, across the plane of incidence.
    const Vec3f wi = AtAngle(beta_deg),
                wo = (wi + Vec3f(0.0f, static_cast<float>(RadFromDeg(0.2)), 0.0f)).normalized();
    const double there = CoefficientOfRetroReflection(*weighted, wo, wi),
                 back = CoefficientOfRetroReflection(*weighted, wi, wo);
    EXPECT_NEAR(there / CoefficientOfRetroReflection(*plain, wo, wi), weight, 2e-3) << beta_deg;
    EXPECT_NEAR(back, there, 1e-4 * there) << beta_deg;
  }
  // The symmetric weight is the geometric mean of both angles': source at 5, camera at 40 degrees.
  const Vec3f near = AtAngle(5.0), oblique = AtAngle(40.0);
  EXPECT_NEAR(CoefficientOfRetroReflection(*weighted, oblique, near) /
                  CoefficientOfRetroReflection(*plain, oblique, near),
              std::sqrt(0.20), 2e-3);
}

TEST(EntranceWeight, GaussianBetweenAndBeyondItsPoints) {
  const EntranceWeight weight =
      EntranceWeight::FromTable(DataPath("materials/data/entrance_weight_iso20471.csv"));
  const auto at = [&](double beta_deg) {
    return static_cast<double>(weight.At(static_cast<float>(std::cos(RadFromDeg(beta_deg)))));
  };
  // ln w is linear in beta^2: half way in beta^2 between 20 and 30 degrees lies the geometric mean,
  // sqrt(0.88 0.55) = 0.6957; beyond 40 degrees, ln w(50) = ln 0.2 + ln(0.2 / 0.55) (2500 - 1600) /
  // 700.
  EXPECT_NEAR(at(std::sqrt(650.0)), 0.6957, 1e-3);
  EXPECT_NEAR(at(50.0), 0.2 * std::pow(0.2 / 0.55, 900.0 / 700.0), 1e-3);
  EXPECT_EQ(at(0.0), 1.0);
  EXPECT_GE(at(90.0), 0.0);
  EXPECT_EQ(EntranceWeight().At(0.3f), 1.0f);
}

// --- spectra and filter ---

TEST(Spectrum, LedHasUnitIntegralAndItsWidth) {
  // A Gaussian exp(-4 ln 2 x^2 / w^2): half its peak at w / 2. The linear interpolation between
  // samples 1 nm apart costs at most h^2 / 8 times its curvature, 8 ln 2 / w^2 of the peak: 1e-3
  // for w = 30 nm at most.
  for (const auto& [peak_nm, fwhm_nm] : {std::pair{880.0, 80.0}, {850.0, 30.0}, {660.5, 20.0}}) {
    const Spectrum led = LedSpectrum({peak_nm, fwhm_nm});
    EXPECT_NEAR(led.Integral(), 1.0, 1e-6);
    const auto at = [&](double nm) { return static_cast<double>(led.At(static_cast<float>(nm))); };
    EXPECT_NEAR(at(peak_nm - 0.5 * fwhm_nm) / at(peak_nm), 0.5, 2e-3) << fwhm_nm;
    EXPECT_NEAR(at(peak_nm + 0.5 * fwhm_nm) / at(peak_nm), 0.5, 2e-3) << fwhm_nm;
    // Area of the Gaussian: peak x w sqrt(pi / (4 ln 2)).
    EXPECT_NEAR(at(peak_nm) * fwhm_nm * std::sqrt(kPi / (4.0 * std::numbers::ln2)), 1.0, 2e-3)
        << fwhm_nm;
  }
}

TEST(Spectrum, LinearBetweenPointsConstantBeyond) {
  const Spectrum spectrum = Spectrum::FromPoints({{500.0, 1.0}, {600.0, 3.0}, {610.0, 0.0}});
  EXPECT_FLOAT_EQ(spectrum.At(450.0f), 1.0f);
  EXPECT_FLOAT_EQ(spectrum.At(500.0f), 1.0f);
  EXPECT_FLOAT_EQ(spectrum.At(525.5f), 1.51f);
  EXPECT_FLOAT_EQ(spectrum.At(600.0f), 3.0f);
  EXPECT_NEAR(static_cast<double>(spectrum.At(607.0f)), 0.9, 1e-6);
  EXPECT_EQ(spectrum.At(700.0f), 0.0f);
  EXPECT_EQ(spectrum.At(-1.0f), 1.0f);
  EXPECT_EQ(spectrum.At(2000.0f), 0.0f);
  EXPECT_EQ(spectrum.Max(), 3.0f);
  // 100 nm at 1, a trapezium of 200, a triangle of 15.
  EXPECT_NEAR(spectrum.Integral(), 100.0 + 200.0 + 15.0, 1e-4);
  EXPECT_NEAR(spectrum.Normalised().Integral(), 1.0, 1e-6);
  const Spectral both = spectrum.At(Spectral(450.0f, 550.0f, 600.0f, 650.0f));
  EXPECT_FLOAT_EQ(both[1], 2.0f);
  EXPECT_EQ(both[3], 0.0f);
  EXPECT_EQ(Spectrum::Constant(0.25).At(555.5f), 0.25f);
  EXPECT_NEAR(Spectrum::Constant(0.25).Integral(), 0.25 * 700.0, 1e-9);
  EXPECT_EQ(Spectrum().At(555.5f), 0.0f);
}

TEST(DichroicFilter, HalfItsPeakAtTheEdgesOfItsBandAndAFloorBeyond) {
  const DichroicFilter filter;  // 880 nm, 50 nm wide, peak 0.85, OD 4
  EXPECT_NEAR(filter.Transmission(880.0, 0.0), 0.85, 2e-4);
  EXPECT_NEAR(filter.Transmission(855.0, 0.0), 0.425, 2e-4);
  EXPECT_NEAR(filter.Transmission(905.0, 0.0), 0.425, 2e-4);
  // Flat inside, steep at the edge: 2^-(0.5^8) = 0.997, 2^-(1.5^8) = 2e-8 of the peak.
  EXPECT_NEAR(filter.Transmission(892.5, 0.0), 0.85 * 0.9973, 3e-4);
  EXPECT_NEAR(filter.Transmission(842.5, 0.0), 1e-4, 1e-6);
  EXPECT_NEAR(filter.Transmission(450.0, 0.0), 1e-4, 1e-9);
  EXPECT_NEAR(filter.Transmission(1100.0, 0.1), 1e-4, 1e-9);
  // The band moves as a whole.
  const double shift = filter.CentreAt(std::sin(RadFromDeg(20.0))) - 880.0;
  EXPECT_NEAR(shift, 880.0 * (std::sqrt(1.0 - std::pow(std::sin(RadFromDeg(20.0)) / 1.9, 2)) - 1.0),
              1e-9);
  EXPECT_NEAR(filter.Transmission(905.0 + shift, std::sin(RadFromDeg(20.0))), 0.425, 2e-4);
  DichroicFilter open;
  open.peak_transmission = 1.0;
  open.optical_density = 1.0;
  EXPECT_LE(open.Transmission(880.0, 0.0), 1.0);  // no filter amplifies
}

// --- errors ---

TEST(BsdfFactory, ErrorsNamePlaceFoundAndExpected) {
  const auto error = [](const std::string& text) { return MessageOf([&] { FromJson(text); }); };
  EXPECT_EQ(
      error(R"({"type": "velvet"})"),
      "m.json: /type: found string \"velvet\"; expected one of absorber, back_vector, "
      "blend, coated_diffuse, conductor, diffuse, retro_table, retroreflector, rough_diffuse");
  EXPECT_EQ(error(R"({"reflectance": 0.5})"), "m.json: /: found no key 'type'; expected 'type'");
  EXPECT_EQ(error(R"({"type": "diffuse", "reflectanse": 0.5})"),
            "m.json: /: found the unknown key 'reflectanse'; expected 'reflectance', perhaps");
  EXPECT_EQ(error(R"({"type": "absorber", "reflectance": 0.5})"),
            "m.json: /: found the unknown key 'reflectance'; expected one of comment, type");
  EXPECT_EQ(error(R"({"type": "diffuse", "reflectance": 1.5})"),
            "m.json: /reflectance: found number 1.5; expected a number from 0 to 1");
  EXPECT_EQ(error(R"({"type": "coated_diffuse", "roughness": "rough"})"),
            "m.json: /roughness: found string \"rough\"; expected a number from 0.001 to 1");
  EXPECT_EQ(error(R"({"type": "retroreflector"})"),
            "m.json: /: found no key 'lobes'; expected 'lobes'");
  EXPECT_EQ(
      error(
          R"({"type": "retroreflector", "lobes": [{"roughness": 0.01, "albedo": 0.1}, {"roughness": 0, "albedo": 0.1}]})"),
      "m.json: /lobes/1/roughness: found number 0; expected a number from 0.0005 to 1");
  EXPECT_EQ(
      error(
          R"({"type": "retroreflector", "lobes": [{"roughness": 0.01, "albedo": 0.1, "albeedo": 0.1}]})"),
      "m.json: /lobes/0: found the unknown key 'albeedo'; expected 'albedo', perhaps");
  EXPECT_EQ(error(R"({"type": "diffuse", "comment": "fine"})"), "no error");
}

TEST(BsdfFactory, AlbedosAboveOneAreRefused) {
  EXPECT_EQ(
      MessageOf([] {
        FromJson(R"({"type": "retroreflector", "diffuse_reflectance": 0.5, "ior": 1.0,
                           "lobes": [{"roughness": 0.01, "albedo": 0.4}, {"roughness": 0.1, "albedo": 0.3}]})");
      }),
      "m.json: /: found lobes and body that reflect 1.200 of the light; expected a sum of albedo "
      "/ (share that passes the cover) and diffuse_reflectance of at most 1");
}

TEST(BsdfFactory, TablesAreCheckedLikeNumbers) {
  // A data folder of our own with a table that rises above 1 and one that falls below 0: no
  // reflectances.
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "retrolux_materials_test";
  std::filesystem::create_directories(folder);
  WriteTextFile(folder / "above.csv", "wavelength_nm,reflectance\n400,0.5\n900,1.5\n");
  WriteTextFile(folder / "below.csv", "wavelength_nm,reflectance\n400,0.5\n900,-0.5\n");
  ASSERT_EQ(setenv("RETROLUX_DATA", folder.c_str(), 1), 0);
  for (const char* table : {"above.csv", "below.csv"}) {
    EXPECT_THAT(MessageOf([&] {
                  FromJson(fmt::format(R"({{"type": "diffuse", "reflectance": "{}"}})", table));
                }),
                testing::AllOf(testing::HasSubstr(table), testing::HasSubstr("from 0 to 1")));
  }
  unsetenv("RETROLUX_DATA");
  std::filesystem::remove_all(folder);
  EXPECT_THAT(MessageOf([] {
                FromJson(R"({"type": "diffuse", "reflectance": "materials/data/absent.csv"})");
              }),
              testing::HasSubstr(
                  "m.json: /reflectance: found no table \"materials/data/absent.csv\"; expected"));
}

TEST(MaterialLibrary, UnknownNamesListTheKnown) {
  EXPECT_EQ(MessageOf([] { LibraryMaterial("mirror"); }),
            "material 'mirror' is not in the library; expected one of " +
                JoinNames(LibraryMaterialNames()));
  EXPECT_THAT(LibraryMaterialNames(), testing::IsSupersetOf({"mask", "retro_bead", "black"}));
}

}  // namespace
}  // namespace retrolux
