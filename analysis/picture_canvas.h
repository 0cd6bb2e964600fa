// A grey picture, or a part of it, enlarged and in colours, to draw labels on for people.
#pragma once

#include <string>

#include "analysis/rle.h"
#include "core/polygon.h"

namespace retrolux {

struct CanvasColour {
  uint8_t red, green, blue;
};
namespace canvas_colour {
inline constexpr CanvasColour kGreen{90, 220, 90}, kRed{255, 80, 80}, kGrey{120, 120, 130},
    kWhite{255, 255, 255}, kYellow{255, 210, 60};
}  // namespace canvas_colour

struct CanvasView {
  int x0 = 0, y0 = 0, width = 0, height = 0;  // of the picture, px
  double scale = 1.0;                         // canvas pixels for one of the picture
  double white_dn = 255.0;                    // what is drawn white
};

// Dark levels are raised (gamma 2.2 of the digital numbers). Enlarged three times and more the
// picture's pixels show as squares. Places are in the picture's pixels.
class PictureCanvas {
 public:
  PictureCanvas(const DigitalImage& image, const CanvasView& view);

  // Along the borders of the pixels.
  void Border(const MaskPlane& mask, CanvasColour colour);
  void Line(const Vec2d& a, const Vec2d& b, CanvasColour colour);
  void Closed(const Polygon& polygon, CanvasColour colour);
  void Dot(const Vec2d& at, CanvasColour colour);
  void Cross(const Vec2d& at, CanvasColour colour);
  // Its left end on the line of writing, `size` 1: 22 canvas pixels high.
  void Text(const Vec2d& at, const std::string& text, double size, CanvasColour colour);

  int Width() const { return width_; }
  int Height() const { return height_; }
  const std::vector<uint8_t>& Rgb() const { return rgb_; }  // row by row
  std::string Png() const;

 private:
  CanvasView view_;
  int width_ = 0, height_ = 0;
  std::vector<uint8_t> rgb_;
};

}  // namespace retrolux
