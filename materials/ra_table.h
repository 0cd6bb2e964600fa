// Measured coefficients of retro-reflection over the angles of the goniometer.
#pragma once

#include <filesystem>
#include <vector>

#include "core/conventions.h"

namespace retrolux {

// R_A, cd/(lx m2) (the same number in 1/sr), on a full grid of observation angle alpha and entrance
// angle beta. All values are taken in the coplanar geometry of ASTM E810: the entrance angle is the
// component beta_1 of CIE 54.2, with beta_2 = 0; it counts as positive towards the observer, so
// that the viewing angle is |beta_1 - alpha|.
struct RaTable {
  std::vector<double> observation_deg;  // ascending, above 0
  std::vector<double> entrance_deg;     // ascending by size; negative: away from the observer
  std::vector<std::vector<double>> ra;  // [observation][entrance], above 0

  // A CSV of observation_deg,entrance_deg,ra_cd_lx_m2, a row for each pair, in any order; comments
  // say the source. InputError that names the file and what is missing or wrong.
  static RaTable FromFile(const std::filesystem::path& file);
};

// Directions of the coplanar geometry in the sheet's frame (z: its normal), unit vectors.
struct CoplanarDirections {
  Vec3d to_light, to_observer;
};
CoplanarDirections CoplanarAt(double observation_deg, double entrance_deg);

}  // namespace retrolux
