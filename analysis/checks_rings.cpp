// Checks of diode rings: their irradiance, and that light groups are the rings one by one.
#include <cmath>

#include "analysis/check.h"
#include "analysis/scene_tracer.h"
#include "core/sampling.h"
#include "renderer/path_tracer.h"
#include "scenes/built_in.h"
#include "scenes/mesh_shapes.h"

namespace retrolux {

namespace {

Material White() {
  return ReadMaterial("white",
                      JsonReader::FromText(R"({"type": "diffuse", "reflectance": 1.0})", "white"));
}

// Irradiance in W/m2 on a white wall at x = 0, at (0, off_axis_mm, 0), by a default ring that looks
// at the origin from `distance_mm`: pi times the radiance of the wall.
double RingIrradiance(double distance_mm, double off_axis_mm) {
  Scene scene;
  scene.materials["white"] = White();
  scene.objects.push_back(
      {"wall", RectangleMesh({0, -1000, -1000}, {0, 2000, 0}, {0, 0, 2000}), {}, "white"});
  CameraSpec camera;
  camera.model = CameraModel::FromFieldOfView(
      "camera", 64, 64, 5.0, 5.0, LookAt({distance_mm, 0, 0}, Vec3d::Zero(), Vec3d::UnitZ()));
  camera.ring = DiodeRing{};
  scene.cameras.push_back(camera);
  const SceneTracer tracer(scene);
  const Vec3f origin(200.0f, static_cast<float>(off_axis_mm), 100.0f);
  const Vec3f target(0.0f, static_cast<float>(off_axis_mm), 0.0f);
  constexpr int kSamples = 1 << 12;
  double sum = 0.0;
  for (int s = 0; s < kSamples; ++s) {
    PixelSampler sampler(Mix64(5), static_cast<uint32_t>(s));
    sum += tracer.Radiance(origin, target, sampler);
  }
  return kPi * sum / kSamples;
}

// The same as a sum over LEDs of I0 cos^m(theta) cos(beta) / d^2. All of them lie in a plane
// parallel to the wall, so that both cosines are distance / d.
double RingIrradianceInClosedForm(double distance_mm, double off_axis_mm) {
  const double m = -std::numbers::ln2 / std::log(std::cos(RadFromDeg(20.0)));
  double sum = 0.0;
  for (int i = 0; i < 24; ++i) {
    const double angle = 2.0 * kPi * i / 24.0;
    const double y = 30.0 * std::cos(angle) - off_axis_mm, z = 30.0 * std::sin(angle);
    const double d2 = distance_mm * distance_mm + y * y + z * z;
    sum += 0.05 * std::pow(distance_mm / std::sqrt(d2), m + 1.0) / (1e-6 * d2);
  }
  return sum;
}

}  // namespace

std::vector<Check> CheckRingIrradiance() {
  std::vector<Check> checks;
  for (const double distance_mm : {400.0, 1600.0}) {
    const double d2_mm2 = distance_mm * distance_mm + 900.0;
    const double m = -std::numbers::ln2 / std::log(std::cos(RadFromDeg(20.0)));
    const double on_axis =
        24 * 0.05 * std::pow(distance_mm / std::sqrt(d2_mm2), m + 1.0) / (1e-6 * d2_mm2);
    checks.push_back({fmt::format("on the axis of a ring, {:g} mm", distance_mm),
                      RingIrradiance(distance_mm, 0.0), on_axis, 1e-3 * on_axis, "W/m2",
                      "n I0 cos^(m+1) / (z^2 + r^2); 0.1 % for the LEDs' discs and Monte Carlo"});
    for (const double off_axis_mm : {40.0, 200.0}) {
      const double expected = RingIrradianceInClosedForm(distance_mm, off_axis_mm);
      checks.push_back(
          {fmt::format("{:g} mm off the axis of a ring, {:g} mm", off_axis_mm, distance_mm),
           RingIrradiance(distance_mm, off_axis_mm), expected, 1e-3 * expected, "W/m2",
           "sum over the LEDs of I0 cos^m(theta) cos(beta) / d^2; 0.1 % as on the axis"});
    }
  }
  return checks;
}

std::vector<Check> CheckLightGroups() {
  // The room with all rings on, and with each of them alone: the same geometry, other random
  // numbers. Pixels of the mask.
  const Scene scene = CtRoom();
  const RayScene rays(scene);
  const CameraSpec& camera = scene.cameras[0];
  const std::vector<PlacedMarker> no_markers;
  constexpr int kSide = 16;
  const auto render = [&](RingChoice choice, const std::string& own, uint64_t seed) {
    const Lights lights(scene, rays, choice, own);
    const CameraResponse response(camera, lights.Spectra(), 5e-3);
    TraceOptions options;
    options.seed = seed;
    const PathTracer tracer(scene, rays, lights, response, no_markers, options);
    std::vector<GroupValues> pixels;
    for (int i = 0; i < kSide * kSide; ++i)
      pixels.push_back(
          tracer.EstimatePixel(220 + 12 * (i % kSide), 140 + 12 * (i / kSide)).electrons);
    return pixels;
  };
  const std::vector<GroupValues> joint = render(RingChoice::kAll, "", 1);
  const int ambient = static_cast<int>(scene.cameras.size());  // the last group
  std::vector<Check> checks;
  const auto add = [&](const std::string& name, const std::vector<double>& differences,
                       double scale) {
    double sum = 0.0, sum2 = 0.0;
    for (const double difference : differences) {
      sum += difference / scale;
      sum2 += std::pow(difference / scale, 2);
    }
    const auto n = static_cast<double>(differences.size());
    const double error = std::sqrt((sum2 - sum * sum / n) / (n * (n - 1.0)));
    checks.push_back({name, sum / n, 0.0, 4.0 * error, "",
                      fmt::format("alone less in the joint render, over the joint signal; 4 "
                                  "standard errors of {:g} pixels",
                                  n)});
  };
  std::vector<double> sums(joint.size(), 0.0);
  double scale = 0.0;
  for (const GroupValues& pixel : joint)
    scale += static_cast<double>(pixel.sum()) / static_cast<double>(joint.size());
  for (int ring = 0; ring < ambient; ++ring) {
    const std::string& name = scene.cameras[static_cast<size_t>(ring)].model.name;
    const std::vector<GroupValues> alone =
        render(RingChoice::kOwn, name, 2 + static_cast<uint64_t>(ring));
    std::vector<double> differences;
    for (size_t i = 0; i < joint.size(); ++i) {
      differences.push_back(static_cast<double>(alone[i][0] - joint[i][ring]));
      sums[i] += differences.back();
    }
    add("ring of " + name, differences, scale);
  }
  add("sum of the rings", sums, scale);
  return checks;
}

}  // namespace retrolux
