#include "analysis/hotspot_light.h"

#include <algorithm>

#include "renderer/edge_pixels.h"
#include "renderer/exposure.h"
#include "renderer/lens_scatter.h"

namespace retrolux {

namespace {

using Json = nlohmann::json;

bool IsSheeting(const Json& spec) {
  return spec.at("type") == "retroreflector" || spec.at("type") == "retro_table";
}

// A sheet without its lobe is a coat over a diffuse body (materials/sheet.h), the same formulae.
Json Plain(const Json& spec) {
  if (!IsSheeting(spec)) return spec;
  const Json body = spec.value("diffuse_reflectance", Json(0.27));
  if (spec.value("ior", 1.5) <= 1.0) return {{"type", "diffuse"}, {"reflectance", body}};
  return {{"type", "coated_diffuse"},
          {"reflectance", body},
          {"ior", spec.value("ior", 1.5)},
          {"roughness", spec.value("cover_roughness", 0.1)}};
}

Json Glints(const Json& spec, const std::string& name) {
  Json glints = Plain(spec);
  const std::string type = glints.at("type").get<std::string>();
  if (type == "coated_diffuse") {
    glints["reflectance"] = 0.0;
    glints.erase("reflectance_texture");
  } else if (type == "diffuse" || type == "rough_diffuse") {
    glints = {{"type", "absorber"}};
  } else if (type != "absorber" && type != "conductor") {
    throw InputError(
        fmt::format("material '{}': found type {}; expected one whose mirror-like "
                    "reflection can be told from the rest: coated_diffuse, diffuse, "
                    "rough_diffuse, conductor, retroreflector, retro_table, absorber",
                    name, type));
  }
  return glints;
}

template <typename Change>
Scene WithMaterials(const Scene& scene, Change change) {
  Scene changed = scene;
  for (auto& [name, material] : changed.materials) {
    const Json spec = change(material.spec, name);
    if (spec != material.spec)
      material = ReadMaterial(name, JsonReader::FromText(spec.dump(), name));
  }
  return changed;
}

Plane<int> SampleCounts(const IdBuffers& ids, const Plane<uint8_t>& edges, size_t mask,
                        const HotspotSamples& samples) {
  Plane<int> counts(edges.width, edges.height, samples.rest);
  for (size_t i = 0; i < counts.data.size(); ++i) {
    if (edges.data[i] != 0) {
      counts.data[i] = samples.edge;
    } else if (ids.marker.data[i] != 0) {
      counts.data[i] = samples.marker;
    } else if (ids.object.data[i] == mask + 1) {
      counts.data[i] = samples.mask;
    }
  }
  return counts;
}

// All light groups of a scene of which `rays` has the geometry.
Film Trace(const Scene& scene, const RayScene& rays, const CameraSpec& camera, double exposure_s,
           const Plane<int>& samples, int surfaces, uint64_t seed) {
  const std::vector<PlacedMarker> placed = PlaceMarkers(scene);
  const Lights lights(scene, rays, RingChoice::kAll, camera.model.name);
  const CameraResponse response(camera, lights.Spectra(), exposure_s);
  TraceOptions options;
  options.seed = seed;
  options.max_surfaces = surfaces;
  const PathTracer tracer(scene, rays, lights, response, placed, options);
  Film film = RenderFilm(tracer, camera.model, samples, lights.GroupNames(), NoProgress());
  LensScatter(camera, response.MeanWavelength_nm()).Apply(film);
  return film;
}

}  // namespace

Scene WithPlainSheeting(const Scene& scene) {
  return WithMaterials(scene, [](const Json& spec, const std::string&) { return Plain(spec); });
}

Scene WithGlintsOnly(const Scene& scene) {
  return WithMaterials(scene, Glints);
}

HotspotLight TraceHotspots(const Scene& scene, const RayScene& rays, const CameraSpec& camera,
                           size_t mask, const HotspotSamples& samples, uint64_t seed) {
  HotspotLight light;
  light.exposure_s = ExposureSeconds(scene, camera);
  light.ids = RenderIds(rays, camera.model, PlaceMarkers(scene));
  light.edges = EdgePixels(light.ids, camera.model);
  const Plane<int> counts = SampleCounts(light.ids, light.edges, mask, samples);
  const auto trace = [&](const Scene& variant) {
    return Trace(variant, rays, camera, light.exposure_s, counts, samples.surfaces, seed);
  };
  Film all = trace(scene);
  light.groups = all.group_names;
  light.all = std::move(all.group_electrons);
  light.plain = trace(WithPlainSheeting(scene)).group_electrons;
  light.glints = trace(WithGlintsOnly(scene)).group_electrons;
  const auto own = std::find(light.groups.begin(), light.groups.end(), camera.model.name);
  RETROLUX_CHECK(own != light.groups.end(), "camera {} has no ring", camera.model.name);
  light.own = static_cast<size_t>(own - light.groups.begin());
  return light;
}

std::vector<FloatPlane> TraceBareGlints(const Scene& scene, const RayScene& rays,
                                        const CameraSpec& camera, size_t mask,
                                        const HotspotSamples& samples, uint64_t seed) {
  Scene bare = WithGlintsOnly(scene);
  bare.markers.clear();
  const IdBuffers ids = RenderIds(rays, camera.model, {});
  const Plane<int> counts = SampleCounts(ids, EdgePixels(ids, camera.model), mask, samples);
  const double exposure_s = ExposureSeconds(scene, camera);
  return Trace(bare, rays, camera, exposure_s, counts, samples.surfaces, seed).group_electrons;
}

}  // namespace retrolux
