#include "analysis/layout_study.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "analysis/stereo_bench.h"
#include "classifier/marker_point.h"
#include "classifier/method.h"
#include "classifier/stereo.h"
#include "core/atomic_file.h"
#include "core/hash.h"
#include "core/image_file.h"
#include "renderer/exposure.h"
#include "renderer/marker_truth.h"
#include "renderer/render_files.h"
#include "renderer/sensor.h"
#include "scenes/marker_placement.h"
#include "scenes/masks.h"
#include "scenes/scene_json.h"

namespace retrolux {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

constexpr const char* kMask = "mask";
// A name belongs to a marker if its centroid lies this close to the marker's outline's, in the
// marker's size.
constexpr double kNear = 0.5;

Scene WithMask(Scene scene, const LayoutStudyOptions& options) {
  SceneObject* mask = nullptr;
  for (SceneObject& object : scene.objects) {
    if (object.name == kMask && object.moves_with_pose) mask = &object;
  }
  if (!mask) {
    throw InputError(
        fmt::format("scene '{}': no object '{}' that moves with the pose", scene.name, kMask));
  }
  mask->mesh = MakeMask(options.mask);
  mask->perforation.reset();
  scene.markers.clear();
  scene.UseMaterial(options.material);
  scene.exposure.marker_material = options.material;
  return scene;
}

// Of the poses, those a search step apart, and the last.
std::vector<Pose> SearchPoses(const LayoutStudyOptions& options) {
  std::vector<Pose> chosen;
  for (const Pose& pose : options.poses) {
    const bool far = chosen.empty() || (pose.translation - chosen.back().translation).norm() >=
                                           options.search_step_mm - 1e-6;
    if (far || &pose == &options.poses.back()) chosen.push_back(pose);
  }
  return chosen;
}

std::vector<MarkerShape> IdentifiableShapes(const MarkerSet& set) {
  std::vector<MarkerShape> shapes;
  for (const MarkerShape& shape : set.shapes) {
    if (shape.number != 0) shapes.push_back(shape);
  }
  return shapes;
}

std::vector<MarkerSpec> Markers(const std::vector<MarkerPlace>& places, const MarkerLayout& layout,
                                const LayoutStudyOptions& options, const MarkerSet& set) {
  const std::vector<MarkerShape> shapes = IdentifiableShapes(set);
  std::vector<MarkerSpec> markers;
  for (size_t i = 0; i < layout.places.size(); ++i) {
    const int number = shapes[i].number;
    MarkerSpec marker{fmt::format("marker-{}", number), number, kMask, places[layout.places[i]].at};
    marker.material = options.material;
    markers.push_back(std::move(marker));
  }
  return markers;
}

MarkerLayout Search(const Scene& scene, const LayoutStudyOptions& options,
                    const std::vector<MarkerPlace>& places, Progress& progress) {
  const SightTable table =
      SeePlaces(scene, SearchPoses(options), places, options.layout.max_incidence_deg, progress);
  return FindLayout(scene, table, places, options.layout, progress);
}

// A pose, ready for its pictures.
struct Stage {
  Scene scene;
  RayScene rays;
  std::vector<PlacedMarker> placed;
  RigidTransform world_from_mask;
  Constellation constellation;

