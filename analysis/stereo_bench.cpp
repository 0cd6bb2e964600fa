#include "analysis/stereo_bench.h"

#include <cmath>

#include "analysis/sparse_film.h"
#include "classifier/method.h"
#include "core/hash.h"
#include "core/rng.h"
#include "renderer/exposure.h"
#include "renderer/lens_scatter.h"
#include "renderer/render_files.h"
#include "renderer/sensor.h"
#include "scenes/masks.h"
#include "scenes/mesh_shapes.h"
#include "scenes/scene_parts.h"

namespace retrolux {

namespace {

using Json = nlohmann::json;

constexpr const char* kObject = "target";
// A detection is of a marker if it lies no further from where the marker is.
constexpr double kSame_px = 6.0;

std::string NameOf(const StereoShotSpec& spec) {
  return fmt::format("{}_{:g}_{}", NameOf(spec.target), spec.psi_deg, spec.placement);
}

double Even(KeyedRng& rng, double half) {
  return half * (2.0 * rng.NextDouble() - 1.0);
}

RigidTransform PlacementOf(const StereoShotSpec& spec, uint64_t seed) {
  constexpr double kShift_mm = 20.0, kTurn_deg = 10.0;
  KeyedRng rng(CombineKeys(seed, HashBytes(fmt::format("placement {}", spec.placement))));
  const Vec3d shift(Even(rng, kShift_mm), Even(rng, kShift_mm), Even(rng, kShift_mm));
  Mat3d turn = Mat3d::Identity();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    turn = turn * Eigen::AngleAxisd(RadFromDeg(Even(rng, kTurn_deg)), Vec3d::Unit(axis));
  }
  const double roll = Even(rng, kPi);
  if (spec.target == StereoTarget::kPanel) turn = turn * Eigen::AngleAxisd(roll, Vec3d::UnitX());
  return {turn, shift};
}

void AddTarget(const StereoShotSpec& spec, const StereoShotOptions& options, Scene& scene) {
  const bool panel = spec.target == StereoTarget::kPanel;
  if (panel) {
    AddObject(scene, kObject, RectangleMesh({0, -90, -90}, {0, 180, 0}, {0, 0, 180}), "black");
  } else {
    AddObject(scene, kObject, MakeMask("oval"), "mask");
  }
  scene.objects.back().world_from_object = PlacementOf(spec, options.seed);
  const double y = panel ? 35.0 : 25.0, z = panel ? 50.0 : 60.0;
  for (int i = 0; i < 6; ++i) {
    const Vec3d at(panel ? 0.0 : 95.0, i < 3 ? -y : y, (i % 3 - 1) * z);
    scene.markers.push_back(
        {fmt::format("marker-{}", i + 1), i + 1, kObject, at, 15.0 * i, options.material});
  }
  const Vec3d at = panel ? Vec3d(0, 0, 0.5 * z) : Vec3d(100, 0, 0.5 * z);
  scene.markers.push_back({"standard", 0, kObject, at, 0.0, options.material});
}

// What both cameras of a pair share.
struct Stage {
  const StereoShotSpec& spec;
  const StereoShotOptions& options;
  Scene scene;
  RayScene rays;
  std::vector<PlacedMarker> placed;

