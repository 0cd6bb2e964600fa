#include "analysis/layout_pose.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "analysis/stereo_bench.h"
#include "classifier/marker_point.h"
#include "classifier/method.h"
#include "classifier/stereo.h"
#include "core/hash.h"
#include "core/image_file.h"
#include "renderer/exposure.h"
#include "renderer/marker_truth.h"
#include "renderer/render_files.h"
#include "renderer/sensor.h"
#include "scenes/marker_placement.h"

namespace retrolux {

using Json = nlohmann::json;

namespace {

constexpr const char* kMask = "mask";
// A name belongs to a marker if its centroid lies this close to the marker's outline's, in the
// marker's size.
constexpr double kNear = 0.5;

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

std::optional<double> NumberOrNothing(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

}  // namespace

Json RunLayoutPose(const Scene& posed, const LayoutStudyOptions& options, const std::string& pose,
                   const std::filesystem::path& pictures) {
  const Stage stage(posed);
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
    if (!pictures.empty()) WritePng(pictures / (picture + ".png"), image);
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

void CollectLayoutPose(const Json& result, size_t pose, LayoutStudy& study) {
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

}  // namespace retrolux
