// Interlaced scan by field readout, as interline CCDs for video have it: a field adds the charges
// of two adjacent lines, and the pairs shift by one line from field to field.
#pragma once

#include "core/plane.h"

namespace retrolux {

// The picture of two fields, from the charges (e-) that the photosites hold at the end of each
// field's own exposure. Row y is the sum of the lines y and y + 1, of the first field for even y
// and of the second for odd y; below the last line there is none to add. So row y lies between
// the two lines: renderer/pixel_spread.h puts line y half a row above row y.
Plane<double> WeaveFields(const Plane<double>& first_e, const Plane<double>& second_e);

}  // namespace retrolux
