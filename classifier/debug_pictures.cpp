#include "classifier/debug_pictures.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/atomic_file.h"
#include "core/image_file.h"

namespace retrolux {

namespace {

// Pictures up to this many pixels are shown with kZoom x kZoom pixels for one.
constexpr int kZoomedPixels = 2'000'000;
constexpr int kZoom = 3;
constexpr int kShift = 4;  // OpenCV draws in 1/16 px

const cv::Scalar kGreen(90, 220, 90), kYellow(255, 220, 60), kBlue(90, 160, 255), kRed(255, 80, 80);

class Canvas {
 public:
  // Colours are R, G, B.
  template <typename ColourOfPixel>
  Canvas(int width, int height, ColourOfPixel colour)
      : zoom_(width * height <= kZoomedPixels ? kZoom : 1), rgb_(height, width, CV_8UC3) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) rgb_.at<cv::Vec3b>(y, x) = colour(x, y);
    }
    cv::Mat large;
    cv::resize(rgb_, large, {}, zoom_, zoom_, cv::INTER_NEAREST);
    rgb_ = large;
  }

  void Line(const Vec2d& a, const Vec2d& b, const cv::Scalar& colour) {
    cv::line(rgb_, Place(a), Place(b), colour, 1, cv::LINE_AA, kShift);
  }

  void Closed(const Polygon& points, const cv::Scalar& colour) {
    for (size_t i = 0; i < points.size(); ++i) {
      Line(points[i], points[(i + 1) % points.size()], colour);
    }
  }

  void Dot(const Vec2d& at, const cv::Scalar& colour) {
    cv::circle(rgb_, Place(at), 3 << kShift, colour, 1, cv::LINE_AA, kShift);
  }

  void Text(const Vec2d& at, const std::string& text, const cv::Scalar& colour) {
    const cv::Point place = Place(at);
    cv::putText(rgb_, text, {place.x >> kShift, place.y >> kShift}, cv::FONT_HERSHEY_SIMPLEX, 0.5,
                colour, 1, cv::LINE_AA);
  }

  void Write(const std::filesystem::path& file) const {
    WriteRgbPng(file, rgb_.cols, rgb_.rows, {rgb_.datastart, rgb_.dataend});
  }

 private:
  // Our pixel (0, 0) is a centre; zoomed it becomes the centre of kZoom x kZoom pixels.
  cv::Point Place(const Vec2d& px) const {
    const Vec2d zoomed = zoom_ * (px.array() + 0.5).matrix() - Vec2d(0.5, 0.5);
    const Vec2d fixed = zoomed * (1 << kShift);
    return {static_cast<int>(std::lround(fixed.x())), static_cast<int>(std::lround(fixed.y()))};
  }

  int zoom_;
  cv::Mat rgb_;
};

cv::Vec3b Grey(float brightness) {
  const auto v = static_cast<uint8_t>(std::lround(255.0f * std::clamp(brightness, 0.0f, 1.0f)));
  return {v, v, v};
}

cv::Vec3b LabelColour(int label) {
  if (label == 0) return {0, 0, 0};
  const auto hue = static_cast<unsigned>(label) * 2654435761u;  // scatters neighbours
  const auto part = [&](int shift) {
    return static_cast<uint8_t>(80 + ((hue >> shift) & 0xff) * 175 / 255);
  };
  return {part(24), part(16), part(8)};
}

std::string NameOf(const Detection& d) {
  if (!d.marker) return d.straight_edges > 0 ? cv::format("? (%d)", d.straight_edges) : "?";
  return cv::format("%d  %.2f", *d.marker, d.confidence);
}

// The picture that the others are drawn on.
class Ground {
 public:
  explicit Ground(const FloatPlane& smooth)
      : smooth_(smooth),
        top_(std::max(1.0f, *std::max_element(smooth.data.begin(), smooth.data.end()))) {}

  Canvas Draw() const {
    return Canvas(smooth_.width, smooth_.height,
                  [&](int x, int y) { return Grey(std::sqrt(smooth_(x, y) / top_)); });
  }

