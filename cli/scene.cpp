// retrolux scene list | show NAME_OR_FILE | export NAME_OR_FILE --out DIR
#include <fmt/format.h>

#include <cmath>

#include "cli/commands.h"
#include "scenes/built_in.h"
#include "scenes/scene_json.h"

namespace retrolux::cli {

namespace {

struct SceneOptions {
  std::string scene;
  std::string out;
};

int RunList(const GlobalOptions& global) {
  nlohmann::json summary = {{"scenes", nlohmann::json::array()}};
  std::string text;
  for (const BuiltInEntry& entry : BuiltInScenes()) {
    summary["scenes"].push_back({{"name", entry.name}, {"description", entry.description}});
    text += fmt::format("{}{:<12} {}", text.empty() ? "" : "\n", entry.name, entry.description);
  }
  PrintResult(global, summary, text);
  return kExitGood;
}

// To a tenth, without the sign of a rounded zero.
std::string Text(const Vec3d& v) {
  const Vec3d r = (v * 10.0).array().round() / 10.0 + 0.0;
  return fmt::format("({:.1f}, {:.1f}, {:.1f})", r.x(), r.y(), r.z());
}

nlohmann::json Numbers(const Vec3d& v) {
  return {v.x(), v.y(), v.z()};
}

// A description in two forms: lines to read, and the same as JSON.
struct Description {
  nlohmann::json summary = nlohmann::json::object();
  std::string text;

