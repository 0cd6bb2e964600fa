// A marker fitted to the pixels: place, bend, blur and light, by least squares.
#pragma once

#include <limits>
#include <optional>

#include "classifier/coverage.h"
#include "classifier/patch.h"

namespace retrolux {

struct FitOptions {
  int max_steps = 8;
  // A fit is given up after its second step if the picture minus it has larger mean squares, DN^2.
  double hopeless = std::numeric_limits<double>::infinity();
  double converged_px = 0.005;  // largest change of a corner in the last step
  double max_blur_px = 2.0;     // standard deviation, beyond the pixel's own box
  // What is known of the bend before the pixels are seen, standard deviations. Curved surfaces:
  // their sagitta over half the marker's square, of that half (7.5 mm / (2 x 60 mm)). Perspective:
  // the focal length, px, of a lens that is rather wide.
  double curvature = 0.06;
  double focal_px = 1500.0;
};

// What the pixels are compared with, DN: B (1 - c) + M c, mixed by coverage c. The surroundings B
// are a plane, the logarithm of the marker's light M is of second degree: sheeting that falls off
// with the square of the angle, on a round surface, is exactly that. x and y count from the patch's
// middle in half its width. The three coefficients of B, then the six of ln M.
using Light = Eigen::Matrix<double, 9, 1>;
double SurroundingsAt(const Light& light, const Vec2d& place);
double MarkerLightAt(const Light& light, const Vec2d& place);
Vec2d PlaceInPatch(const Patch& patch, const Vec2d& px);

struct MarkerFit {
  OutlineMap map;              // onto the patch's pixels
  double blur_variance = 0.0;  // in patch pixels squared
  Light light = Light::Zero();
  double contrast = 0.0;      // marker over surroundings at the marker's middle, DN
  double mean_squares = 0.0;  // of picture minus fit over the patch's used pixels, DN^2
  double bend = 0.0;          // chi-square of the bend against what is known of it before
  // How far the bend is that of a saddle, which masks are not: how much its two curvatures differ
  // in sign, in units of `curvature`'s.
  double saddle = 0.0;
  bool converged = false;
};

// From a first guess of map (in the picture's pixels), light inside and outside (DN). `noise`: of a
// pixel, DN; weighs the priors. `coverage` is left as the fit has it. Nothing if the fit runs away.
// Gauss-Newton over the twelve coefficients of the map, the blur's variance and the light.
std::optional<MarkerFit> FitMarker(const Patch& patch, const ShapeModel& model, MarkerFit guess,
                                   double noise, const FitOptions& options, Coverage& coverage);

}  // namespace retrolux
