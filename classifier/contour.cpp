#include "classifier/contour.h"

#include <algorithm>
#include <optional>

namespace retrolux {

namespace {

// A way over the pixel grid (marching squares): it passes through gates, each between a bright
// pixel on the left and a dark one on the right.
struct Gate {
  int x, y;  // the bright pixel
  int dx,
      dy;  // heading; the dark pixel is at (x - dy, y + dx), to the right of it when y points down
};

// A contour that leaves the steep pixels for longer than this many gates is given up: between the
// patterns, where only noise leads it, it goes on and on.
constexpr int kLongestGap = 64;

template <typename Real>
class Tracer {
 public:
  // `height`: above the level, DN, from the pixel `origin` of the picture on.
  Tracer(const Plane<Real>& height, const PixelBox& origin, const Plane<int>* steep)
      : height_(height),
        x0_(origin.x0),
        y0_(origin.y0),
        steep_(steep),
        passed_(height.width, height.height, 0) {}

  // Every closed contour goes north between a bright pixel and a dark one to its right at least
  // once.
  std::vector<Polygon> Trace() {
    std::vector<Polygon> contours;
    for (int y = 0; y < height_.height; ++y) {
      for (int x = NextSteep(0, y); x + 1 < height_.width; x = NextSteep(x + 1, y)) {
        if (!Bright(x, y) || Bright(x + 1, y) || passed_(x, y)) continue;
        if (auto contour = Follow({x, y, 0, -1})) contours.push_back(std::move(*contour));
      }
    }
    return contours;
  }

 private:
  double Height(int x, int y) const { return static_cast<double>(height_(x, y)); }
  bool Bright(int x, int y) const { return height_(x, y) > Real{0}; }
  // The first steep pixel of the row from x on; the width if there is none.
  int NextSteep(int x, int y) const {
    if (steep_ == nullptr) return x;
    const auto row = steep_->data.begin() + static_cast<ptrdiff_t>(steep_->Index(x0_, y + y0_));
    const auto next =
        std::find_if(row + x, row + height_.width, [](int label) { return label != 0; });
    return static_cast<int>(next - row);
  }
  bool OnSteep(const Gate& g) const {
    return steep_ == nullptr || (*steep_)(g.x + x0_, g.y + y0_) != 0;
  }

  Vec2d Crossing(const Gate& g) const {
    const double left = Height(g.x, g.y);
    const double right = Height(g.x - g.dy, g.y + g.dx);
    const double t = left / (left - right);
    return {x0_ + g.x - t * g.dy, y0_ + g.y + t * g.dx};
  }

  // The next gate of the square in front, or nothing at the end of the box.
  std::optional<Gate> Next(const Gate& g) const {
    const int lx = g.x + g.dx, ly = g.y + g.dy;  // front left
    const int rx = lx - g.dy, ry = ly + g.dx;    // front right
    if (!height_.Contains(lx, ly) || !height_.Contains(rx, ry)) return std::nullopt;
    const bool left = Bright(lx, ly);
    const bool right = Bright(rx, ry);
    if (left && !right) return Gate{lx, ly, g.dx, g.dy};
    // Two bright pixels across a corner are connected if the middle of the square is bright.
    const bool turn_right = left || (right && Height(lx, ly) + Height(rx, ry) + Height(g.x, g.y) +
                                                      Height(g.x - g.dy, g.y + g.dx) >
                                                  0.0);
    if (turn_right) return Gate{rx, ry, -g.dy, g.dx};
    return Gate{g.x, g.y, g.dy, -g.dx};
  }

  std::optional<Polygon> Follow(const Gate& start) {
    Polygon contour;
    std::optional<Gate> gate = start;
    int gap = 0;
    do {
      gap = OnSteep(*gate) ? 0 : gap + 1;
      if (gap > kLongestGap) return std::nullopt;
      if (gate->dy == -1) {
        uint8_t& passed = passed_(gate->x, gate->y);
        if (passed) return std::nullopt;  // the rest of an open one
        passed = 1;
      }
      contour.push_back(Crossing(*gate));
      gate = Next(*gate);
      if (!gate) return std::nullopt;
    } while (gate->x != start.x || gate->y != start.y || gate->dy != start.dy);
    return contour;
  }

  const Plane<Real>& height_;
  int x0_, y0_;
  const Plane<int>* steep_;
  Plane<uint8_t> passed_;
};

}  // namespace

std::vector<Polygon> TraceContours(const FloatPlane& plane, const PixelBox& box,
                                   const LevelPlane& level) {
  Plane<double> height(box.x1 - box.x0, box.y1 - box.y0);
  for (int y = 0; y < height.height; ++y) {
    for (int x = 0; x < height.width; ++x) {
      const Vec2d px(x + box.x0, y + box.y0);
      height(x, y) = static_cast<double>(plane(x + box.x0, y + box.y0)) - level.At(px);
    }
  }
  return Tracer(height, box, nullptr).Trace();
}

std::vector<Polygon> TraceSteepContours(const FloatPlane& relief, const Plane<int>& steep) {
  return Tracer(relief, PixelBox{}, &steep).Trace();
}

double Perimeter(const Polygon& contour) {
  double length = 0.0;
  for (size_t i = 0; i < contour.size(); ++i) {
    length += (contour[(i + 1) % contour.size()] - contour[i]).norm();
  }
  return length;
}

Polygon Resample(const Polygon& contour, int count) {
  const double step = Perimeter(contour) / count;
  Polygon points;
  double passed = 0.0;  // length of the way up to contour[i]
  for (size_t i = 0; i < contour.size(); ++i) {
    const Vec2d& a = contour[i];
    const Vec2d& b = contour[(i + 1) % contour.size()];
    const double length = (b - a).norm();
    while (static_cast<int>(points.size()) < count) {
      const double along = static_cast<double>(points.size()) * step - passed;
      if (along >= length) break;
      points.push_back(a + (b - a) * (along / length));
    }
    passed += length;
  }
  while (static_cast<int>(points.size()) < count) points.push_back(contour.front());  // rounding
  return points;
}

}  // namespace retrolux
