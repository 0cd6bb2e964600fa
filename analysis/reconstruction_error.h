// How the separation angle of two cameras weighs what they both see (thesis section 4.1.1, eq. 4.6
// and 4.7). Angles psi in radians, 0 to pi; errors in mm.
#pragma once

#include <vector>

#include "scenes/scenario.h"

namespace retrolux {

// The greatest error of a point reconstructed by two cameras, over their separation angle: a cubic
// spline through known points, symmetric about 90 degrees. The points are mirrored there, so the
// slope at 90 degrees is zero. Below the first point (angle psi_0, error e_0) the curve goes on as
// e_0 sin(psi_0 / 2) / sin(psi / 2): the long half-diagonal of two crossing strips of image. The
// spline ends with the slope of that continuation, so the whole curve is smooth (C1 at psi_0, C2
// between).
class ReconstructionError {
 public:
  // Three points or more, by ascending angles in (0, 90] degrees, errors positive, and gamma_max_mm
  // (the error at which the weight becomes zero) above the least of them. LoadScenario() sees to
  // it; here anything else is our own fault.
  ReconstructionError(const std::vector<ErrorPoint>& points, double gamma_max_mm);

  // Infinite at psi = 0 and pi.
  double Error_mm(double psi) const;
  // 1 - error / gamma_max, never below zero.
  double Weight(double psi) const;

 private:
  double Spline(double psi) const;

  double gamma_max_mm_;
  // Knots of the spline, mirrored ones included, and what it has there.
  std::vector<double> angles_, errors_, second_derivatives_;
};

// The separation angle at which the weighted area that two cameras share on a sphere is greatest.
// Each sees a cap of `cap_half_angle`: acos(radius / distance), pi / 2 for the thesis's unit
// sphere. To about 1e-7 rad: the best of a degree's steps, then a golden section between its
// neighbours.
double SphereOptimalAngle(const ReconstructionError& error, double cap_half_angle);

// The gamma_max with which SphereOptimalAngle is `optimal_angle`, by bisection: the more error is
// allowed, the smaller the optimal angle. InputError if no gamma_max gives that angle.
double CalibrateGammaMax(const std::vector<ErrorPoint>& points, double optimal_angle,
                         double cap_half_angle);

}  // namespace retrolux
