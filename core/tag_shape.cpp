#include "core/tag_shape.h"

#include <algorithm>

#include "core/error.h"

namespace retrolux {

namespace {

// Cells [x0, x1) x [y0, y1).
struct CellBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

bool AllDark(const Plane<uint8_t>& bright, const CellBox& box) {
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      if (bright(x, y) != 0) return false;
    }
  }
  return true;
}

int CountOpen(const Plane<uint8_t>& open, const CellBox& box) {
  int count = 0;
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) count += open(x, y);
  }
  return count;
}

// The dark box that covers most open cells; of several the first from the top left.
CellBox BestBox(const Plane<uint8_t>& bright, const Plane<uint8_t>& open) {
  CellBox best;
  int best_count = 0;
  for (int y0 = 0; y0 < bright.height; ++y0) {
    for (int x0 = 0; x0 < bright.width; ++x0) {
      for (int y1 = y0 + 1; y1 <= bright.height; ++y1) {
        for (int x1 = x0 + 1; x1 <= bright.width; ++x1) {
          const CellBox box{x0, y0, x1, y1};
          if (!AllDark(bright, box)) break;
          const int count = CountOpen(open, box);
          if (count <= best_count) continue;
          best = box;
          best_count = count;
        }
      }
    }
  }
  return best;
}

// Of n x n cells; y of the marker frame points up, rows of cells go down.
Polygon Outline(const CellBox& box, int n, double side_mm) {
  const auto place = [&](int line) { return 0.5 * side_mm * (2.0 * line / n - 1.0); };
  const double left = place(box.x0), right = place(box.x1);
  const double top = -place(box.y0), bottom = -place(box.y1);
  return {{left, bottom}, {right, bottom}, {right, top}, {left, top}};
}

}  // namespace

MarkerShape TagShape(int number, const std::string& name, const Plane<uint8_t>& bright,
                     double side_mm) {
  const int n = bright.width;
  RETROLUX_CHECK(n > 0 && n == bright.height, "{} x {} cells", n, bright.height);
  MarkerShape shape{number, name, Outline({0, 0, n, n}, n, side_mm), 4, {}};
  Plane<uint8_t> open(n, n);
  for (size_t i = 0; i < open.data.size(); ++i) open.data[i] = bright.data[i] == 0;
  while (std::count(open.data.begin(), open.data.end(), 1) > 0) {
    const CellBox box = BestBox(bright, open);
    shape.holes_mm.push_back(Outline(box, n, side_mm));
    for (int y = box.y0; y < box.y1; ++y) {
      for (int x = box.x0; x < box.x1; ++x) open(x, y) = 0;
    }
  }
  return shape;
}

}  // namespace retrolux
