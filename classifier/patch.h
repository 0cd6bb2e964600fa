// The pixels around one pattern that are compared with markers.
#pragma once

#include "classifier/pattern.h"
#include "core/plane.h"

namespace retrolux {

struct PatchOptions {
  // How far from the inside of the pattern's outline pixels are compared, px.
  int margin_px = 3;
  // Larger patterns are compared on means of several pixels, so that the patch has about as many.
  double most_pixels = 1600.0;
};

// Of a large pattern k x k pixels are averaged into one: a mean of pixels is a larger pixel.
struct Patch {
  Vec2d origin_px = Vec2d::Zero();  // of its pixel (0, 0) in the picture
  int scale = 1;                    // k
  FloatPlane dn;
  Plane<uint8_t> inside;  // 1: the centre is inside the pattern's outline
  Plane<uint8_t> used;    // 1: compared
  int count = 0;          // of those
  // Standard deviation of a compared pixel's noise, DN, rms over the patch: inside the pattern,
  // where shot noise and sheeting add to it, measured there if it is large enough.
  double noise = 0.0;
  double free_share = 1.0;  // of the pixels around the pattern, how many are compared
  float white_dn = 0.0f;    // the largest number of the picture's ADC: pixels there may be brighter
};

// Pixels that belong to a neighbour are left out: those outside the outline where `height` is above
// the pattern's level again, and those around them. `height`: the smoothed picture, or its negative
// for dark patterns. The patch also has room for `reach`, points in the picture.
Patch CutPatch(const DigitalImage& image, const FloatPlane& height, const Pattern& pattern,
               const Polygon& reach, const PatchOptions& options);

}  // namespace retrolux
