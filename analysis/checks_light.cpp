// Checks of the light transport: furnace, diode, fall-off over the field, exposure.
#include <cmath>

#include "analysis/check.h"
#include "analysis/measuring_bench.h"
#include "analysis/scene_tracer.h"
#include "core/sampling.h"
#include "renderer/exposure.h"
#include "renderer/film.h"
#include "scenes/mesh_shapes.h"

namespace retrolux {

namespace {

// Mean radiance of a sphere of a white material in an environment of radiance 1, over its whole
// visible disc.
double FurnaceRadiance(const std::string& material_json, int samples) {
  Scene scene;
  scene.materials["white"] = ReadMaterial("white", JsonReader::FromText(material_json, "white"));
  scene.objects.push_back({"sphere", EllipsoidMesh(Vec3d::Constant(100.0), 5), {}, "white"});
  scene.ambient.environment_w_m2_sr = 1.0;
  CameraSpec camera;
  camera.model = CameraModel::FromFieldOfView("camera", 64, 64, 7.0, 7.0,
                                              LookAt({1600, 0, 0}, Vec3d::Zero(), Vec3d::UnitZ()));
  scene.cameras.push_back(camera);
  const SceneTracer tracer(scene);
  const Vec3f origin = camera.model.Centre().cast<float>();
  double sum = 0.0;
  for (int s = 0; s < samples; ++s) {
    PixelSampler sampler(Mix64(11), static_cast<uint32_t>(s));
    const Vec2f disc = SampleUnitDisc(sampler.Next2D());
    // Through a disc that is the sphere's silhouette, a little smaller than its great circle.
    const Vec3f target(0.0f, 99.0f * disc.x(), 99.0f * disc.y());
    sum += tracer.Radiance(origin, target, sampler);
  }
  return sum / samples;
}

}  // namespace

std::vector<Check> CheckWhiteFurnace() {
  constexpr int kSamples = 1 << 19;
  const std::string source =
      "a surface that absorbs nothing shows the radiance of its surroundings; Russian roulette and "
      "the scatter of the weights leave a standard error of 0.03 to 0.04 %";
  return {{"diffuse, reflectance 1",
           FurnaceRadiance(R"({"type": "diffuse", "reflectance": 1.0})", kSamples), 1.0, 1e-3, "",
           source},
          {"rough coat over diffuse, reflectance 1",
           FurnaceRadiance(R"({"type": "coated_diffuse", "reflectance": 1.0, "roughness": 0.15})",
                           kSamples),
           1.0, 1e-3, "", source},
          {"coat of roughness 0.5 over diffuse, reflectance 1",
           FurnaceRadiance(R"({"type": "coated_diffuse", "reflectance": 1.0, "roughness": 0.5})",
                           kSamples),
           1.0, 1e-3, "", source},
          {"metal that reflects all light, roughness 0.3",
           FurnaceRadiance(R"({"type": "conductor", "reflectance": 1.0, "roughness": 0.3})",
                           4 * kSamples),
           1.0, 1e-3, "", source},
          {"metal that reflects all light, roughness 1",
           FurnaceRadiance(R"({"type": "conductor", "reflectance": 1.0, "roughness": 1.0})",
                           4 * kSamples),
           1.0, 1e-3, "", source},
          {"rough diffuse, reflectance 1, roughness 1",
           FurnaceRadiance(R"({"type": "rough_diffuse", "reflectance": 1.0, "roughness": 1.0})",
                           4 * kSamples),
           1.0, 1e-3, "", source},
          {"retro-reflective Beckmann lobe of albedo 1, too narrow to lose light",
           FurnaceRadiance(R"({"type": "retroreflector", "diffuse_reflectance": 0.0, "ior": 1.0,
                               "lobes": [{"roughness": 0.002, "albedo": 1.0,
                                          "distribution": "beckmann"}]})",
                           kSamples),
           1.0, 1e-3, "", source}};
}

std::vector<Check> CheckDiodeIrradiance() {
  // A white diffuse patch has radiance E / pi. I(theta) = I0 cos^m theta with m = -ln 2 / ln
  // cos(half angle), so that at 20 degrees off a 20 degree LED's axis the intensity is I0 / 2 by
  // definition.
  MeasuringBench bench;
  std::vector<Check> checks;
  const auto add = [&](const std::string& name, double expected_w_m2) {
    const MeasuringBench::Radiance radiance = bench.Measure(1 << 12, 3);
    checks.push_back({name, radiance.mean * kPi, expected_w_m2, 2e-3 * expected_w_m2, "W/m2",
                      "E = I(theta) cos(beta) / d^2"});
  };
  bench.lamp_position = {1600, 0, 200};
  const double d2_m2 = 1.6 * 1.6 + 0.2 * 0.2;
  add("on the axis of the diode", 0.05 * (1.6 / std::sqrt(d2_m2)) / d2_m2);
  // The axis points 20 degrees past the patch.
  bench.lamp_position = {1600, 0, 0};
  bench.camera_position = {1600, 0, 300};
  bench.lamp_target = {0, 1600 * std::tan(RadFromDeg(20.0)), 0};
  add("20 degrees off the axis of the diode", 0.5 * 0.05 / (1.6 * 1.6));
  bench.lamp_position = Vec3d(std::cos(RadFromDeg(60.0)), std::sin(RadFromDeg(60.0)), 0) * 1600.0;
  bench.lamp_target = Vec3d::Zero();
  add("60 degrees incidence", 0.05 * 0.5 / (1.6 * 1.6));
  return checks;
}

