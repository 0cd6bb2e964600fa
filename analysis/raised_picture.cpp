#include "analysis/raised_picture.h"

#include <cmath>

namespace retrolux {

DigitalImage DarkLevelsRaised(DigitalImage image) {
  const double full_scale = (1 << image.bits) - 1;
  for (uint16_t& dn : image.dn.data)
    dn = static_cast<uint16_t>(std::lround(255.0 * std::pow(dn / full_scale, 1.0 / 2.2)));
  image.bits = 8;
  return image;
}

}  // namespace retrolux
