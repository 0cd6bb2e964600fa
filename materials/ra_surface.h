// A measured table of R_A as a function of any two directions.
#pragma once

#include <functional>

#include "materials/ra_table.h"

namespace retrolux {

// f(wo, wi), 1/sr, that reproduces a table of R_A at its points; reciprocal, and round about wo.
//
// It is interpolated as ln f, with f = R_A / (cos beta cos nu) and the viewing angle nu, in the two
// variables
//   t = ln(|wo - wi|^2 + c^2)         |wo - wi| = 2 sin(alpha / 2); c of 1.5 times the smallest
//                                     observation angle
//   x = 1 - (cos beta + cos nu) / 2   symmetric in both angles, near beta^2 / 2
// A bead's lobe is a power law far out and flat in its core, and so is exp(linear in t): one
// variable goes on below the smallest observation angle (finite) and beyond the largest (a power
// law). ln f is linear in x where R_A falls as a Gaussian of the entrance angle. A value belongs to
// the x of the geometry that it was measured in, so that the table comes back exactly.
// Between points ln f is linear in t and, along each row of one observation angle, in x. At smaller
// x than a row's first f is constant; beyond its last all rows fall alike, by the mean of their
// last slopes, so that the lobe keeps its shape; f never rises there, and R_A goes to 0 at grazing.
class RaSurface {
 public:
  // `rest(wo, wi)`: f of what else the sheet reflects, 1/sr; it is taken off the table. InputError
  // if it is more than the table has.
  using Rest = std::function<double(const Vec3f& wo, const Vec3f& wi)>;
  RaSurface(const RaTable& table, const Rest& rest);

  float T(const Vec3f& wo, const Vec3f& wi) const {
    return std::log((wo - wi).squaredNorm() + core2_);
  }
  float LeastT() const { return std::log(core2_); }
  // The squared distance |wo - wi|^2 that has this t.
  double Distance2(double t) const { return std::exp(t) - static_cast<double>(core2_); }
  static float X(float cos_o, float cos_i) { return 1.0f - 0.5f * (cos_o + cos_i); }
  // 1/sr.
  float At(float t, float x) const;

 private:
  struct Row {
    float t;
    std::vector<float> x, ln_f;
  };
  float LnFInRow(const Row& row, float x) const;

  float core2_;
  std::vector<Row> rows_;
  float last_slope_ = 0.0f;  // d ln f / d x beyond the tables' last points, not above 0
};

// How well the table's points follow from their neighbours: the interpolation without one row (one
// column) against the values that it held, for the rows (columns) that have neighbours on both
// sides. Of ln R_A; a range is half of the step from one neighbour to the other, what is known
// without any rule of interpolation. Zero where there are no such points.
struct LeaveOneOut {
  double rms = 0.0, largest = 0.0, rms_range = 0.0;
};
LeaveOneOut LeaveOneOutObservation(const RaTable& table);
LeaveOneOut LeaveOneOutEntrance(const RaTable& table);

}  // namespace retrolux
