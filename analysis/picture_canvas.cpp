#include "analysis/picture_canvas.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/image_file.h"

namespace retrolux {

namespace {

constexpr double kGamma = 2.2;
constexpr double kSquaresFrom = 3.0;

cv::Scalar ScalarOf(CanvasColour colour) {
  return {static_cast<double>(colour.red), static_cast<double>(colour.green),
          static_cast<double>(colour.blue)};
}

int Interpolation(double scale) {
  if (scale < 1.0) return cv::INTER_AREA;
  return scale < kSquaresFrom ? cv::INTER_CUBIC : cv::INTER_NEAREST;
}

cv::Point Place(const Vec2d& px, const CanvasView& view) {
  const Vec2d zoomed =
      view.scale * (px.array() - Eigen::Array2d(view.x0, view.y0) + 0.5).matrix() - Vec2d(0.5, 0.5);
  return {static_cast<int>(std::lround(zoomed.x())), static_cast<int>(std::lround(zoomed.y()))};
}

// The canvas as OpenCV sees it.
cv::Mat Wrapped(std::vector<uint8_t>& rgb, int width, int height) {
  return {height, width, CV_8UC3, rgb.data()};
}

}  // namespace

PictureCanvas::PictureCanvas(const DigitalImage& image, const CanvasView& view) : view_(view) {
  cv::Mat grey(view.height, view.width, CV_8UC1, cv::Scalar(0));
  for (int y = 0; y < grey.rows; ++y) {
    for (int x = 0; x < grey.cols; ++x) {
      if (!image.dn.Contains(view.x0 + x, view.y0 + y)) continue;
      const double level = std::min(image.dn(view.x0 + x, view.y0 + y) / view.white_dn, 1.0);
      grey.at<uint8_t>(y, x) =
          static_cast<uint8_t>(std::lround(255.0 * std::pow(level, 1.0 / kGamma)));
    }
  }
  cv::Mat large, rgb;
  cv::resize(grey, large, {}, view.scale, view.scale, Interpolation(view.scale));
  cv::cvtColor(large, rgb, cv::COLOR_GRAY2RGB);
  width_ = rgb.cols;
  height_ = rgb.rows;
  rgb_.assign(rgb.datastart, rgb.dataend);
}

void PictureCanvas::Border(const MaskPlane& mask, CanvasColour colour) {
  const auto is_set = [&](int x, int y) { return mask.Contains(x, y) && mask(x, y) != 0; };
  for (int y = 0; y <= mask.height; ++y) {
    for (int x = 0; x <= mask.width; ++x) {
      if (is_set(x, y) != is_set(x - 1, y)) Line({x - 0.5, y - 0.5}, {x - 0.5, y + 0.5}, colour);
      if (is_set(x, y) != is_set(x, y - 1)) Line({x - 0.5, y - 0.5}, {x + 0.5, y - 0.5}, colour);
    }
  }
}

void PictureCanvas::Line(const Vec2d& a, const Vec2d& b, CanvasColour colour) {
  cv::Mat rgb = Wrapped(rgb_, width_, height_);
  cv::line(rgb, Place(a, view_), Place(b, view_), ScalarOf(colour), 1);
}

void PictureCanvas::Closed(const Polygon& polygon, CanvasColour colour) {
  for (size_t i = 0; i < polygon.size(); ++i)
    Line(polygon[i], polygon[(i + 1) % polygon.size()], colour);
}

void PictureCanvas::Dot(const Vec2d& at, CanvasColour colour) {
  cv::Mat rgb = Wrapped(rgb_, width_, height_);
  cv::circle(rgb, Place(at, view_), 2, ScalarOf(colour), cv::FILLED, cv::LINE_AA);
}

void PictureCanvas::Cross(const Vec2d& at, CanvasColour colour) {
  const double arm = 3.0 / view_.scale;
  Line(at - Vec2d(arm, 0), at + Vec2d(arm, 0), colour);
  Line(at - Vec2d(0, arm), at + Vec2d(0, arm), colour);
}

void PictureCanvas::Text(const Vec2d& at, const std::string& text, double size,
                         CanvasColour colour) {
  cv::Mat rgb = Wrapped(rgb_, width_, height_);
  cv::putText(rgb, text, Place(at, view_), cv::FONT_HERSHEY_SIMPLEX, size, ScalarOf(colour), 1,
              cv::LINE_AA);
}

std::string PictureCanvas::Png() const {
  return EncodeRgbPng(width_, height_, rgb_);
}

}  // namespace retrolux