  Stage(const StereoShotSpec& shot, const StereoShotOptions& shot_options)
      : spec(shot),
        options(shot_options),
        scene(StereoScene(shot, shot_options)),
        rays(scene),
        placed(PlaceMarkers(scene)) {}
};

// The detections of one exposure, each given to the marker that it names or counted as misnamed.
void Assign(const std::vector<Detection>& detections, size_t view, size_t exposure,
            StereoShot& shot) {
  for (const Detection& detection : detections) {
    if (!detection.marker) continue;
    for (MarkerInPair& marker : shot.markers) {
      if (marker.known.number != *detection.marker) continue;
      MarkerInView& in_view = marker.views[view];
      if ((detection.centroid_px - in_view.projected_px).norm() > kSame_px) {
        ++shot.misnamed;
      } else {
        in_view.found[exposure] = {detection.centroid_px,
                                   detection.centre_px.value_or(detection.centroid_px)};
      }
    }
  }
}

void Record(const Stage& stage, size_t view, StereoShot& shot) {
  const CameraSpec& camera = stage.scene.cameras[view];
  const double exposure_s = ExposureSeconds(stage.scene, camera);
  const uint64_t seed = CombineKeys(stage.options.seed, HashBytes(NameOf(stage.spec)));
  const Film film = RenderSparsely(stage.scene, stage.rays, stage.placed, camera, exposure_s,
                                   stage.options.samples_per_pixel, seed);
  for (size_t m = 0; m < shot.markers.size(); ++m) {
    MarkerInView& in_view = shot.markers[m].views[view];
    const MarkerView truth =
        ViewMarker(SampleMarkerSurface(stage.rays, stage.placed[m]), stage.rays, camera.model);
    in_view.incidence_deg = truth.incidence_deg;
    in_view.projected_px = *camera.model.Project(shot.markers[m].at);
    in_view.outline_px = truth.centroid_outline_px;
    in_view.radiometric_px = RadiometricCentroid(film, stage.placed[m].instance, camera.sensor);
    in_view.found.resize(static_cast<size_t>(stage.options.exposures));
  }
  const Sensor sensor(camera);
  const Method method = MethodByName("robust");
  for (size_t k = 0; k < static_cast<size_t>(stage.options.exposures); ++k) {
    const std::string picture = fmt::format("{}_{}_{}", NameOf(stage.spec), camera.model.name, k);
    const DigitalImage image =
        sensor.Expose(film.electrons, exposure_s, NoiseKey(stage.options.seed, picture));
    Assign(method(image, *stage.scene.marker_set, nullptr), view, k, shot);
  }
}

Json PointJson(const Vec2d& p) {
  return {p.x(), p.y()};
}

Json PointJson(const std::optional<Vec2d>& p) {
  return p ? PointJson(*p) : Json(nullptr);
}

Vec2d PointOf(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>()};
}

std::optional<Vec2d> MaybePointOf(const Json& json) {
  if (json.is_null()) return std::nullopt;
  return PointOf(json);
}

Json VectorJson(const Vec3d& v) {
  return {v.x(), v.y(), v.z()};
}

Vec3d VectorOf(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

Json ViewJson(const MarkerInView& view) {
  Json found = Json::array();
  for (const auto& f : view.found) {
    found.push_back(f ? Json{f->light.x(), f->light.y(), f->centre.x(), f->centre.y()}
                      : Json(nullptr));
  }
  return {{"incidence_deg", view.incidence_deg},
          {"projected_px", PointJson(view.projected_px)},
          {"outline_px", PointJson(view.outline_px)},
          {"radiometric_px", PointJson(view.radiometric_px)},
          {"found", found}};
}

MarkerInView ViewOf(const Json& json) {
  MarkerInView view;
  view.incidence_deg = json.at("incidence_deg");
  view.projected_px = PointOf(json.at("projected_px"));
  view.outline_px = MaybePointOf(json.at("outline_px"));
  view.radiometric_px = MaybePointOf(json.at("radiometric_px"));
  for (const Json& f : json.at("found")) {
    view.found.emplace_back();
    if (!f.is_null())
      view.found.back() = {PointOf(f), Vec2d(f.at(2).get<double>(), f.at(3).get<double>())};
  }
  return view;
}

}  // namespace

const char* NameOf(StereoTarget target) {
  return target == StereoTarget::kPanel ? "panel" : "oval";
}

std::array<CameraSpec, 2> StereoPair(double psi_deg, double distance_mm) {
  const auto at = [&](const char* name, double azimuth) {
    return ThesisCamera(name, distance_mm * Vec3d(std::cos(azimuth), std::sin(azimuth), 0.0),
                        Vec3d::UnitZ());
  };
  const double half = 0.5 * RadFromDeg(psi_deg);
  return {at("left", half), at("right", -half)};
}

