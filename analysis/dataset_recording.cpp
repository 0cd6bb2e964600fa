#include "analysis/dataset_recording.h"

#include "renderer/exposure.h"
#include "scenes/scene_json_sensor.h"

namespace retrolux {

namespace {

// Of the mask's surface before its origin, along the line of sight.
constexpr double kSurfaceBefore_mm = 90.0;

double DistanceToMask_mm(const Scene& scene, const CameraModel& camera) {
  const Vec3d origin = scene.Object(kMaskObject).world_from_object.translation;
  return (camera.Centre() - origin).norm() - kSurfaceBefore_mm;
}

// Focuses the lens nearer than d, so that a point there becomes a disc of the diameter c on the
// sensor: c = A f (d - s) / (d (s - f)), solved for s (thin-lens formula, A the aperture).
void Defocus(CameraSpec& camera, double distance_mm, double blur_px) {
  const double f = camera.lens.focal_length_mm;
  const double aperture = 2.0 * camera.lens.ApertureRadius_mm();
  const double disc_mm = blur_px * f / camera.model.fx;
  camera.lens.focus_distance_mm =
      distance_mm * f * (aperture + disc_mm) / (aperture * f + disc_mm * distance_mm);
}

// The time for the camera that records first; the others share it.
double NominalExposure_s(const Scene& scene, const std::string& camera, double full_scales) {
  Scene nominal = scene;
  nominal.exposure.time_s = 0.0;
  nominal.exposure.fraction = 1.0;
  nominal.exposure.distance_mm = DistanceToMask_mm(scene, scene.Camera(camera).model);
  return full_scales * ExposureSeconds(nominal, nominal.Camera(camera));
}

}  // namespace

void DrawRecording(const RecordingRange& range, const SceneDraw& draw, DrawnScene& drawn) {
  Scene& scene = drawn.scene;
  const std::string& sensor = range.sensor.Draw(draw, "sensor");
  const double k1 = range.distortion_k1.Draw(draw, "distortion k1");
  const bool defocused = draw.Chance("defocused", range.defocused);
  const double blur_px = range.blur_px.Draw(draw, "blur");
  for (CameraSpec& camera : scene.cameras) {
    if (sensor != "default") camera.sensor = SensorPreset(sensor);
    camera.model.distortion = Distortion(k1, 0.0, 0.0, 0.0, 0.0);
    if (range.size_px[0] > 0)
      camera.model = camera.model.Resized(range.size_px[0], range.size_px[1]);
    if (defocused) Defocus(camera, DistanceToMask_mm(scene, camera.model), blur_px);
  }
  const double exposure = range.exposure.Draw(draw, "exposure");
  scene.exposure.time_s = NominalExposure_s(scene, drawn.cameras.front(), exposure);
  const double power = range.diode_power.Draw(draw, "diode power");
  for (CameraSpec& camera : scene.cameras) camera.ring->radiant_intensity_w_sr *= power;
  const double ambient = range.ambient.Draw(draw, "ambient");
  scene.ambient.radiance_w_m2_sr *= ambient;
  scene.ambient.environment_w_m2_sr *= ambient;
  if (range.rings.Draw(draw, "rings") == "all") drawn.rings = RingChoice::kAll;
  drawn.nuisances.update({{"sensor", sensor},
                          {"distortion_k1", k1},
                          {"blur_px", defocused ? blur_px : 0.0},
                          {"exposure_full_scales", exposure},
                          {"exposure_s", scene.exposure.time_s},
                          {"diode_power", power},
                          {"ambient", ambient},
                          {"rings", drawn.rings == RingChoice::kAll ? "all" : "own"}});
}

}  // namespace retrolux
