// Square tags, the fiducials of machine vision, as marker shapes.
#pragma once

#include <string>

#include "core/marker_set.h"
#include "core/plane.h"

namespace retrolux {

// A square with `side_mm` whose dark cells are holes. `bright`: n x n cells as one sees the tag
// upright, the quiet zone around it included; 0 is dark. Corners from the lower left one on.
//
// The holes are rectangles as large as the pattern allows, which may overlap: the fewer there are,
// the faster a point is looked up.
MarkerShape TagShape(int number, const std::string& name, const Plane<uint8_t>& bright,
                     double side_mm);

}  // namespace retrolux
