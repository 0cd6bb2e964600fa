#include "classifier/camera_file.h"

#include <cmath>
#include <opencv2/core.hpp>
#include <set>

#include "core/error.h"

namespace retrolux {

namespace {

// One camera of the file, with the place for messages.
class CameraNode {
 public:
  CameraNode(const std::filesystem::path& file, const cv::FileNode& node, size_t index)
      : file_(file), node_(node), place_(fmt::format("cameras[{}]", index)) {}

  [[noreturn]] void Fail(const std::string& key, std::string_view found,
                         std::string_view expected) const {
    throw InputError::At(file_, place_ + "." + key, found, expected);
  }

  std::string Name() const {
    if (!node_["name"].isString()) Fail("name", "no text", "the camera's name");
    return node_["name"].string();
  }

  int Pixels(const std::string& key) const {
    constexpr int kMost = 1 << 16;
    const cv::FileNode value = node_[key];
    if (!value.isInt()) Fail(key, "no whole number", "a number of pixels");
    const int pixels = static_cast<int>(value);
    if (pixels < 1 || pixels > kMost)
      Fail(key, std::to_string(pixels), fmt::format("1 to {} px", kMost));
    return pixels;
  }

  // Numbers row by row.
  std::vector<double> Matrix(const std::string& key, size_t least, size_t most) const {
    cv::Mat matrix;
    if (node_[key].isMap()) node_[key] >> matrix;
    if (matrix.total() < least || matrix.total() > most || matrix.channels() != 1) {
      Fail(key, fmt::format("{} numbers", matrix.total()),
           fmt::format("an opencv-matrix of {}", most));
    }
    matrix.convertTo(matrix, CV_64F);
    std::vector<double> numbers(matrix.begin<double>(), matrix.end<double>());
    for (const double number : numbers) {
      if (!std::isfinite(number)) Fail(key, fmt::format("{}", number), "finite numbers");
    }
    return numbers;
  }

 private:
  const std::filesystem::path& file_;
  cv::FileNode node_;
  std::string place_;
};

Mat3d ReadRotation(const CameraNode& node) {
  constexpr double kRounding = 1e-6;
  const std::vector<double> r = node.Matrix("R", 9, 9);
  Mat3d rotation;
  rotation << r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8];
  const double error = (rotation * rotation.transpose() - Mat3d::Identity()).cwiseAbs().maxCoeff();
  if (error > kRounding || rotation.determinant() < 0.0)
    node.Fail("R", "no rotation", "orthogonal rows, determinant 1");
  return rotation;
}

CameraModel ReadCamera(const CameraNode& node) {
  CameraModel camera;
  camera.name = node.Name();
  camera.width = node.Pixels("image_width");
  camera.height = node.Pixels("image_height");
  const std::vector<double> k = node.Matrix("camera_matrix", 9, 9);
  if (!(k[0] > 0.0) || !(k[4] > 0.0) || k[1] != 0.0 || k[3] != 0.0 || k[8] != 1.0)
    node.Fail("camera_matrix", "no pinhole's", "fx 0 cx, 0 fy cy, 0 0 1 with fx, fy > 0");
  camera.fx = k[0];
  camera.cx = k[2];
  camera.fy = k[4];
  camera.cy = k[5];
  std::vector<double> d = node.Matrix("distortion_coefficients", 4, 5);
  d.resize(5, 0.0);
  camera.distortion = Distortion(d[0], d[1], d[2], d[3], d[4]);
  const std::vector<double> t = node.Matrix("t", 3, 3);
  camera.camera_from_world = {ReadRotation(node), Vec3d(t[0], t[1], t[2])};
  return camera;
}

}  // namespace

std::vector<CameraModel> ReadCameras(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file))
    throw InputError::At(file, "", "no such file", "cameras.yml as `retrolux render` writes it");
  std::vector<CameraModel> cameras;
  try {
    const cv::FileStorage storage(file.string(), cv::FileStorage::READ);
    const cv::FileNode list = storage["cameras"];
    std::set<std::string> names;
    for (const cv::FileNode& node : list) {
      const CameraNode camera(file, node, cameras.size());
      cameras.push_back(ReadCamera(camera));
      if (!names.insert(cameras.back().name).second)
        camera.Fail("name", fmt::format("'{}' again", cameras.back().name), "names that differ");
    }
  } catch (const cv::Exception& error) {
    throw InputError::At(file, "", fmt::format("no YAML of OpenCV ({})", error.err),
                         "cameras.yml as `retrolux render` writes it");
  }
  if (cameras.empty()) throw InputError::At(file, "cameras", "none", "at least one camera");
  return cameras;
}

}  // namespace retrolux
