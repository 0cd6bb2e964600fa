// The picture as the method sees it: a little smoothed, with its slope and its noise.
#pragma once

#include "core/plane.h"

namespace retrolux {

// Standard deviation of a pixel's noise, by tiles of kTile x kTile pixels: it grows with the light.
struct NoiseMap {
  static constexpr int kTile = 64;
  FloatPlane tiles;  // DN

  float At(int x, int y) const { return tiles(x / kTile, y / kTile); }
};

struct GradientField {
  FloatPlane smooth;  // DN, after the kernel (1 2 1)/4 along rows and columns
  FloatPlane slope;   // DN/px, length of the gradient of `smooth` by Sobel differences
  NoiseMap noise;     // of the picture before smoothing
};

// White noise of 1 DN gives the two components of the gradient this standard deviation, DN/px: the
// root of the sum of squares of (-1 -2 0 2 1)/8 x (1 4 6 4 1)/16.
inline constexpr float kSlopeNoise = 0.2067f;

// Reuses the memory of `field`: fresh pages for every picture would cost more than the arithmetic.
void MeasureGradient(const DigitalImage& image, GradientField& field);

// The smoothed picture above what it is around, DN: minus itself smoothed by 2 px more. It is 0
// where the picture is steepest, however the light falls along an edge (Marr and Hildreth, Proc. R.
// Soc. B 207, 1980).
void MeasureRelief(const GradientField& field, FloatPlane& relief);

// Between the pixel centres; the nearest inside for points outside.
double SampleBilinear(const FloatPlane& plane, double x, double y);

}  // namespace retrolux
