// The light of one ring-lit camera in the picture of another, in closed form: what the study of hot
// spots is held against.
//
// Two cameras with rings a and b look at a convex surface. A mirror-like highlight lies where the
// normal bisects the directions to lamp and eye. Seen by a in its own light that is where the
// normal points at a. Seen by a in the light of b, and by b in the light of a, it is one and the
// same point (the condition does not change when lamp and eye change places): this cross highlight
// is a landmark of the surface to both cameras, and triangulates on it, as a marker does. The two
// own highlights are different points, each on the normal that goes through its camera: their rays
// meet where these normals do, at the centre of curvature, a radius behind the surface.
#pragma once

#include "scenes/scene.h"

namespace retrolux {

// The point of a sphere where light from `a` is mirrored to `b` (Alhazen's problem, by iteration:
// the normal is the half vector at the point that it leads to). Both must lie outside the sphere,
// far enough that the point sees them (several radii).
Vec3d SphereHighlight(const Vec3d& centre, double radius_mm, const Vec3d& a, const Vec3d& b);

// BSDF of a GGX coat where its facets face the half vector, at its greatest for smooth coats, with
// lamp and eye `psi_deg` apart and symmetric about the normal (docs/physics.md, section 4), 1/sr:
//   F(psi/2) / (4 pi alpha^2 cos^2(psi/2) sqrt(1 + alpha^2 tan^2(psi/2)))
// F unpolarised, by Fresnel's formulae.
double HighlightBrdf(double ior, double alpha, double psi_deg);

// Irradiance of a camera's ring on a surface at x with that unit normal, over the whole spectrum of
// its diodes, W/m2: sum over the diodes of I0 cos^m(theta) cos(beta) / d^2. Without shadows.
double RingIrradiance_w_m2(const CameraSpec& camera, const Vec3d& x, const Vec3d& normal);

// The angle between two cameras, seen from `x`, degrees.
double Separation_deg(const CameraModel& a, const CameraModel& b, const Vec3d& x = Vec3d::Zero());

}  // namespace retrolux