Scene StereoScene(const StereoShotSpec& spec, const StereoShotOptions& options) {
  Scene scene;
  scene.name = "stereo";
  scene.UseMaterial(options.material);
  AddTarget(spec, options, scene);
  for (CameraSpec& camera : StereoPair(spec.psi_deg, options.distance_mm))
    scene.cameras.push_back(std::move(camera));
  scene.exposure.distance_mm = options.distance_mm;
  scene.exposure.marker_material = options.material;
  return scene;
}

Film RenderSparsely(const Scene& scene, const RayScene& rays,
                    const std::vector<PlacedMarker>& placed, const CameraSpec& camera,
                    double exposure_s, int samples_per_pixel, uint64_t seed) {
  TraceOptions trace;
  trace.samples_per_pixel = samples_per_pixel;
  trace.seed = seed;
  trace.own_ray_share = kStrongGroups;
  trace.roulette = 0.5f;
  const IdBuffers ids = RenderIds(rays, camera.model, placed);
  const Lights lights(scene, rays, RingChoice::kAll, camera.model.name);
  const CameraResponse response(camera, lights.Spectra(), exposure_s);
  const PathTracer tracer(scene, rays, lights, response, placed, trace);
  const int more = 4 * samples_per_pixel;
  SparseFilm sparse = RenderSparseFilm(tracer, scene, camera, ids, exposure_s,
                                       {samples_per_pixel, more, more}, lights.GroupNames());
  LensScatter(camera, response.MeanWavelength_nm()).Apply(sparse.film);
  return std::move(sparse.film);
}

StereoShot ShootStereo(const StereoShotSpec& spec, const StereoShotOptions& options) {
  const Stage stage(spec, options);
  StereoShot shot;
  shot.world_from_target = stage.scene.objects.front().world_from_object;
  for (const PlacedMarker& placed : stage.placed) {
    const Vec3d centre = ShapeCentre(*placed.shape);
    const auto hit = OntoSurface(stage.rays, placed, centre.head<2>());
    RETROLUX_CHECK(hit, "marker {} is not on its target", placed.instance);
    const Vec3d at = hit->position.cast<double>();
    const MarkerSpec& marker = stage.scene.markers[placed.instance - 1];
    shot.markers.push_back(
        {{marker.name, marker.number, shot.world_from_target.Inverse() * at}, at, {}});
  }
  for (size_t view = 0; view < 2; ++view) Record(stage, view, shot);
  return shot;
}

Json StereoShot::ToJson() const {
  Json list = Json::array();
  for (const MarkerInPair& marker : markers) {
    list.push_back({{"name", marker.known.name},
                    {"number", marker.known.number},
                    {"at_target_mm", VectorJson(marker.known.at)},
                    {"at_mm", VectorJson(marker.at)},
                    {"views", {ViewJson(marker.views[0]), ViewJson(marker.views[1])}}});
  }
  const Mat3d& r = world_from_target.rotation;
  return {
      {"R_world_from_target", {VectorJson(r.row(0)), VectorJson(r.row(1)), VectorJson(r.row(2))}},
      {"t_world_from_target_mm", VectorJson(world_from_target.translation)},
      {"markers", list},
      {"misnamed", misnamed}};
}

StereoShot StereoShot::FromJson(const Json& json) {
  StereoShot shot;
  for (Eigen::Index i = 0; i < 3; ++i) {
    shot.world_from_target.rotation.row(i) =
        VectorOf(json.at("R_world_from_target").at(static_cast<size_t>(i)));
  }
  shot.world_from_target.translation = VectorOf(json.at("t_world_from_target_mm"));
  for (const Json& marker : json.at("markers")) {
    shot.markers.push_back(
        {{marker.at("name"), marker.at("number"), VectorOf(marker.at("at_target_mm"))},
         VectorOf(marker.at("at_mm")),
         {ViewOf(marker.at("views")[0]), ViewOf(marker.at("views")[1])}});
  }
  shot.misnamed = json.at("misnamed");
  return shot;
}

}  // namespace retrolux