namespace {

Material White() {
  return ReadMaterial("white",
                      JsonReader::FromText(R"({"type": "diffuse", "reflectance": 1.0})", "white"));
}

}  // namespace

std::vector<Check> CheckCosFourth() {
  // A white wall that fills the field, in even surroundings, has one radiance everywhere.
  Scene scene;
  scene.materials["white"] = White();
  scene.objects.push_back(
      {"wall", RectangleMesh({0, -2000, -2000}, {0, 4000, 0}, {0, 0, 4000}), {}, "white"});
  scene.ambient.environment_w_m2_sr = 1.0;
  std::vector<Check> checks;
  struct Field {
    double h_deg, v_deg;
  };
  for (const Field& field : {Field{12.18, 9.15}, Field{50.0, 38.0}}) {
    CameraSpec camera;
    camera.model =
        CameraModel::FromFieldOfView("camera", 641, 481, field.h_deg, field.v_deg,
                                     LookAt({1600, 0, 0}, Vec3d::Zero(), Vec3d::UnitZ()));
    scene.cameras = {camera};
    TraceOptions options;
    options.samples_per_pixel = 1 << 14;
    const SceneTracer tracer(scene, options);
    const auto level = [&](int x, int y) {
      return static_cast<double>(tracer.EstimatePixel(x, y).electrons.sum());
    };
    const double centre = level(320, 240);
    const std::tuple<const char*, int, int> places[] = {
        {"side", 640, 240}, {"top", 320, 0}, {"corner", 640, 0}};
    for (const auto& [name, x, y] : places) {
      // tan^2 of the field angle from the field of view and the place in the picture.
      const double u = (x - 320) / 320.5 * std::tan(RadFromDeg(0.5 * field.h_deg)),
                   v = (y - 240) / 240.5 * std::tan(RadFromDeg(0.5 * field.v_deg));
      const double expected = 1.0 / std::pow(1.0 + u * u + v * v, 2);
      checks.push_back({fmt::format("{} of a field of {:g} x {:g} degrees over its centre", name,
                                    field.h_deg, field.v_deg),
                        level(x, y) / centre, expected, 2e-4, "",
                        "cos^4 of the field angle, (1 + tan^2)^-2; stratified Russian roulette may "
                        "be a sample of 16,384 off in each of the two pixels, 1.3e-4"});
    }
  }
  return checks;
}

std::vector<Check> CheckExposure() {
  // A flat frontal marker in front of a ring-lit camera at 1600 mm must sit at 70 % of 255 DN: the
  // exposure is derived by quadrature over the LEDs and wavelengths, here the whole chain renders
  // it.
  Scene scene;
  scene.name = "exposure";
  scene.UseMaterial("retro_bead");
  scene.objects.push_back(
      {"marker", RectangleMesh({0, -10, -10}, {0, 20, 0}, {0, 0, 20}), {}, "retro_bead"});
  scene.cameras.push_back(OvalScene().cameras[0]);
  const CameraSpec& camera = scene.cameras[0];
  const double exposure_s = ExposureSeconds(scene, camera);
  const RayScene rays(scene);
  const Lights lights(scene, rays, RingChoice::kAll, camera.model.name);
  const CameraResponse response(camera, lights.Spectra(), exposure_s);
  const std::vector<PlacedMarker> no_markers;
  TraceOptions options;
  options.samples_per_pixel = 256;
  const PathTracer tracer(scene, rays, lights, response, no_markers, options);
  double electrons = 0.0;
  constexpr int kSide = 8;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x)
      electrons += static_cast<double>(tracer.EstimatePixel(316 + x, 236 + y).electrons.sum());
  }
  electrons = electrons / (kSide * kSide) + camera.sensor.dark_current_e_s * exposure_s;
  const double dn = camera.sensor.offset_dn + GainDnPerElectron(camera.sensor) * electrons;
  return {{"level of a frontal marker at 1600 mm", dn, 0.7 * 255.0, 0.01 * 0.7 * 255.0, "DN",
           "exposure.fraction of full scale; 1 % for the LEDs' discs and Monte Carlo noise"}};
}

}  // namespace retrolux
