// The grid of marker positions on the oval (thesis 3.4.1): 28 rows along z, 14 columns from the top
// down one side.
#pragma once

#include "core/conventions.h"

namespace retrolux {

struct GridPosition {
  int row = 0;            // 0..27, z = -135 + 10 row
  int col = 0;            // 0..13, (col + 0.5) 90/14 degrees from the top
  bool mirrored = false;  // on the half y < 0
};

namespace marker_grid {

inline constexpr int kRows = 28;
inline constexpr int kColumns = 14;
inline constexpr double kRadius_mm = 100.0;      // semi-axes across
inline constexpr double kHalfLength_mm = 140.0;  // semi-axis along z

// In the oval's frame: x up, z along, y to the left.
Vec3d Point(const GridPosition& position);

// Area of a cell of that row on the ellipsoid, mm2; the same for all columns. The cells of one half
// and their mirror images together are the face half of the oval, 80,133 mm2.
double CellArea_mm2(int row);

double FaceHalfArea_mm2();

}  // namespace marker_grid

}  // namespace retrolux
