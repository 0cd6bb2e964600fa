// Whether a dark marker lies on a bright square of its own.
#pragma once

#include "classifier/outline_map.h"
#include "core/plane.h"

namespace retrolux {

// Around a dark marker's bright square the mask is darker again. Share of 32 points around the
// square at which the picture is darker than just inside it by at least 0.3 of `contrast_dn`, that
// of ground over marker; points outside the picture are not counted, 0 if all are. `negative`: of
// the smoothed picture; `map`: of the marker onto its pixels; `square`: side of the bright square,
// of the marker's own square, above 1.
double DarkFrame(const FloatPlane& negative, const OutlineMap& map, double square,
                 double contrast_dn);

}  // namespace retrolux
