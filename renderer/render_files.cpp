#include "renderer/render_files.h"

#include "core/hash.h"
#include "renderer/camera_response.h"

namespace retrolux {

namespace {

std::string Join(const std::vector<double>& values) {
  return fmt::format("{}", fmt::join(values, " "));
}

void AddCamera(const CameraModel& camera, std::map<std::string, std::string>& attributes) {
  const Mat3d& r = camera.camera_from_world.rotation;
  const Vec3d& t = camera.camera_from_world.translation;
  attributes["opencv/K"] = Join({camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1});
  const std::array<double, 5> d = camera.distortion.Coefficients();
  attributes["opencv/distortion"] = Join({d.begin(), d.end()});
  attributes["opencv/R"] =
      Join({r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)});
  attributes["opencv/t"] = Join({t.x(), t.y(), t.z()});
  attributes["opencv/axes"] = "camera x right, y down, z forward; x_camera = R x_world + t; mm";
  attributes["pixel_origin"] = "center";
}

void AddUnits(bool film, std::map<std::string, std::string>& attributes) {
  if (film) {
    attributes["units/electrons"] =
        "noiseless mean signal, photo-electrons; electrons.NAME.Y by light group";
    attributes["units/variance"] = "variance of the mean of electrons.Y, e-^2 (upper bound)";
    attributes["units/radiance"] = "radiance within the filter's band, W/(m2 sr)";
    attributes["units/marker"] =
        "share of the pixel's samples that show marker idN; ranked, 0 = none";
  }
  attributes["units/depth"] = "mm along the camera's axis, of the pixel's centre; 0 = nothing";
  attributes["units/position"] = "mm, world, of the pixel's centre";
  attributes["units/normal"] = "unit vector, world, shading normal";
  attributes["units/id"] =
      "1-based, 0 = none, of the pixel's centre, never filtered; id.triangle within its object";
}

std::string InstanceNames(const std::vector<MarkerSpec>& specs) {
  std::vector<std::string> names;
  for (size_t i = 0; i < specs.size(); ++i) {
    names.push_back(fmt::format("{}={} (shape {})", i + 1, specs[i].name, specs[i].number));
  }
  return JoinNames(names);
}

void AddFilm(const Film& film, std::vector<ExrChannel>& channels) {
  channels.push_back({"electrons.Y", film.electrons});
  for (size_t g = 0; g < film.group_names.size(); ++g) {
    channels.push_back(
        {fmt::format("electrons.{}.Y", film.group_names[g]), film.group_electrons[g]});
  }
  channels.push_back({"variance.Y", film.variance});
  channels.push_back({"radiance.Y", film.radiance});
  for (size_t rank = 0; rank < 3; ++rank) {
    channels.push_back({fmt::format("marker.id{}", rank), film.marker_id[rank]});
    channels.push_back({fmt::format("marker.weight{}", rank), film.marker_weight[rank]});
  }
}

}  // namespace

ExrImage ShotExr(const CameraSpec& camera, const IdBuffers& ids, const Film* film,
                 const ShotInfo& info, const std::vector<std::string>& body_names,
                 const std::vector<PlacedMarker>& markers,
                 const std::vector<MarkerSpec>& marker_specs) {
  ExrImage image;
  if (film) AddFilm(*film, image.channels);
  image.channels.push_back({"depth.Z", ids.depth});
  const char* axes[] = {"X", "Y", "Z"};
  for (size_t axis = 0; axis < 3; ++axis) {
    image.channels.push_back({fmt::format("position.{}", axes[axis]), ids.position[axis]});
    image.channels.push_back({fmt::format("normal.{}", axes[axis]), ids.normal[axis]});
  }
  image.channels.push_back({"id.object", ids.object});
  image.channels.push_back({"id.triangle", ids.triangle});
  image.channels.push_back({"id.marker", ids.marker});

  auto& attributes = image.attributes;
  AddCamera(camera.model, attributes);
  AddUnits(film != nullptr, attributes);
  std::vector<std::string> numbered;
  for (size_t i = 0; i < body_names.size(); ++i)
    numbered.push_back(fmt::format("{}={}", i + 1, body_names[i]));
  attributes["retrolux/objects"] = JoinNames(numbered);
  attributes["retrolux/markers"] = markers.empty() ? "" : InstanceNames(marker_specs);
  attributes["retrolux/version"] = RETROLUX_VERSION;
  attributes["retrolux/camera"] = camera.model.name;
  attributes["retrolux/scene"] = info.scene_name;
  attributes["retrolux/scene_hash"] = info.scene_hash;
  attributes["retrolux/pose"] = info.pose;
  attributes["retrolux/seed"] = std::to_string(info.seed);
  attributes["retrolux/noise_seed"] = std::to_string(info.noise_seed);
  attributes["retrolux/spp"] = std::to_string(info.samples_per_pixel);
  attributes["retrolux/edge_spp"] = std::to_string(info.edge_samples_per_pixel);
  attributes["retrolux/exposure_s"] = fmt::format("{}", info.exposure_s);
  attributes["retrolux/gain_dn_e"] = fmt::format("{}", GainDnPerElectron(camera.sensor));
  attributes["retrolux/offset_dn"] = fmt::format("{}", camera.sensor.offset_dn);
  return image;
}

