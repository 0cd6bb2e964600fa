#include "renderer/sensor_fields.h"

namespace retrolux {

Plane<double> WeaveFields(const Plane<double>& first_e, const Plane<double>& second_e) {
  Plane<double> picture(first_e.width, first_e.height);
  for (int y = 0; y < picture.height; ++y) {
    const Plane<double>& field = y % 2 == 0 ? first_e : second_e;
    for (int x = 0; x < picture.width; ++x)
      picture(x, y) = field(x, y) + (y + 1 < picture.height ? field(x, y + 1) : 0.0);
  }
  return picture;
}

}  // namespace retrolux
