#include "scenes/scene_json_camera.h"

#include <cmath>

#include "scenes/scene_json_values.h"

namespace retrolux {

namespace {

constexpr int kMaxPixels = 32768;

Lens ReadLens(JsonReader json) {
  Lens lens;
  lens.focal_length_mm = json.Number("focal_length_mm", 0.1, 10000.0, lens.focal_length_mm);
  lens.f_number = json.Number("f_number", 0.5, 256.0, lens.f_number);
  lens.transmission = json.Number("transmission", 0.001, 1.0, lens.transmission);
  json.Finish();
  return lens;
}

SensorSpec ReadSensor(JsonReader json) {
  SensorSpec sensor;
  sensor.quantum_efficiency = TableName(json, "quantum_efficiency", sensor.quantum_efficiency);
  sensor.full_well_e = json.Number("full_well_e", 1.0, 1e9, sensor.full_well_e);
  sensor.read_noise_e = json.Number("read_noise_e", 0.0, 1e6, sensor.read_noise_e);
  sensor.dark_current_e_s = json.Number("dark_current_e_s", 0.0, 1e9, sensor.dark_current_e_s);
  sensor.adc_bits = json.Integer("adc_bits", 1, 16, sensor.adc_bits);
  sensor.offset_dn = json.Number("offset_dn", 0.0, 65535.0, sensor.offset_dn);
  sensor.gain_dn_e = json.Number("gain_dn_e", 0.0, 65535.0, sensor.gain_dn_e);
  json.Finish();
  return sensor;
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

// Absent and null both mean none.
bool HasSome(JsonReader& json, const std::string& key) {
  return json.Has(key) && !json.Child(key).Raw().is_null();
}

}  // namespace

CameraSpec ReadCamera(JsonReader json) {
  CameraSpec camera;
  camera.model = ReadCameraModel(json);
  if (json.Has("lens")) camera.lens = ReadLens(json.Child("lens"));
  if (HasSome(json, "filter")) camera.filter = ReadFilter(json.Child("filter"));
  if (json.Has("sensor")) camera.sensor = ReadSensor(json.Child("sensor"));
  if (HasSome(json, "ring")) camera.ring = ReadRing(json.Child("ring"));
  json.Finish();
  return camera;
}

}  // namespace retrolux
