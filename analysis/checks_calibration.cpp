// A camera's parameters recovered from our pictures by somebody else's calibration.
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "analysis/check.h"
#include "renderer/film.h"
#include "scenes/built_in.h"

namespace retrolux {

namespace {

const cv::Size kCorners(9, 6);  // inner ones, of 10 x 7 squares
constexpr double kSquare_mm = 30.0;

// From all around the board, near enough to fill the picture, shifted to its corners, and with the
// camera rolled by quarter turns.
std::vector<CameraModel> Views(const CameraModel& camera) {
  constexpr int kAround = 8;
  std::vector<CameraModel> views;
  for (const double tilt_deg : {15.0, 30.0, 45.0}) {
    for (int i = 0; i < kAround; ++i) {
      const double tilt = RadFromDeg(tilt_deg), phi = 2.0 * kPi * i / kAround;
      const double roll = 0.5 * kPi * (i % 4) + 0.2;
      const Vec3d direction(std::sin(tilt) * std::cos(phi), std::sin(tilt) * std::sin(phi),
                            std::cos(tilt));
      const Vec3d target(35.0 * (i % 3 - 1), 35.0 * ((i + 1) % 3 - 1), 0.0);
      const double distance_mm = i % 2 ? 680.0 : 600.0;
      CameraModel view = camera;
      view.camera_from_world =
          LookAt(target + distance_mm * direction, target, {std::cos(roll), std::sin(roll), 0.0});
      views.push_back(view);
    }
  }
  return views;
}

cv::Mat Picture(const Scene& scene, const RayScene& rays, const CameraModel& view) {
  CameraSpec camera = scene.cameras[0];
  camera.model = view;
  const Lights lights(scene, rays, RingChoice::kAll, view.name);
  const CameraResponse response(camera, lights.Spectra(), 1e-3);
  const std::vector<PlacedMarker> no_markers;
  TraceOptions options;
  options.samples_per_pixel = 32;
  options.max_surfaces = 1;
  const PathTracer tracer(scene, rays, lights, response, no_markers, options);
  const Film film = RenderFilm(tracer, view, lights.GroupNames(), NoProgress());
  cv::Mat picture(view.height, view.width, CV_32F);
  std::copy(film.electrons.data.begin(), film.electrons.data.end(), picture.ptr<float>());
  cv::normalize(picture, picture, 0.0, 1.0, cv::NORM_MINMAX);
  return picture;
}

// The corners as OpenCV finds them, in the order of the board's rows; nothing if it does not.
std::vector<cv::Point2f> FindCorners(const cv::Mat& picture) {
  cv::Mat grey;
  picture.convertTo(grey, CV_8U, 255.0);
  std::vector<cv::Point2f> corners;
  if (!cv::findChessboardCorners(grey, kCorners, corners)) return {};
  // Edges a pixel wide are too sharp for the finder's gradients: smoothing them, evenly to all
  // sides, halves its error.
  cv::Mat soft;
  cv::GaussianBlur(picture, soft, {0, 0}, 1.2);
  cv::cornerSubPix(soft, corners, {5, 5}, {-1, -1},
                   {cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 100, 1e-5});
  return corners;
}

// The largest distance between where two cameras show the same direction, over the places where
// corners were seen. (Beyond them a polynomial is anybody's guess.)
double LargestDifference_px(const CameraModel& a, const CameraModel& b,
                            const std::vector<std::vector<cv::Point2f>>& pictures) {
  CameraModel turned = b;
  turned.camera_from_world = a.camera_from_world;
  double largest = 0.0;
  for (const std::vector<cv::Point2f>& corners : pictures) {
    for (const cv::Point2f& corner : corners) {
      const Vec2d px(static_cast<double>(corner.x), static_cast<double>(corner.y));
      const Ray ray = a.RayThrough(px);
      largest = std::max(largest, (*turned.Project(ray.origin + ray.direction) - px).norm());
    }
  }
  return largest;
}

}  // namespace

// Tangential distortion is none in the scene and none in the calibration: together with a turn of
// the camera, p1 and p2 do to second order what a shift of the principal point does, and no
// pictures of a flat board at this field of view tell them apart to 0.1 px.
std::vector<Check> CheckCalibration() {
  const Scene scene = ChessboardScene();
  const RayScene rays(scene);
  const CameraModel& truth = scene.cameras[0].model;
  std::vector<std::vector<cv::Point3f>> objects;
  std::vector<std::vector<cv::Point2f>> pictures;
  std::vector<cv::Point3f> board;
  for (int row = 0; row < kCorners.height; ++row) {
    for (int column = 0; column < kCorners.width; ++column)
      board.emplace_back(static_cast<float>(column * kSquare_mm),
                         static_cast<float>(row * kSquare_mm), 0.0f);
  }
  const std::vector<CameraModel> views = Views(truth);
  for (const CameraModel& view : views) {
    const std::vector<cv::Point2f> corners = FindCorners(Picture(scene, rays, view));
    if (corners.empty()) continue;
    objects.push_back(board);
    pictures.push_back(corners);
  }
  cv::Mat k, d;
  std::vector<cv::Mat> rotations, translations;
  const double rms =
      cv::calibrateCamera(objects, pictures, {truth.width, truth.height}, k, d, rotations,
                          translations, cv::CALIB_ZERO_TANGENT_DIST | cv::CALIB_FIX_K3);
  CameraModel found = truth;
  found.fx = k.at<double>(0, 0), found.fy = k.at<double>(1, 1);
  found.cx = k.at<double>(0, 2), found.cy = k.at<double>(1, 2);
  found.distortion = {d.at<double>(0), d.at<double>(1), d.at<double>(2), d.at<double>(3),
                      d.at<double>(4)};
  const char* source = "the scene's camera; corners and calibration are OpenCV's";
  return {{"chessboards found", static_cast<double>(pictures.size()),
           static_cast<double>(views.size()), 0.0, "", "all pictures of the board"},
          {"calibration, fx", found.fx, truth.fx, 5e-4 * truth.fx, "px", source},
          {"calibration, fy", found.fy, truth.fy, 5e-4 * truth.fy, "px", source},
          {"calibration, cx", found.cx, truth.cx, 0.1, "px", source},
          {"calibration, cy", found.cy, truth.cy, 0.1, "px", source},
          {"calibration, largest difference with distortion",
           LargestDifference_px(truth, found, pictures), 0.0, 0.1, "px",
           "the same directions through both cameras, wherever a corner was seen"},
          {"calibration, rms of the corners", rms, 0.0, 0.05, "px",
           "noiseless pictures: what is left is OpenCV's corner finder"}};
}

}  // namespace retrolux
