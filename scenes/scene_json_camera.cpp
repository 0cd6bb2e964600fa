#include "scenes/scene_json_camera.h"

#include <cmath>

#include "scenes/scene_json_sensor.h"
#include "scenes/scene_json_values.h"

namespace retrolux {

namespace {

constexpr int kMaxPixels = 32768;

Lens ReadLens(JsonReader json) {
  Lens lens;
  lens.focal_length_mm = json.Number("focal_length_mm", 0.1, 10000.0, lens.focal_length_mm);
  lens.f_number = json.Number("f_number", 0.5, 256.0, lens.f_number);
  lens.transmission = json.Number("transmission", 0.001, 1.0, lens.transmission);
  lens.focus_distance_mm = json.Number("focus_distance_mm", 0.0, 1e9, lens.focus_distance_mm);
  if (lens.focus_distance_mm > 0.0 && lens.focus_distance_mm <= lens.focal_length_mm) {
    json.Fail(fmt::format("focus_distance_mm {:g}", lens.focus_distance_mm),
              fmt::format("more than the focal length of {:g} mm, or 0 for a pinhole",
                          lens.focal_length_mm));
  }
  lens.stop_radius_mm = json.Number("stop_radius_mm", 0.0, 10000.0, lens.stop_radius_mm);
  lens.stop_distance_mm = json.Number("stop_distance_mm", 0.0, 10000.0, lens.stop_distance_mm);
  if (lens.stop_radius_mm > 0.0 && lens.stop_radius_mm < lens.ApertureRadius_mm()) {
    json.Fail(fmt::format("stop_radius_mm {:g}", lens.stop_radius_mm),
              fmt::format("at least the aperture's radius, {:g} mm, or 0 for no stop",
                          lens.ApertureRadius_mm()));
  }
  lens.diffraction = json.Bool("diffraction", lens.diffraction);
  lens.veiling_glare = json.Number("veiling_glare", 0.0, 0.5, lens.veiling_glare);
  json.Finish();
  return lens;
}

DiodeRing ReadRing(JsonReader json) {
  DiodeRing ring;
  ring.count = json.Integer("count", 1, 10000, ring.count);
  ring.radius_mm = json.Number("radius_mm", 0.0, 10000.0, ring.radius_mm);
  ring.peak_nm = json.Number("peak_nm", kMinWavelength_nm, kMaxWavelength_nm, ring.peak_nm);
  ring.fwhm_nm = json.Number("fwhm_nm", 1.0, 500.0, ring.fwhm_nm);
  ring.half_angle_deg = json.Number("half_angle_deg", 1.0, 89.0, ring.half_angle_deg);
  ring.radiant_intensity_w_sr =
      json.Number("radiant_intensity_w_sr", 0.0, 1e6, ring.radiant_intensity_w_sr);
  ring.led_radius_mm = json.Number("led_radius_mm", 0.01, 1000.0, ring.led_radius_mm);
  if (json.Has("spectrum_shape"))
    ring.spectrum_shape = LedShapeOf(json.Choice("spectrum_shape", LedShapeNames()));
  ring.junction_temperature_c =
      json.Number("junction_temperature_c", -60.0, 150.0, ring.junction_temperature_c);
  ring.peak_drift_nm_k = json.Number("peak_drift_nm_k", -2.0, 2.0, ring.peak_drift_nm_k);
  // At most 0.75, so that some light is left at 150 C.
  ring.intensity_drift_percent_k =
      json.Number("intensity_drift_percent_k", -0.75, 0.75, ring.intensity_drift_percent_k);
  json.Finish();
  return ring;
}

// Either R and t_mm (camera_from_world) or eye_mm, look_at_mm and up.
RigidTransform ReadCameraPose(JsonReader& json) {
  const bool exact = json.Has("R") || json.Has("t_mm");
  const bool looks = json.Has("eye_mm") || json.Has("look_at_mm") || json.Has("up");
  if (exact == looks)
    json.Fail(exact ? "both R, t_mm and eye_mm, look_at_mm, up" : "no pose",
              "either R and t_mm, or eye_mm, look_at_mm and up");
  if (exact) return {Rotation(json.Child("R")), Position(json, "t_mm")};
  const Vec3d eye = Position(json, "eye_mm"), target = Position(json, "look_at_mm"),
              up = json.Vector3("up");
  const double sine = (target - eye).normalized().cross(up.normalized()).norm();
  if (!(sine > 1e-6))
    json.Fail("an 'up' along the line of sight, or no line of sight",
              "eye_mm apart from look_at_mm, and another direction for 'up'");
  return LookAt(eye, target, up);
}

// k1, k2, p1, p2, k3 (OpenCV).
Distortion ReadDistortion(const JsonReader& json) {
  const std::vector<double> d = json.Numbers(5);
  return {d[0], d[1], d[2], d[3], d[4]};
}

// Either camera_matrix or field_of_view_deg.
CameraModel ReadCameraModel(JsonReader& json) {
  CameraModel model;
  model.name = json.String("name");
  model.camera_from_world = ReadCameraPose(json);
  if (json.Has("size")) {
    const JsonReader size = json.Child("size");
    for (const double side : size.Numbers(2)) {
      if (side < 1 || side > kMaxPixels || side != std::floor(side)) {
        size.Fail(fmt::format("{} pixels", side),
                  fmt::format("whole numbers from 1 to {}", kMaxPixels));
      }
    }
    model.width = static_cast<int>(size.Numbers(2)[0]);
    model.height = static_cast<int>(size.Numbers(2)[1]);
  }
  if (json.Has("camera_matrix") == json.Has("field_of_view_deg")) {
    json.Fail(
        json.Has("camera_matrix") ? "both camera_matrix and field_of_view_deg" : "no field of view",
        "either camera_matrix or field_of_view_deg");
  }
  if (json.Has("field_of_view_deg")) {
    const JsonReader fov = json.Child("field_of_view_deg");
    fov.Numbers(2);
    return CameraModel::FromFieldOfView(
        model.name, model.width, model.height, fov.Child(size_t{0}).AsNumber(0.001, 179.0),
        fov.Child(size_t{1}).AsNumber(0.001, 179.0), model.camera_from_world);
  }
  const JsonReader node = json.Child("camera_matrix");
  const Mat3d k = Matrix3(node);
  model.fx = k(0, 0), model.fy = k(1, 1), model.cx = k(0, 2), model.cy = k(1, 2);
  Mat3d expected = Mat3d::Identity();
  expected(0, 0) = model.fx, expected(1, 1) = model.fy, expected(0, 2) = model.cx,
              expected(1, 2) = model.cy;
  if (k != expected || !(model.fx > 0.0) || !(model.fy > 0.0)) {
    node.Fail("another matrix", "fx, 0, cx, 0, fy, cy, 0, 0, 1 with positive fx and fy");
  }
  return model;
}

}  // namespace

CameraSpec ReadCamera(JsonReader json) {
  CameraSpec camera;
  camera.model = ReadCameraModel(json);
  if (json.Has("distortion")) camera.model.distortion = ReadDistortion(json.Child("distortion"));
  if (json.Has("lens")) camera.lens = ReadLens(json.Child("lens"));
  if (HasSome(json, "filter")) camera.filter = ReadFilter(json.Child("filter"));
  if (json.Has("sensor")) camera.sensor = ReadSensor(json.Child("sensor"));
  if (HasSome(json, "ring")) camera.ring = ReadRing(json.Child("ring"));
  json.Finish();
  return camera;
}

}  // namespace retrolux
