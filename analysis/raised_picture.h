// A sensor's picture as people can look at it.
#pragma once

#include "core/plane.h"

namespace retrolux {

// Dark levels raised (gamma 2.2 of the digital numbers), so that the mask is seen; 8 bits.
DigitalImage DarkLevelsRaised(DigitalImage image);

}  // namespace retrolux
