// Checks of the camera: where points fall, and how the filter's band moves over the field.
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "analysis/check.h"
#include "renderer/camera_response.h"
#include "renderer/id_pass.h"
#include "scenes/built_in.h"

namespace retrolux {

namespace {

// The largest distance, px, between a pixel's centre and what OpenCV makes of the surface point
// that the id pass found there, over every 7th pixel that shows an object.
double LargestProjectionError(const CameraSpec& camera, const RayScene& rays) {
  const IdBuffers ids = RenderIds(rays, camera.model, {});
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (size_t i = 0; i < ids.object.data.size(); i += 7) {
    if (ids.object.data[i] == 0) continue;
    points.emplace_back(static_cast<double>(ids.position[0].data[i]),
                        static_cast<double>(ids.position[1].data[i]),
                        static_cast<double>(ids.position[2].data[i]));
    pixels.emplace_back(static_cast<double>(i % static_cast<size_t>(ids.object.width)),
                        static_cast<double>(i / static_cast<size_t>(ids.object.width)));
  }
  const CameraModel& m = camera.model;
  const cv::Matx33d k(m.fx, 0, m.cx, 0, m.fy, m.cy, 0, 0, 1);
  const Mat3d& r = m.camera_from_world.rotation;
  const Vec3d& t = m.camera_from_world.translation;
  cv::Mat rotation_vector;
  cv::Rodrigues(
      cv::Matx33d(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)),
      rotation_vector);
  std::vector<cv::Point2d> projected;
  cv::projectPoints(points, rotation_vector, cv::Vec3d(t.x(), t.y(), t.z()), k, cv::noArray(),
                    projected);
  double largest = 0.0;
  for (size_t i = 0; i < pixels.size(); ++i)
    largest = std::max(largest, cv::norm(projected[i] - pixels[i]));
  return largest;
}

}  // namespace

std::vector<Check> CheckProjection() {
  const Scene scene = CtRoom();
  const RayScene rays(scene);
  std::vector<Check> checks;
  for (const CameraSpec& camera : scene.cameras) {
    checks.push_back({"id pass against cv::projectPoints, " + camera.model.name,
                      LargestProjectionError(camera, rays), 0.0, 1e-3, "px",
                      "the surface point behind a pixel's centre projects onto that centre"});
  }
  return checks;
}

std::vector<Check> CheckFilter() {
  std::vector<Check> checks;
  const DichroicFilter filter;
  // Shift of the band of an 880 nm filter with n_eff 1.9 at the edges of the field: -0.78, -1.37,
  // -2.13 nm at 4.57, 6.09, 7.59 degrees.
  const std::pair<double, double> shifts[] = {{4.57, -0.78}, {6.09, -1.37}, {7.59, -2.13}};
  for (const auto& [deg, shift] : shifts) {
    checks.push_back({fmt::format("shift of the band at {} degrees", deg),
                      filter.CentreAt(std::sin(RadFromDeg(deg))) - 880.0, shift, 0.006, "nm",
                      "lambda_0 (sqrt(1 - (sin theta / n_eff)^2) - 1), table to 0.01 nm"});
  }
  // A line at 904 nm lies near the half-maximum point at 905 nm, so that the shift costs it much.
  // What a pixel receives there, against T(904 nm, theta) cos^4 of the field angle written out.
  CameraSpec camera = OvalScene().cameras[0];
  const CameraResponse response(camera, {LedSpectrum({904.0, 0.5})}, 1e-3);
  for (const double deg : {4.57, 6.09}) {
    const auto level = [&](double theta_deg) {
      constexpr int kSamples = 4096;
      const auto cosine = static_cast<float>(std::cos(RadFromDeg(theta_deg)));
      double sum = 0.0;
      for (int s = 0; s < kSamples; ++s) {
        const Spectral nm =
            response.SampleWavelengths((static_cast<float>(s) + 0.5f) / kSamples, cosine);
        sum += static_cast<double>(
            response.WeightsAt(nm, cosine, std::pow(cosine, 4.0f)).electrons[0]);
      }
      return sum / kSamples;
    };
    const auto transmission = [](double theta_deg) {
      const double s = std::sin(RadFromDeg(theta_deg)) / 1.9;
      const double x = (904.0 - 880.0 * std::sqrt(1.0 - s * s)) / 25.0;
      return 0.85 * std::pow(2.0, -std::pow(x, 8)) + 1e-4;
    };
    const double expected =
        transmission(deg) / transmission(0.0) * std::pow(std::cos(RadFromDeg(deg)), 4);
    checks.push_back(
        {fmt::format("signal of a 904 nm line at {} degrees over that on the axis", deg),
         level(deg) / level(0.0), expected, 0.01, "",
         "T(lambda, theta) / T(lambda, 0) cos^4 theta; 1 % for the width of the line"});
  }
  return checks;
}

}  // namespace retrolux