 private:
  const FloatPlane& smooth_;
  float top_;
};

void WriteField(const std::filesystem::path& folder, const Ground& ground,
                const GradientField& field, const EdgeBands& bands) {
  EnsureWritableFolder(folder);
  const int width = field.smooth.width;
  const int height = field.smooth.height;
  ground.Draw().Write(folder / "01_picture.png");
  const auto slope = [&](int x, int y) {
    return Grey(field.slope(x, y) / (20.0f * kSlopeNoise * field.noise.At(x, y)));
  };
  Canvas(width, height, slope).Write(folder / "02_slope.png");
  Canvas(width, height, [&](int x, int y) {
    return LabelColour(bands.labels(x, y));
  }).Write(folder / "03_steep.png");
}

void DrawName(Canvas& names, const Detection& d) {
  const cv::Scalar& colour = d.marker ? kGreen : kRed;
  names.Closed(d.corners_px, colour);
  names.Dot(d.centroid_px, colour);
  names.Text(d.centroid_px + Vec2d(0.8, -0.6) * std::sqrt(d.area_px), NameOf(d), colour);
}

}  // namespace

void WriteDebugPictures(const std::filesystem::path& folder, const Stages& stages) {
  const Ground ground(stages.field.smooth);
  WriteField(folder, ground, stages.field, stages.bands);

  Canvas outlines = ground.Draw();
  for (const Pattern& pattern : stages.patterns) outlines.Closed(pattern.outline, kGreen);
  outlines.Write(folder / "04_outlines.png");

  Canvas edges = ground.Draw();
  Canvas names = ground.Draw();
  for (const Detection& d : stages.detections) {
    const size_t n = d.corners_px.size();
    for (size_t i = 0; i < n; ++i) {
      edges.Line(d.corners_px[i], d.corners_px[(i + 1) % n], i % 2 == 0 ? kYellow : kBlue);
      edges.Dot(d.corners_px[i], kRed);
    }
    DrawName(names, d);
  }
  edges.Write(folder / "05_edges.png");
  names.Write(folder / "06_names.png");
}

void WriteDebugPictures(const std::filesystem::path& folder, const GradientField& field,
                        const EdgeBands& bands, const std::vector<JudgedPattern>& judged) {
  const Ground ground(field.smooth);
  WriteField(folder, ground, field, bands);
  Canvas outlines = ground.Draw();
  Canvas fits = ground.Draw();
  Canvas names = ground.Draw();
  for (const JudgedPattern& j : judged) {
    outlines.Closed(j.outline_px, j.dark ? kBlue : kGreen);
    fits.Closed(j.fitted_px, j.detection.marker ? kYellow : kRed);
    if (!j.fitted_px.empty()) {
      fits.Text(j.detection.centroid_px, cv::format("%.3f", j.probability), kYellow);
    }
    DrawName(names, j.detection);
  }
  outlines.Write(folder / "04_outlines.png");
  fits.Write(folder / "05_fits.png");
  names.Write(folder / "06_names.png");
}

void WriteDebugPictures(const std::filesystem::path& folder, const DigitalImage& image,
                        const std::vector<FoundTag>& tags) {
  FloatPlane levels(image.dn.width, image.dn.height);
  std::copy(image.dn.data.begin(), image.dn.data.end(), levels.data.begin());
  Canvas canvas = Ground(levels).Draw();
  for (const FoundTag& tag : tags) {
    canvas.Closed({tag.corners_px.begin(), tag.corners_px.end()}, kGreen);
    for (const Vec2d& corner : tag.corners_px) canvas.Dot(corner, kYellow);
    canvas.Dot(tag.corners_px[0], kRed);
    canvas.Text(tag.corners_px[0], std::to_string(tag.id), kBlue);
  }
  EnsureWritableFolder(folder);
  canvas.Write(folder / "tags.png");
}

}  // namespace retrolux
