#include "analysis/contact_sheet.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/image_file.h"

namespace retrolux {

namespace {

constexpr int kTileWidth_px = 480;
constexpr int kGap_px = 4;
constexpr double kGamma = 2.2;
const cv::Scalar kGreen(90, 220, 90), kRed(255, 80, 80), kGrey(120, 120, 130),
    kWhite(255, 255, 255);

class Tile {
 public:
  Tile(const DigitalImage& image, double scale) : scale_(scale) {
    const double top = (1 << image.bits) - 1;
    cv::Mat grey(image.dn.height, image.dn.width, CV_8UC1);
    for (int y = 0; y < grey.rows; ++y) {
      for (int x = 0; x < grey.cols; ++x) {
        const double level = std::min(image.dn(x, y) / top, 1.0);
        grey.at<uint8_t>(y, x) =
            static_cast<uint8_t>(std::lround(255.0 * std::pow(level, 1.0 / kGamma)));
      }
    }
    cv::Mat large;
    cv::resize(grey, large, {}, scale, scale, scale < 1.0 ? cv::INTER_AREA : cv::INTER_CUBIC);
    cv::cvtColor(large, rgb_, cv::COLOR_GRAY2RGB);
  }

  // Along the borders of the pixels.
  void Border(const MaskPlane& mask, const cv::Scalar& colour) {
    const auto is_set = [&](int x, int y) { return mask.Contains(x, y) && mask(x, y) != 0; };
    for (int y = 0; y <= mask.height; ++y) {
      for (int x = 0; x <= mask.width; ++x) {
        if (is_set(x, y) != is_set(x - 1, y)) Line({x - 0.5, y - 0.5}, {x - 0.5, y + 0.5}, colour);
        if (is_set(x, y) != is_set(x, y - 1)) Line({x - 0.5, y - 0.5}, {x + 0.5, y - 0.5}, colour);
      }
    }
  }
  void Line(const Vec2d& a, const Vec2d& b, const cv::Scalar& colour) {
    cv::line(rgb_, Place(a), Place(b), colour, 1);
  }
  void Dot(const Vec2d& at, const cv::Scalar& colour) {
    cv::circle(rgb_, Place(at), 2, colour, cv::FILLED, cv::LINE_AA);
  }
  void Cross(const Vec2d& at, const cv::Scalar& colour) {
    const double arm = 3.0 / scale_;
    Line(at - Vec2d(arm, 0), at + Vec2d(arm, 0), colour);
    Line(at - Vec2d(0, arm), at + Vec2d(0, arm), colour);
  }
  void Text(const cv::Point& at, const std::string& text, double size, const cv::Scalar& colour) {
    cv::putText(rgb_, text, at, cv::FONT_HERSHEY_SIMPLEX, size, colour, 1, cv::LINE_AA);
  }
  cv::Point Place(const Vec2d& px) const {
    const Vec2d zoomed = scale_ * (px.array() + 0.5).matrix() - Vec2d(0.5, 0.5);
    return {static_cast<int>(std::lround(zoomed.x())), static_cast<int>(std::lround(zoomed.y()))};
  }
  const cv::Mat& Rgb() const { return rgb_; }

 private:
  double scale_;
  cv::Mat rgb_;
};

void DrawLabel(const MarkerLabel& label, Tile& tile) {
  const MaskPlane visible = DecodeRuns(label.visible);
  if (label.visible.Area() < label.amodal.Area() / 2) tile.Border(DecodeRuns(label.amodal), kGrey);
  if (label.visible.Area() == 0) return;
  tile.Border(visible, kGreen);
  for (const MarkerKeypoint& corner : label.corners) {
    if (corner.visibility == KeypointVisibility::kNone) continue;
    tile.Dot(*corner.px, corner.visibility == KeypointVisibility::kVisible ? kGreen : kRed);
  }
  if (label.centroid_radiometric_px) tile.Cross(*label.centroid_radiometric_px, kRed);
  const MaskBounds bounds = BoundsOf(visible);
  tile.Text(tile.Place(Vec2d(bounds.x0 + bounds.width, bounds.y0)),
            label.number == 0 ? "o" : std::to_string(label.number), 0.45, kGreen);
}

cv::Mat TileOf(const DatasetScene& scene, const DatasetPicture& picture,
               const std::filesystem::path& folder) {
  DigitalImage image = ReadGrey(folder / picture.file);
  image.bits = picture.bits;
  Tile tile(image, static_cast<double>(kTileWidth_px) / picture.model.width);
  for (const MarkerLabel& label : picture.markers) DrawLabel(label, tile);
  tile.Text({6, 14}, scene.name + " " + picture.camera, 0.42, kWhite);
  return tile.Rgb();
}

}  // namespace

std::string ContactSheetPng(const DatasetIndex& index, const std::filesystem::path& folder,
                            int count, int columns) {
  std::vector<std::pair<const DatasetScene*, const DatasetPicture*>> all;
  for (const DatasetScene& scene : index.scenes) {
    for (const DatasetPicture& picture : scene.pictures) all.emplace_back(&scene, &picture);
  }
  const size_t shown = std::min(all.size(), static_cast<size_t>(count));
  std::vector<cv::Mat> tiles;
  int height = 1;
  for (size_t i = 0; i < shown; ++i) {
    const auto& [scene, picture] = all[(2 * i + 1) * all.size() / (2 * shown)];
    tiles.push_back(TileOf(*scene, *picture, folder));
    height = std::max(height, tiles.back().rows);
  }
  const int rows = (static_cast<int>(shown) + columns - 1) / columns;
  cv::Mat sheet(std::max(rows, 1) * (height + kGap_px), columns * (kTileWidth_px + kGap_px),
                CV_8UC3, cv::Scalar(60, 60, 60));
  for (size_t i = 0; i < tiles.size(); ++i) {
    const int column = static_cast<int>(i) % columns, row = static_cast<int>(i) / columns;
    tiles[i].copyTo(sheet(cv::Rect(column * (kTileWidth_px + kGap_px), row * (height + kGap_px),
                                   tiles[i].cols, tiles[i].rows)));
  }
  return EncodeRgbPng(sheet.cols, sheet.rows, {sheet.datastart, sheet.dataend});
}

}  // namespace retrolux
