// Ranges of the methods' parameters.
#pragma once

#include <fmt/format.h>

#include "core/error.h"

namespace retrolux {

// InputError unless `value` is a number within `min` .. `max`.
inline void CheckOption(const char* method, const char* name, double value, double min,
                        double max) {
  if (value >= min && value <= max) return;
  throw InputError(
      fmt::format("method {}: {} = {}; expected {} to {}", method, name, value, min, max));
}

}  // namespace retrolux
