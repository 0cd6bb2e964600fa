// A picture of one channel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace retrolux {

// Row-major, top row first. (x, y) is (column, row).
template <typename T>
struct Plane {
  int width = 0;
  int height = 0;
  std::vector<T> data;

  Plane() = default;
  Plane(int width_px, int height_px, T value = T{})
      : width(width_px),
        height(height_px),
        data(static_cast<size_t>(width_px) * static_cast<size_t>(height_px), value) {}

  T& operator()(int x, int y) { return data[Index(x, y)]; }
  const T& operator()(int x, int y) const { return data[Index(x, y)]; }
  size_t Index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  }
  bool Contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
};

using FloatPlane = Plane<float>;
using IdPlane = Plane<uint32_t>;

// A digital picture: numbers of an ADC of `bits` bits.
struct DigitalImage {
  Plane<uint16_t> dn;
  int bits = 8;
};

}  // namespace retrolux
