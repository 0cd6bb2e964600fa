#include "classifier/camera_file.h"

#include <set>

#include "core/atomic_file.h"
#include "core/json_reader.h"
#include "core/yaml_text.h"

namespace retrolux {

namespace {

// Numbers row by row of an opencv-matrix with so many of them.
std::vector<double> ReadMatrix(JsonReader& camera, const std::string& key, size_t least,
                               size_t most) {
  JsonReader matrix = camera.Child(key);
  const JsonReader data = matrix.Child("data");
  const size_t count = data.Size();
  const int rows = matrix.Integer("rows", 1, 9), cols = matrix.Integer("cols", 1, 9);
  if (count < least || count > most || static_cast<size_t>(rows * cols) != count)
    matrix.Fail(fmt::format("{} numbers", count), fmt::format("an opencv-matrix of {}", most));
  return data.Numbers(count);
}

Mat3d ReadRotation(JsonReader& json) {
  constexpr double kRounding = 1e-6;
  const std::vector<double> r = ReadMatrix(json, "R", 9, 9);
  Mat3d rotation;
  rotation << r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8];
  const double error = (rotation * rotation.transpose() - Mat3d::Identity()).cwiseAbs().maxCoeff();
  if (!(error <= kRounding) || rotation.determinant() < 0.0)
    json.Child("R").Fail("no rotation", "orthogonal rows, determinant 1");
  return rotation;
}

CameraModel ReadCamera(JsonReader json) {
  constexpr int kMostPixels = 1 << 16;
  CameraModel camera;
  camera.name = json.String("name");
  camera.width = json.Integer("image_width", 1, kMostPixels);
  camera.height = json.Integer("image_height", 1, kMostPixels);
  const std::vector<double> k = ReadMatrix(json, "camera_matrix", 9, 9);
  if (!(k[0] > 0.0) || !(k[4] > 0.0) || k[1] != 0.0 || k[3] != 0.0 || k[8] != 1.0)
    json.Child("camera_matrix").Fail("no pinhole's", "fx 0 cx, 0 fy cy, 0 0 1 with fx, fy > 0");
  camera.fx = k[0];
  camera.cx = k[2];
  camera.fy = k[4];
  camera.cy = k[5];
  std::vector<double> d = ReadMatrix(json, "distortion_coefficients", 4, 5);
  d.resize(5, 0.0);
  camera.distortion = Distortion(d[0], d[1], d[2], d[3], d[4]);
  const std::vector<double> t = ReadMatrix(json, "t", 3, 3);
  camera.camera_from_world = {ReadRotation(json), Vec3d(t[0], t[1], t[2])};
  return camera;
}

}  // namespace

std::vector<CameraModel> ReadCameras(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file))
    throw InputError::At(file, "", "no such file", "cameras.yml as `retrolux render` writes it");
  const nlohmann::json document = JsonOfYaml(ReadTextFile(file), file);
  JsonReader json = JsonReader::FromText(
      document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), file);
  std::vector<CameraModel> cameras;
  std::set<std::string> names;
  const size_t count = json.Has("cameras") ? json.Child("cameras").Size() : 0;
  for (size_t i = 0; i < count; ++i) {
    const JsonReader camera = json.Child("cameras").Child(i);
    cameras.push_back(ReadCamera(camera));
    if (!names.insert(cameras.back().name).second)
      camera.Fail(fmt::format("the name '{}' again", cameras.back().name), "names that differ");
  }
  if (cameras.empty()) throw InputError::At(file, "cameras", "none", "at least one camera");
  return cameras;
}

}  // namespace retrolux
