// Checks of the lens in rendered pictures: blur out of focus, and the centroids of a tilted disc.
#include <cmath>

#include "analysis/check.h"
#include "analysis/scene_tracer.h"
#include "renderer/film.h"
#include "renderer/marker_truth.h"
#include "scenes/mesh_shapes.h"
#include "scenes/scene_parts.h"

namespace retrolux {

namespace {

struct Spot {
  Vec2d centroid_px = Vec2d::Zero();
  double variance_px2 = 0.0;  // mean of those along the two axes
};

// Moments of the electrons in a square window of the picture.
template <typename Tracer>
Spot MeasureSpot(const Tracer& tracer, const Vec2d& middle, int half) {
  double sum = 0.0, sum2 = 0.0;
  Vec2d first = Vec2d::Zero();
  for (int y = -half; y <= half; ++y) {
    for (int x = -half; x <= half; ++x) {
      const Vec2d px(std::round(middle.x()) + x, std::round(middle.y()) + y);
      const auto value = static_cast<double>(
          tracer.EstimatePixel(static_cast<int>(px.x()), static_cast<int>(px.y())).electrons.sum());
      sum += value;
      first += value * px;
      sum2 += value * px.squaredNorm();
    }
  }
  const Vec2d centroid = first / sum;
  return {centroid, 0.5 * (sum2 / sum - centroid.squaredNorm())};
}

// The thesis's camera at the origin's side, at f/2 focused at 1600 mm, and a small bright square
// that faces it `depth_mm` away.
double BlurDiameter_mm(double depth_mm, double side_mm) {
  Scene scene;
  CameraSpec camera = ThesisCamera("camera", {depth_mm, 0, 0}, Vec3d::UnitZ());
  camera.ring.reset();
  camera.lens.focal_length_mm = 29.448;
  camera.lens.f_number = 2.0;
  camera.lens.focus_distance_mm = 1600.0;
  scene.cameras.push_back(camera);
  scene.ambient.radiance_w_m2_sr = 1.0;
  scene.ambient.panels.push_back(
      {{0, -0.5 * side_mm, -0.5 * side_mm}, {0, side_mm, 0}, {0, 0, side_mm}});
  TraceOptions options;
  options.samples_per_pixel = 1 << 14;
  const SceneTracer tracer(scene, options);
  const Spot spot = MeasureSpot(tracer, {camera.model.cx, camera.model.cy}, 5);
  // Variances add: the disc's (c / 4)^2 an axis, the square's and the pixel's side^2 / 12.
  const double side_px = side_mm * camera.model.fx / depth_mm;
  const double disc_px2 = spot.variance_px2 - (side_px * side_px + 1.0) / 12.0;
  return 4.0 * std::sqrt(disc_px2) * camera.lens.PrincipalDistance_mm() / camera.model.fx;
}

}  // namespace

std::vector<Check> CheckBlur() {
  // The disc of confusion has the diameter c = (f^2 / N) |d - s| / (d (s - f)). It is not quite
  // even: what comes through the aperture at radius r falls on the sensor with cos^4 = 1 / (1 + r^2
  // / s'^2)^2. With q = a^2 / s'^2 (a the aperture's radius) the second moment of an even disc,
  // half its radius squared, becomes  m = (1 + q) (ln(1 + q) - q / (1 + q)) / q^2  of its radius
  // squared.
  const double f = 29.448, s = 1600.0, f_number = 2.0;
  const double q = std::pow(0.5 * f / f_number * (s - f) / (s * f), 2);
  const double moment = (1.0 + q) * (std::log1p(q) - q / (1.0 + q)) / (q * q);
  std::vector<Check> checks;
  for (const double depth_mm : {1400.0, 1950.0}) {
    const double even = f * f / f_number * std::abs(depth_mm - s) / (depth_mm * (s - f));
    const double expected_um = 1e3 * even * std::sqrt(2.0 * moment);
    checks.push_back({fmt::format("blur of a point at {:g} mm, f/2 focused at 1600 mm", depth_mm),
                      1e3 * BlurDiameter_mm(depth_mm, 1.0), expected_um, 5e-3 * expected_um, "um",
                      "thin lens: (f^2 / N) |d - s| / (d (s - f)), less 0.9 % for the cos^4 inside "
                      "the camera; from the second moment of the rendered spot, 0.5 % for its "
                      "sampling"});
  }
  return checks;
}

std::vector<Check> CheckCentroids() {
  // A disc of radius R whose normal is tilted by theta about the picture's y axis, its middle on
  // the optical axis at the distance D (in front of the pinhole):
  //   projected centre     on the axis
  //   projected outline    an ellipse with its middle at x = -+f R^2 sin cos / (D^2 - R^2 sin^2)
  //   light                of even radiance: the ellipse's, but for cos^4 of the field (1e-5 of the
  //                        axis at these sizes)
  constexpr double kDistance_mm = 400.0;
  std::vector<Check> checks;
  for (const double tilt_deg : {30.0, 60.0}) {
    Scene scene;
    scene.UseMaterial("black");
    const double theta = RadFromDeg(tilt_deg);
    const double c = std::cos(theta), s = std::sin(theta);
    // A plate whose normal (cos, sin, 0) is turned away from the camera on the x axis.
    scene.objects.push_back(
        {"plate",
         RectangleMesh(Vec3d(30 * s, -30 * c, -30), Vec3d(-60 * s, 60 * c, 0), Vec3d(0, 0, 60)),
         {},
         "black"});
    scene.materials["white"] = ReadMaterial(
        "white", JsonReader::FromText(R"({"type": "diffuse", "reflectance": 1.0})", "white"));
    scene.markers.push_back({"disc", 0, "plate", Vec3d::Zero(), 0.0, "white"});
    scene.ambient.environment_w_m2_sr = 1.0;
    CameraSpec camera = ThesisCamera("camera", {kDistance_mm, 0, 0}, Vec3d::UnitZ());
    camera.ring.reset();
    // The middle of the picture between two pixels' centres, as it is.
    scene.cameras.push_back(camera);
    const RayScene rays(scene);
    const std::vector<PlacedMarker> markers = PlaceMarkers(scene);
    const Lights lights(scene, rays, RingChoice::kAll, "camera");
    const CameraResponse response(camera, lights.Spectra(), 1e-3);
    TraceOptions options;
    options.samples_per_pixel = 256;
    options.max_surfaces = 1;
    const PathTracer tracer(scene, rays, lights, response, markers, options);
    const MarkerView view = ViewMarker(SampleMarkerSurface(rays, markers[0]), rays, camera.model);
    const Spot spot = MeasureSpot(tracer, {camera.model.cx, camera.model.cy}, 64);
    const double radius = DefaultMarkerSet().ByNumber(0).Radius();
    // World y is picture x turned round: the camera looks along -x with z up, so its x is +y.
    const double shift = camera.model.fx * radius * radius * s * c /
                         (kDistance_mm * kDistance_mm - radius * radius * s * s);
    const auto add = [&](const char* what, double u, double expected, const char* source) {
      checks.push_back({fmt::format("disc tilted by {:g} degrees: {}", tilt_deg, what),
                        u - camera.model.cx, expected, 0.005, "px", source});
    };
    add("projected centre", view.centroid_projected_px->x(), 0.0,
        "the disc's middle is on the axis");
    add("centroid of the projected outline", view.centroid_outline_px->x(), -shift,
        "middle of the ellipse: f R^2 sin cos / (D^2 - R^2 sin^2) towards the nearer half");
    add("centroid of the light", spot.centroid_px.x(), -shift,
        "even radiance: the ellipse's middle");
  }
  return checks;
}

}  // namespace retrolux