namespace {

nlohmann::json PixelJson(const Vec2d& px) {
  return {px.x(), px.y()};
}

nlohmann::json PixelJson(const std::optional<Vec2d>& px) {
  return px ? PixelJson(*px) : nlohmann::json(nullptr);
}

nlohmann::json ViewJson(const MarkerView& view, const PlacedMarker& marker, const MarkerSpec& spec,
                        const CameraModel& camera) {
  nlohmann::json corners = nlohmann::json::array();
  for (const Vec2d& corner : view.corners_px) corners.push_back(PixelJson(corner));
  const RigidTransform camera_from_marker =
      camera.camera_from_world * marker.marker_from_world.Inverse();
  const Mat3d& r = camera_from_marker.rotation;
  const Vec3d& t = camera_from_marker.translation;
  return {{"instance", marker.instance},
          {"name", spec.name},
          {"marker", spec.number == 0 ? nlohmann::json("standard") : nlohmann::json(spec.number)},
          {"polarity", spec.dark ? "dark" : "bright"},
          {"corners_px", corners},
          {"centroid_projected_px", PixelJson(view.centroid_projected_px)},
          {"centroid_outline_px", PixelJson(view.centroid_outline_px)},
          {"centroid_radiometric_px", PixelJson(view.centroid_radiometric_px)},
          {"visible_fraction", view.visible_fraction},
          {"incidence_deg", view.incidence_deg},
          {"distance_mm", view.distance_mm},
          {"in_frame", view.in_frame},
          {"R_camera_from_marker",
           {r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)}},
          {"t_camera_from_marker_mm", {t.x(), t.y(), t.z()}}};
}

}  // namespace

nlohmann::json TruthJson(const std::vector<CameraTruth>& cameras,
                         const std::vector<PlacedMarker>& markers,
                         const std::vector<MarkerSpec>& marker_specs, const Scene& scene,
                         const ShotInfo& info) {
  nlohmann::json truth = {{"schema", "retrolux/truth-1"},
                          {"version", RETROLUX_VERSION},
                          {"scene", info.scene_name},
                          {"scene_hash", info.scene_hash},
                          {"pose", info.pose},
                          {"pixel_origin", "center"},
                          {"units", "px, mm, deg"},
                          {"axes",
                           "pixels: x right, y down; camera: x right, y down, z forward; marker: z "
                           "along the outward normal"},
                          {"cameras", nlohmann::json::object()}};
  for (const CameraTruth& camera : cameras) {
    nlohmann::json list = nlohmann::json::array();
    for (size_t i = 0; i < camera.views.size(); ++i) {
      list.push_back(ViewJson(camera.views[i], markers[i], marker_specs[i],
                              scene.Camera(camera.camera).model));
    }
    truth["cameras"][camera.camera] = {{"markers", list}};
  }
  return truth;
}

uint64_t NoiseKey(uint64_t noise_seed, const std::string& picture) {
  return CombineKeys(noise_seed, HashBytes(picture, HashBytes("sensor noise")));
}

}  // namespace retrolux
