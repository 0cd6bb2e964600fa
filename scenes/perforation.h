// A perforated sheet, as thermoplastic masks are made of: round holes on a hexagonal lattice.
#pragma once

#include "core/conventions.h"

namespace retrolux {

// Before it is moulded the sheet is flat. It is laid onto the object from `axis` outwards, so that
// lengths along the great circles through the axis stay as they are: holes are round near the axis
// and narrower across those circles by sin(theta) / theta at the angle theta from it. All lengths
// of the flat sheet.
struct Perforation {
  // Hole and pitch of a "maxi" perforation, about 36 % open; sheets of 3.2 mm are as usual
  // (docs/assumptions.md).
  double diameter_mm = 3.0;
  double pitch_mm = 4.8;  // from the centre of a hole to that of the next
  // Oblique rays meet the walls of the holes, which scatter as the surface does. The object's
  // surface is the outer side.
  double thickness_mm = 2.4;
  Vec3d axis = Vec3d::UnitX();   // object frame
  Vec3d centre = Vec3d::Zero();  // object frame; what the sheet is laid around, mm

  // Area of the holes over that of the sheet, (pi / (2 sqrt 3)) (d / p)^2.
  double OpenShare() const;
};

// Where the holes are.
class HolePattern {
 public:
  explicit HolePattern(const Perforation& perforation);

  // Whether a straight line passes the sheet that meets its outer side at x: both ends of its way
  // through the sheet lie in the same hole. `direction` and the surface's outward `normal` are unit
  // vectors, all in the object frame.
  bool LetsPass(const Vec3d& x, const Vec3d& direction, const Vec3d& normal) const;

 private:
  Vec2d OnFlatSheet(const Vec3d& x) const;
  Vec2d NearestHole(const Vec2d& on_sheet) const;

  Perforation perforation_;
  Vec3d axis_, across_u_, across_v_;
};

}  // namespace retrolux
