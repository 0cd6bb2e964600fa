// Lobes of the back-vector model that come nearest to a measured table of R_A.
#pragma once

#include "materials/ra_table.h"
#include "materials/retro_lobe.h"

namespace retrolux {

// The model of materials/retroreflector.cpp without cover and body, in the table's own geometry:
//   R_A(alpha, beta) = w(beta) sum of the lobes' f cos(beta) cos(nu)
// with a free weight for each entrance angle but the first, whose is 1.
struct LobeFit {
  std::vector<RetroLobe> lobes;                // narrowest first
  std::vector<double> entrance_weight;         // of each entrance angle of the table
  double rms_ln_ra = 0.0;                      // over all points
  std::vector<std::vector<double>> residuals;  // ln(fit / table), [observation][entrance]
};

// Least squares of ln R_A by Levenberg-Marquardt from several starting widths; the best end.
// InputError if the table has fewer points than the model has parameters, or if no lobes come out
// that reflect less light than arrives.
LobeFit FitLobes(const RaTable& table, int lobes, FacetShape shape);

}  // namespace retrolux
