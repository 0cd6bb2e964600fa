#include "core/camera_model.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"

namespace retrolux {

CameraModel CameraModel::FromFieldOfView(std::string name, int width, int height,
                                         double horizontal_deg, double vertical_deg,
                                         const RigidTransform& camera_from_world) {
  CameraModel camera;
  camera.name = std::move(name);
  camera.width = width;
  camera.height = height;
  camera.fx = 0.5 * width / std::tan(0.5 * RadFromDeg(horizontal_deg));
  camera.fy = 0.5 * height / std::tan(0.5 * RadFromDeg(vertical_deg));
  camera.cx = 0.5 * (width - 1);
  camera.cy = 0.5 * (height - 1);
  camera.camera_from_world = camera_from_world;
  return camera;
}

std::optional<Vec2d> CameraModel::Project(const Vec3d& x_in_world) const {
  const Vec3d x = camera_from_world * x_in_world;
  if (!(x.z() > 0.0)) return std::nullopt;
  const Vec2d ideal = x.head<2>() / x.z();
  if (ideal.norm() >= distortion.LargestRadius()) return std::nullopt;
  const Vec2d real = distortion.Apply(ideal);
  return Vec2d(fx * real.x() + cx, fy * real.y() + cy);
}

std::optional<Vec2d> CameraModel::PlanePoint(const Vec2d& px) const {
  return distortion.Remove({(px.x() - cx) / fx, (px.y() - cy) / fy});
}

Ray CameraModel::RayThrough(const Vec2d& px) const {
  const std::optional<Vec2d> ideal = PlanePoint(px);
  RETROLUX_CHECK(ideal, "{}: no light falls on pixel ({}, {})", name, px.x(), px.y());
  const Vec3d in_camera(ideal->x(), ideal->y(), 1.0);
  return {Centre(), camera_from_world.rotation.transpose() * in_camera.normalized()};
}

bool CameraModel::InFrame(const Vec2d& px) const {
  return px.x() >= -0.5 && px.y() >= -0.5 && px.x() <= width - 0.5 && px.y() <= height - 0.5;
}

CameraModel CameraModel::Resized(int new_width, int new_height) const {
  const double sx = static_cast<double>(new_width) / width;
  const double sy = static_cast<double>(new_height) / height;
  CameraModel camera = *this;
  camera.width = new_width;
  camera.height = new_height;
  camera.fx = fx * sx;
  camera.fy = fy * sy;
  // The edge of the picture, half a pixel outside the first centre, stays where it is.
  camera.cx = (cx + 0.5) * sx - 0.5;
  camera.cy = (cy + 0.5) * sy - 0.5;
  return camera;
}

namespace {

// Shortest text that reads back as the same double, with the point that YAML wants for a real
// number.
std::string Real(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".";
  return text;
}

std::string Matrix(const std::string& name, int rows, int cols, const std::vector<double>& data) {
  std::vector<std::string> numbers;
  for (const double value : data) numbers.push_back(Real(value));
  return fmt::format(
      "      {}: !!opencv-matrix\n         rows: {}\n         cols: {}\n         dt: d\n"
      "         data: [ {} ]\n",
      name, rows, cols, fmt::join(numbers, ", "));
}

}  // namespace

std::string CamerasYaml(const std::vector<CameraModel>& cameras) {
  std::string yaml =
      "%YAML:1.0\n---\n"
      "schema: \"retrolux/cameras-1\"\n"
      "version: \"" RETROLUX_VERSION
      "\"\n"
      "pixel_origin: \"center\"\n"
      "units: \"mm, px\"\n"
      "axes: \"camera x right, y down, z forward; R, t: camera_from_world\"\n"
      "cameras:\n";
  for (const CameraModel& camera : cameras) {
    const Mat3d& r = camera.camera_from_world.rotation;
    const Vec3d& t = camera.camera_from_world.translation;
    const std::array<double, 5> d = camera.distortion.Coefficients();
    yaml += "   -\n";
    yaml += fmt::format("      name: \"{}\"\n      image_width: {}\n      image_height: {}\n",
                        camera.name, camera.width, camera.height);
    yaml +=
        Matrix("camera_matrix", 3, 3, {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1});
    yaml += Matrix("distortion_coefficients", 1, 5, {d[0], d[1], d[2], d[3], d[4]});
    yaml +=
        Matrix("R", 3, 3,
               {r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)});
    yaml += Matrix("t", 3, 1, {t.x(), t.y(), t.z()});
  }
  return yaml;
}

}  // namespace retrolux
