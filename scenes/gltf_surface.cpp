#include "scenes/gltf_surface.h"

#include <algorithm>
#include <cmath>

#include "materials/ra_table.h"
#include "materials/spectrum.h"

namespace retrolux {

namespace {

using Json = nlohmann::json;

// Limits of our dielectrics and facets (materials/coated_diffuse.cpp, conductor.cpp).
constexpr double kLeastIor = 1.01;
constexpr double kLeastWidth = 0.001;

// `share` of `one`; no blend where there is nothing to mix.
Json Blend(double share, Json one, Json zero) {
  if (share <= 0.0) return zero;
  if (share >= 1.0) return one;
  return {{"type", "blend"}, {"share", share}, {"one", std::move(one)}, {"zero", std::move(zero)}};
}

double FresnelAtNormal(double ior) {
  return std::pow((ior - 1.0) / (ior + 1.0), 2);
}

// Mean over the wavelengths.
double MeanOf(JsonReader& json, const std::string& key, double max, double fallback) {
  const Spectrum spectrum = ReadSpectrum(json, key, 0.0, max, fallback);
  return spectrum.Integral() / (kMaxWavelength_nm - kMinWavelength_nm);
}

GltfSurface Matte(double reflectance) {
  return {.reflectance = reflectance, .metallic = 0.0, .roughness = 1.0, .ior = 1.0};
}

GltfSurface OfDiffuse(JsonReader& json) {
  return Matte(MeanOf(json, "reflectance", 1.0, 0.5));
}

GltfSurface OfAbsorber(JsonReader&) {
  return Matte(0.0);
}

GltfSurface OfCoatedDiffuse(JsonReader& json) {
  return {.reflectance = MeanOf(json, "reflectance", 1.0, 0.8),
          .metallic = 0.0,
          .roughness = std::sqrt(json.Number("roughness", 0.0, 1.0, 0.15)),
          .ior = json.Number("ior", 1.0, 4.0, 1.47)};
}

GltfSurface OfConductor(JsonReader& json) {
  GltfSurface metal;
  metal.roughness = std::sqrt(json.Number("roughness", 0.0, 1.0, 0.2));
  if (json.Has("reflectance")) {
    metal.reflectance = MeanOf(json, "reflectance", 1.0, 1.0);
  } else {
    const double n = MeanOf(json, "n", 20.0, 1.0), k = MeanOf(json, "k", 20.0, 0.0);
    metal.reflectance = ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
  }
  return metal;
}

// A retro-reflecting metal that lets the matt body through: with the lobes' albedo rho and the
// body's d, the reflectance rho + d and the metallic share rho / (rho + d) give both at normal
// incidence.
GltfSurface OfSheet(double albedo, double width, double body) {
  GltfSurface sheet = Matte(albedo + body);
  if (albedo + body > 0.0) sheet.metallic = albedo / (albedo + body);
  sheet.roughness = std::sqrt(std::min(width, 1.0));
  sheet.retroreflection = 1.0;
  return sheet;
}

constexpr double kBodyOfSheets = 0.27;  // materials/sheet.h

// One lobe with the albedo of all and their peak at normal incidence, sum of rho_i / (4 pi a_i^2):
// 1 / a^2 is the mean of 1 / a_i^2 weighted by the albedos.
GltfSurface OfRetroreflector(JsonReader& json) {
  const JsonReader lobes = json.Child("lobes");
  double albedo = 0.0, peak = 0.0;
  for (size_t i = 0; i < lobes.Size(); ++i) {
    JsonReader lobe = lobes.Child(i);
    const double share = lobe.Number("albedo", 0.0, 1.0);
    albedo += share;
    peak += share / std::pow(lobe.Number("roughness", kLeastWidth / 2.0, 1.0), 2);
  }
  const double width = peak > 0.0 ? std::sqrt(albedo / peak) : 1.0;
  return OfSheet(albedo, width, MeanOf(json, "diffuse_reflectance", 1.0, kBodyOfSheets));
}

// The lobe by the table's first value and the observation angle alpha of half of it, at the least
// entrance angle: tan(alpha / 2) = sqrt(sqrt(2) - 1) a and R_A = rho / (4 pi a^2). ln R_A is taken
// as linear in the angle between two points and beyond the last.
GltfSurface OfRetroTable(JsonReader& json) {
  const RaTable table = RaTable::FromFile(ReadTablePath(json, "table"));
  const auto ra = [&](size_t i) { return table.ra[i][0]; };
  const double half = 0.5 * ra(0);
  size_t i = 1;
  while (i + 1 < table.ra.size() && ra(i) > half) ++i;
  const double slope =
      std::log(ra(i - 1) / ra(i)) / (table.observation_deg[i] - table.observation_deg[i - 1]);
  const double half_deg = slope > 0.0
                              ? table.observation_deg[i - 1] + std::log(ra(i - 1) / half) / slope
                              : table.observation_deg.back();
  const double width =
      std::tan(0.5 * RadFromDeg(std::min(half_deg, 90.0))) / std::sqrt(std::sqrt(2.0) - 1.0);
  const double body = MeanOf(json, "diffuse_reflectance", 1.0, kBodyOfSheets);
  return OfSheet(std::min(ra(0) * 4.0 * kPi * width * width, 1.0 - body), width, body);
}

// What the facets reflect at normal incidence: how much roughness and retroreflection matter.
double FacetReflectance(const GltfSurface& surface) {
  return surface.metallic * surface.reflectance +
         (1.0 - surface.metallic) * FresnelAtNormal(surface.ior);
}

// share a + (1 - share) b. Body and metal mix linearly; what only a part of the surface has is
// weighted with that part.
GltfSurface Mixed(double share, const GltfSurface& a, const GltfSurface& b) {
  const auto mean = [&](double weight_a, double x, double weight_b, double y, double none) {
    const double sum = share * weight_a + (1.0 - share) * weight_b;
    return sum > 0.0 ? (share * weight_a * x + (1.0 - share) * weight_b * y) / sum : none;
  };
  const double facets_a = FacetReflectance(a), facets_b = FacetReflectance(b);
  GltfSurface mix;
  mix.reflectance = mean(1.0, a.reflectance, 1.0, b.reflectance, 0.0);
  mix.metallic = mean(a.reflectance, a.metallic, b.reflectance, b.metallic, 0.0);
  mix.roughness = mean(facets_a, a.roughness, facets_b, b.roughness, 1.0);
  mix.ior = mean(1.0 - a.metallic, a.ior, 1.0 - b.metallic, b.ior, 1.5);
  mix.retroreflection = mean(facets_a, a.retroreflection, facets_b, b.retroreflection, 0.0);
  return mix;
}

GltfSurface Nearest(JsonReader json);

GltfSurface OfBlend(JsonReader& json) {
  return Mixed(json.Number("share", 0.0, 1.0), Nearest(json.Child("one")),
               Nearest(json.Child("zero")));
}

GltfSurface OfBackVector(JsonReader& json) {
  GltfSurface surface = Nearest(json.Child("of"));
  surface.retroreflection = 1.0 - surface.retroreflection;
  return surface;
}

struct Entry {
  const char* type;
  GltfSurface (*nearest)(JsonReader& json);
};

constexpr Entry kNearest[] = {
    {"absorber", OfAbsorber},
    {"back_vector", OfBackVector},
    {"blend", OfBlend},
    {"coated_diffuse", OfCoatedDiffuse},
    {"conductor", OfConductor},
    {"retro_table", OfRetroTable},
    {"retroreflector", OfRetroreflector},
};

// Of a type without an entry: a matt surface.
GltfSurface Nearest(JsonReader json) {
  const std::string type = json.String("type");
  for (const Entry& entry : kNearest) {
    if (type == entry.type) return entry.nearest(json);
  }
  return OfDiffuse(json);
}

}  // namespace

Json SpecOf(const GltfSurface& surface) {
  const double width = std::max(surface.roughness * surface.roughness, kLeastWidth);
  const Json body = {{"type", "diffuse"}, {"reflectance", surface.reflectance}};
  const Json coated = {{"type", "coated_diffuse"},
                       {"reflectance", surface.reflectance},
                       {"ior", surface.ior},
                       {"roughness", width}};
  const Json metal = {
      {"type", "conductor"}, {"reflectance", surface.reflectance}, {"roughness", width}};
  const Json forward = Blend(surface.metallic, metal, surface.ior < kLeastIor ? body : coated);
  return Blend(surface.retroreflection, {{"type", "back_vector"}, {"of", forward}}, forward);
}

GltfSurface NearestGltfSurface(const Json& spec) {
  GltfSurface surface = Nearest(JsonReader::FromText(spec.dump(), ""));
  surface.reflectance = std::min(surface.reflectance, 1.0);  // sums of single precision
  return surface;
}

}  // namespace retrolux