  void Line(const std::string& line) { text += (text.empty() ? "" : "\n") + line; }
};

void DescribeObjects(const Scene& scene, Description& to) {
  to.Line("objects");
  to.summary["objects"] = nlohmann::json::array();
  for (const SceneObject& object : scene.objects) {
    const size_t triangles = object.mesh.triangles.size();
    const double area_mm2 = object.mesh.Area();
    to.Line(fmt::format("  {:<24} {:>8} triangles {:>13.0f} mm2  {}{}", object.name, triangles,
                        area_mm2, object.material,
                        object.moves_with_pose ? ", moves with the pose" : ""));
    to.summary["objects"].push_back({{"name", object.name},
                                     {"triangles", triangles},
                                     {"area_mm2", area_mm2},
                                     {"material", object.material},
                                     {"moves_with_pose", object.moves_with_pose}});
  }
}

double AngleDeg(const Vec3d& a, const Vec3d& b) {
  return DegFromRad(std::atan2(a.cross(b).norm(), a.dot(b)));
}

// The camera that makes the smallest angle with this one at the origin.
std::optional<std::pair<std::string, double>> NearestCamera(const Scene& scene, size_t index) {
  std::optional<std::pair<std::string, double>> nearest;
  const Vec3d eye = scene.cameras[index].model.Centre();
  for (size_t i = 0; i < scene.cameras.size(); ++i) {
    if (i == index) continue;
    const double angle_deg = AngleDeg(eye, scene.cameras[i].model.Centre());
    if (!nearest || angle_deg < nearest->second)
      nearest.emplace(scene.cameras[i].model.name, angle_deg);
  }
  return nearest;
}

std::string RingText(const DiodeRing& ring) {
  return fmt::format(
      "ring of {} LEDs, radius {:g} mm, {:g} nm (fwhm {:g}), half angle {:g} deg, {:g} W/sr each",
      ring.count, ring.radius_mm, ring.peak_nm, ring.fwhm_nm, ring.half_angle_deg,
      ring.radiant_intensity_w_sr);
}

void DescribeCamera(const Scene& scene, size_t index, Description& to) {
  const CameraSpec& camera = scene.cameras[index];
  const CameraModel& model = camera.model;
  const Vec3d eye = model.Centre();
  const double fov_h_deg = 2.0 * DegFromRad(std::atan(0.5 * model.width / model.fx));
  const double fov_v_deg = 2.0 * DegFromRad(std::atan(0.5 * model.height / model.fy));
  to.Line(fmt::format(
      "  {:<14} at {} mm, {:.1f} mm from the origin, {} x {} px, {:.2f} x {:.2f} deg", model.name,
      Text(eye), eye.norm(), model.width, model.height, fov_h_deg, fov_v_deg));
  to.Line(fmt::format(
      "    lens f = {:g} mm, f/{:g}; {}; {}", camera.lens.focal_length_mm, camera.lens.f_number,
      camera.filter ? fmt::format("filter {:g} nm, {:g} nm wide", camera.filter->centre_nm,
                                  camera.filter->bandwidth_nm)
                    : "no filter",
      camera.ring ? RingText(*camera.ring) : "no ring"));
  nlohmann::json summary = {{"name", model.name},
                            {"position_mm", Numbers(eye)},
                            {"distance_mm", eye.norm()},
                            {"forward", Numbers(model.Forward())},
                            {"size_px", {model.width, model.height}},
                            {"field_of_view_deg", {fov_h_deg, fov_v_deg}},
                            {"ring", camera.ring.has_value()}};
  if (const auto nearest = NearestCamera(scene, index)) {
    to.Line(fmt::format("    nearest camera, seen from the origin: {} at {:.2f} deg",
                        nearest->first, nearest->second));
    summary["nearest_camera"] = {{"name", nearest->first}, {"angle_deg", nearest->second}};
  }
  to.summary["cameras"].push_back(std::move(summary));
}

void DescribeMarkers(const Scene& scene, Description& to) {
  to.Line(scene.markers.empty() ? "markers: none" : "markers");
  to.summary["markers"] = nlohmann::json::array();
  for (const MarkerSpec& marker : scene.markers) {
    const std::string shape = scene.marker_set->ByNumber(marker.number).name;
    to.Line(fmt::format("  {:<14} number {} ({}) on {} near {} mm, roll {:g} deg, {}{}",
                        marker.name, marker.number, shape, marker.object, Text(marker.at),
                        marker.roll_deg, marker.material, marker.dark ? ", dark on bright" : ""));
    to.summary["markers"].push_back({{"name", marker.name},
                                     {"number", marker.number},
                                     {"shape", shape},
                                     {"object", marker.object},
                                     {"at_mm", Numbers(marker.at)},
                                     {"roll_deg", marker.roll_deg}});
  }
}

void DescribeLightAndPoses(const Scene& scene, Description& to) {
  to.Line(scene.poses.empty() ? "poses: none" : "poses");
  to.summary["poses"] = nlohmann::json::array();
  for (const Pose& pose : scene.poses) {
    to.Line(fmt::format("  {:<14} shifted by {} mm", pose.name, Text(pose.translation)));
    to.summary["poses"].push_back(
        {{"name", pose.name}, {"translation_mm", Numbers(pose.translation)}});
  }
  const AmbientLight& ambient = scene.ambient;
  to.Line(fmt::format("ambient light: {} panels of {:g} W/(m2 sr), environment {:g} W/(m2 sr), {}",
                      ambient.panels.size(), ambient.radiance_w_m2_sr, ambient.environment_w_m2_sr,
                      ambient.spectrum));
  to.summary["ambient"] = {{"panels", ambient.panels.size()},
                           {"radiance_w_m2_sr", ambient.radiance_w_m2_sr},
                           {"environment_w_m2_sr", ambient.environment_w_m2_sr}};
  const Exposure& exposure = scene.exposure;
  to.Line(exposure.time_s > 0.0 ? fmt::format("exposure: {:g} s", exposure.time_s)
                                : fmt::format("exposure: auto, so that a frontal marker of {} at "
                                              "{:g} mm sits at {:g} % of full scale",
                                              exposure.marker_material, exposure.distance_mm,
                                              100.0 * exposure.fraction));
  to.summary["exposure"] = {
      {"time_s", exposure.time_s > 0.0 ? nlohmann::json(exposure.time_s) : nlohmann::json("auto")}};
}

int RunShow(const GlobalOptions& global, const SceneOptions& options) {
  const Scene scene = LoadScene(options.scene);
  const std::string hash = SceneHash(scene);
  Description description;
  description.summary["name"] = scene.name;
  description.summary["hash"] = hash;
  description.Line(fmt::format("scene {} (hash {})", scene.name, hash));
  DescribeObjects(scene, description);
  description.Line("cameras");
  for (size_t i = 0; i < scene.cameras.size(); ++i) DescribeCamera(scene, i, description);
  DescribeMarkers(scene, description);
  DescribeLightAndPoses(scene, description);
  PrintResult(global, description.summary, description.text);
  return kExitGood;
}

int RunExport(const GlobalOptions& global, const SceneOptions& options) {
  const Scene scene = LoadScene(options.scene);
  ExportScene(scene, options.out);
  const std::string file = (std::filesystem::path(options.out) / "scene.json").string();
  PrintResult(global, {{"scene", scene.name}, {"hash", SceneHash(scene)}, {"file", file}},
              fmt::format("scene {} written to {}", scene.name, file));
  return kExitGood;
}

}  // namespace

void SetUpScene(CLI::App& app, const GlobalOptions& global, Run& run) {
  const auto options = std::make_shared<SceneOptions>();
  CLI::App* scene = app.add_subcommand("scene", "List, describe or write out scenes");

  CLI::App* list = scene->add_subcommand("list", "The built-in scenes");
  list->callback([&global, &run] { run = [&global] { return RunList(global); }; });

  CLI::App* show = scene->add_subcommand("show", "What is in a scene");
  show->add_option("SCENE", options->scene, "A built-in scene, a scene.json, or its folder")
      ->required();
  show->callback(
      [&global, &run, options] { run = [&global, options] { return RunShow(global, *options); }; });

  CLI::App* write =
      scene->add_subcommand("export", "Write a scene as scene.json and .glb (Blender reads it)");
  write->add_option("SCENE", options->scene, "A built-in scene, a scene.json, or its folder")
      ->required();
  write->add_option("--out", options->out, "The folder to write to")->required()->type_name("DIR");
  write->callback([&global, &run, options] {
    run = [&global, options] { return RunExport(global, *options); };
  });
}

}  // namespace retrolux::cli