  explicit Stage(const Scene& posed)
      : scene(posed),
        rays(scene),
        placed(PlaceMarkers(scene)),
        world_from_mask(scene.Object(kMask).world_from_object) {
    for (size_t i = 0; i < placed.size(); ++i) {
      const auto hit = OntoSurface(rays, placed[i], ShapeCentre(*placed[i].shape).head<2>());
      RETROLUX_CHECK(hit.has_value(), "marker {} lies beside the mask", scene.markers[i].name);
      constellation.push_back({scene.markers[i].name, scene.markers[i].number,
                               world_from_mask.Inverse() * hit->position.cast<double>(),
                               world_from_mask.rotation.transpose() * placed[i].NormalInWorld()});
    }
  }
};

struct Seen {
  std::vector<LayoutSighting> markers;
  std::vector<Detection> named;
  int misnamed = 0;
};

Seen Match(const Stage& stage, const CameraModel& camera, const std::vector<Detection>& found) {
  Seen seen;
  for (const Detection& d : found) {
    if (d.marker) seen.named.push_back(d);
  }
  std::vector<bool> right(seen.named.size(), false);
  for (size_t m = 0; m < stage.placed.size(); ++m) {
    const MarkerView view =
        ViewMarker(SampleMarkerSurface(stage.rays, stage.placed[m]), stage.rays, camera);
    LayoutSighting sighting{
        stage.scene.markers[m].number, view.incidence_deg, view.visible_fraction, {}};
    const double size_px = std::sqrt(std::abs(SignedArea(view.outline_px)));
    for (size_t d = 0; d < seen.named.size(); ++d) {
      if (!view.centroid_outline_px) break;
      const double distance = (seen.named[d].centroid_px - *view.centroid_outline_px).norm();
      if (distance > kNear * size_px) continue;
      sighting.named = seen.named[d].marker;
      right[d] = *sighting.named == sighting.marker;
    }
    seen.markers.push_back(std::move(sighting));
  }
  seen.misnamed = static_cast<int>(std::count(right.begin(), right.end(), false));
  return seen;
}

bool IsNamed(const LayoutSighting& s) {
  return s.named == s.marker;
}

LayoutPair PairOf(const Stage& stage, const std::vector<Seen>& seen, size_t a, size_t b,
                  const LayoutStudyOptions& options) {
  const CameraModel& first = stage.scene.cameras[a].model;
  const CameraModel& second = stage.scene.cameras[b].model;
  const Vec3d origin = stage.world_from_mask.translation;
  LayoutPair pair;
  pair.a = a;
  pair.b = b;
  pair.separation_deg = SeparationDeg(first, second, origin);
  std::vector<SharedMarker> points;
  for (size_t m = 0; m < stage.placed.size(); ++m) {
    if (!IsNamed(seen[a].markers[m]) || !IsNamed(seen[b].markers[m])) continue;
    pair.common.push_back(seen[a].markers[m].marker);
    points.push_back({stage.constellation[m].at,
                      RelativeSigma(stage.placed[m].shape->straight_edges, MarkerPoint::kCentre)});
  }
  const double tre = PairTre_mm(points, first, second, origin, options.layout.point_sigma_px);
  pair.expected_tre_mm = std::isfinite(tre) ? tre : 0.0;
  const StereoResult result = Reconstruct({{first, seen[a].named}, {second, seen[b].named}},
                                          stage.constellation, StereoOptions{});
  if (result.pose) {
    const RigidTransform& pose = result.pose->world_from_mask;
    pair.position_error_mm = (pose.translation - origin).norm();
    pair.rotation_error_deg =
        DegFromRad(RotationAngle(pose.rotation * stage.world_from_mask.rotation.transpose()));
  }
  return pair;
}

Json ToJson(const LayoutSighting& s) {
  return {s.marker, s.incidence_deg, s.visible_fraction, s.named ? Json(*s.named) : Json()};
}

Json ToJson(const LayoutPair& pair) {
  return {
      {"a", pair.a},
      {"b", pair.b},
      {"separation_deg", pair.separation_deg},
      {"common", pair.common},
      {"expected_tre_mm", pair.expected_tre_mm},
      {"position_error_mm", pair.position_error_mm ? Json(*pair.position_error_mm) : Json()},
      {"rotation_error_deg", pair.rotation_error_deg ? Json(*pair.rotation_error_deg) : Json()}};
}

bool IsKept(const LayoutStudyOptions& options, size_t pose) {
  const auto height = [&](const Pose& p) { return p.translation.z(); };
  const auto [lo, hi] =
      std::minmax_element(options.poses.begin(), options.poses.end(),
                          [&](const Pose& a, const Pose& b) { return height(a) < height(b); });
  const auto middle = std::min_element(
      options.poses.begin(), options.poses.end(),
      [&](const Pose& a, const Pose& b) { return std::abs(height(a)) < std::abs(height(b)); });
  const Pose* p = &options.poses[pose];
  return p == &*lo || p == &*hi || p == &*middle;
}

// All cameras in one pose.
Json RunPose(const Scene& posed, const LayoutStudyOptions& options, size_t index,
             const fs::path& folder) {
  const Stage stage(posed);
  const std::string& pose = options.poses[index].name;
  const Method method = MethodByName(options.method);
  std::vector<Seen> seen;
  int misnamed = 0;
  Json sightings = Json::array();
  for (const CameraSpec& camera : stage.scene.cameras) {
    const std::string picture = fmt::format("{}_{}", pose, camera.model.name);
    const double exposure_s = ExposureSeconds(stage.scene, camera);
    const Film film =
        RenderSparsely(stage.scene, stage.rays, stage.placed, camera, exposure_s,
                       options.samples_per_pixel, CombineKeys(options.seed, HashBytes(picture)));
    const DigitalImage image =
        Sensor(camera).Expose(film.electrons, exposure_s, NoiseKey(options.seed, picture));
    if (IsKept(options, index)) WritePng(folder / "pictures" / (picture + ".png"), image);
    seen.push_back(Match(stage, camera.model, method(image, *stage.scene.marker_set, nullptr)));
    misnamed += seen.back().misnamed;
    Json row = Json::array();
    for (const LayoutSighting& s : seen.back().markers) row.push_back(ToJson(s));
    sightings.push_back(row);
  }
  Json pairs = Json::array();
  for (size_t a = 0; a < seen.size(); ++a) {
    for (size_t b = a + 1; b < seen.size(); ++b) {
      const LayoutPair pair = PairOf(stage, seen, a, b, options);
      if (pair.separation_deg >= options.layout.min_separation_deg) pairs.push_back(ToJson(pair));
    }
  }
  return {{"sightings", sightings}, {"pairs", pairs}, {"misnamed", misnamed}};
}

std::optional<double> NumberOrNothing(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

void Collect(const Json& result, size_t pose, LayoutStudy& study) {
  auto& cameras = study.sightings.emplace_back();
  for (const Json& row : result.at("sightings")) {
    auto& markers = cameras.emplace_back();
    for (const Json& s : row) {
      markers.push_back({s.at(0).get<int>(), s.at(1).get<double>(), s.at(2).get<double>(),
                         s.at(3).is_null() ? std::nullopt : std::optional(s.at(3).get<int>())});
    }
  }
  for (const Json& p : result.at("pairs")) {
    study.pairs.push_back(
        {pose, p.at("a").get<size_t>(), p.at("b").get<size_t>(),
         p.at("separation_deg").get<double>(), p.at("common").get<std::vector<int>>(),
         p.at("expected_tre_mm").get<double>(), NumberOrNothing(p.at("position_error_mm")),
         NumberOrNothing(p.at("rotation_error_deg"))});
  }
  study.misnamed += result.at("misnamed").get<int>();
}

Json Inputs(const Scene& scene, const LayoutStudyOptions& options) {
  const LayoutOptions& l = options.layout;
  return {{"scene", SceneHash(scene)},
          {"method", options.method},
          {"spp", options.samples_per_pixel},
          {"seed", options.seed},
          {"min_separation_deg", l.min_separation_deg},
          {"point_sigma_px", l.point_sigma_px}};
}

}  // namespace

const LayoutPair& LayoutStudy::Best(size_t pose) const {
  const LayoutPair* best = nullptr;
  for (const LayoutPair& pair : pairs) {
    if (pair.pose != pose) continue;
    const bool better =
        !best || pair.common.size() > best->common.size() ||
        (pair.common.size() == best->common.size() && pair.expected_tre_mm < best->expected_tre_mm);
    if (better) best = &pair;
  }
  RETROLUX_CHECK(best != nullptr, "no pair of cameras is far enough apart");
  return *best;
}

int LayoutStudy::Margin() const {
  auto least = static_cast<int>(markers.size());
  for (size_t pose = 0; pose < options.poses.size(); ++pose)
    least = std::min(least, static_cast<int>(Best(pose).common.size()));
  return least - 3;
}

LayoutStudy RunLayoutStudy(const Scene& scene, const LayoutStudyOptions& options,
                           const fs::path& folder, Progress& progress) {
  Scene room = WithMask(scene, options);
  EnsureWritableFolder(folder / "pictures");
  LayoutStudy study;
  study.options = options;
  study.scene = scene.name;
  for (const CameraSpec& camera : room.cameras) study.cameras.push_back(camera.model.name);
  LayoutOptions& layout = study.options.layout;
  layout.relative_sigma.clear();
  for (const MarkerShape& shape : IdentifiableShapes(*room.marker_set))
    layout.relative_sigma.push_back(RelativeSigma(shape.straight_edges, MarkerPoint::kCentre));
  const std::vector<MarkerPlace> places = CandidatePlaces(room, layout);
  study.found = Search(room, study.options, places, progress);
  room.markers = study.markers = Markers(places, study.found, options, *room.marker_set);

  std::vector<Task> tasks;
  for (const Pose& pose : options.poses) {
    const Vec3d& t = pose.translation;
    tasks.push_back(
        {"pose " + pose.name, {{"pose", pose.name}, {"translation_mm", {t.x(), t.y(), t.z()}}}});
  }
  TaskLoop loop;
  loop.parallel = false;
  TaskManifest manifest(folder, "layout", Inputs(room, options));
  const std::vector<Json> done = manifest.Run(
      "poses", tasks,
      [&](size_t task) { return RunPose(room.AtPose(options.poses[task]), options, task, folder); },
      progress, loop);
  study.tasks = manifest.Report();
  for (size_t pose = 0; pose < done.size(); ++pose) Collect(done[pose], pose, study);
  return study;
}

}  // namespace retrolux
