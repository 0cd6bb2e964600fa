// The rigid transform between two sets of corresponding points, and how far it can be trusted.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/transform.h"

namespace retrolux {

// The same point in two frames, mm. A weight counts the squares of its distance: the inverse of the
// variance of its errors, but for a factor that all share.
struct PointPair {
  Vec3d in_a = Vec3d::Zero(), in_b = Vec3d::Zero();
  double weight = 1.0;
};

struct Registration {
  RigidTransform b_from_a;
  // Fiducial registration error: root of the weighted mean of the squared distances that are left.
  double fre_mm = 0.0;
};

// Why the pairs fix no transform: fewer than three, weights that are not positive, points on a line
// to within a thousandth of their spread. Nothing if they do.
std::optional<std::string> RegistrationFault(std::span<const PointPair> pairs);

// The least weighted sum of squared distances, by the singular values of the cross-covariance; a
// reflection is never taken (Umeyama, IEEE PAMI 13(4), 1991; with Horn's quaternions of 1987 the
// same optimum). InputError with RegistrationFault.
Registration RegisterPoints(std::span<const PointPair> pairs);

// What localisation errors of the points leave and do. FLE: root of the expected squared distance
// of a point of mean weight, mm, the same in all directions; variances go with 1 / weight.
//
// Expected FRE of N points: FLE sqrt(1 - 2 / N) (Sibson, J. R. Stat. Soc. B 41(2), 1979; with such
// weights the N - 2 stays, for three coordinates of N points less six of the transform are left).
double ExpectedFre_mm(double fle_mm, size_t points);
// The other way round: FLE from a measured FRE.
double FleFromFre_mm(double fre_mm, size_t points);
// Expected target registration error, root of the mean square, at a point of frame a:
//   TRE^2 = FLE^2 / N (1 + 1/3 sum over the principal axes k of d_k^2 / f_k^2)
// with d_k the target's distance from axis k and f_k the points' rms distance (Fitzpatrick, West,
// Maurer, IEEE TMI 17(5), 1998), centre, axes and f_k weighted as the points are.
double ExpectedTre_mm(std::span<const PointPair> pairs, double fle_mm, const Vec3d& target_in_a);

// Angle of a rotation, rad, 0 to pi.
double RotationAngle(const Mat3d& rotation);

}  // namespace retrolux
