#include "analysis/contact_sheet.h"

#include <algorithm>

#include "analysis/picture_canvas.h"
#include "core/image_file.h"

namespace retrolux {

namespace {

using namespace canvas_colour;

constexpr int kTileWidth_px = 480;
constexpr int kGap_px = 4;
constexpr uint8_t kGround = 60;

void DrawLabel(const MarkerLabel& label, PictureCanvas& tile) {
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
  tile.Text(Vec2d(bounds.x0 + bounds.width, bounds.y0),
            label.number == 0 ? "o" : std::to_string(label.number), 0.45, kGreen);
}

PictureCanvas TileOf(const DatasetScene& scene, const DatasetPicture& picture,
                     const std::filesystem::path& folder) {
  const DigitalImage image = ReadGrey(folder / picture.file);
  const double scale = static_cast<double>(kTileWidth_px) / picture.model.width;
  const double white_dn = (1 << picture.bits) - 1;
  PictureCanvas tile(image, {0, 0, image.dn.width, image.dn.height, scale, white_dn});
  for (const MarkerLabel& label : picture.markers) DrawLabel(label, tile);
  tile.Text(Vec2d(6.5, 14.5) / scale - Vec2d(0.5, 0.5), scene.name + " " + picture.camera, 0.42,
            kWhite);
  return tile;
}

}  // namespace

std::string ContactSheetPng(const DatasetIndex& index, const std::filesystem::path& folder,
                            int count, int columns) {
  std::vector<std::pair<const DatasetScene*, const DatasetPicture*>> all;
  for (const DatasetScene& scene : index.scenes) {
    for (const DatasetPicture& picture : scene.pictures) all.emplace_back(&scene, &picture);
  }
  const size_t shown = std::min(all.size(), static_cast<size_t>(count));
  std::vector<PictureCanvas> tiles;
  int tile_height = 1;
  for (size_t i = 0; i < shown; ++i) {
    const auto& [scene, picture] = all[(2 * i + 1) * all.size() / (2 * shown)];
    tiles.push_back(TileOf(*scene, *picture, folder));
    tile_height = std::max(tile_height, tiles.back().Height());
  }
  const int rows = (static_cast<int>(shown) + columns - 1) / columns;
  const int width = columns * (kTileWidth_px + kGap_px);
  const int height = std::max(rows, 1) * (tile_height + kGap_px);
  std::vector<uint8_t> sheet(3 * static_cast<size_t>(width) * static_cast<size_t>(height), kGround);
  for (size_t i = 0; i < tiles.size(); ++i) {
    const int x = static_cast<int>(i) % columns * (kTileWidth_px + kGap_px);
    const int y = static_cast<int>(i) / columns * (tile_height + kGap_px);
    const ptrdiff_t row_bytes = 3 * tiles[i].Width();
    for (int line = 0; line < tiles[i].Height(); ++line) {
      std::copy_n(tiles[i].Rgb().begin() + line * row_bytes, row_bytes,
                  sheet.begin() + 3 * (static_cast<ptrdiff_t>(y + line) * width + x));
    }
  }
  return EncodeRgbPng(width, height, sheet);
}

}  // namespace retrolux
