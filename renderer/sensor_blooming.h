// Blooming: charge above the full well flows up and down its column until it finds room.
//
// A well above its capacity gives half of the excess to either neighbour, which may then be above
// its own. The end of this does not depend on the order (the divisible sandpile; Levine and Peres,
// Potential Analysis 30, 2009). At the ends of the column nothing flows out.
#pragma once

#include "core/plane.h"
#include "scenes/scene.h"

namespace retrolux {

// Levels each column of charges (e-). Before it flows, the share `drained` of what is above the
// full well goes to the anti-blooming drain; charge that finds no room in its whole column is lost.
// All else is kept.
void Bloom(const Blooming& blooming, double full_well_e, Plane<double>& charge_e);

}  // namespace retrolux
