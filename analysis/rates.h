// How fast this machine does what a picture is made of, each rate beside a limit that was measured
// in the same run.
#pragma once

#include <string>
#include <vector>

#include "core/parallel.h"

namespace retrolux {

struct Rate {
  std::string name, unit;  // of what is counted, e.g. "rays"
  int threads = 1;
  double per_second = 0.0;
  std::string limit;  // what it is held against; empty: it is itself a limit
  double limit_per_second = 0.0;
  double Share() const { return limit.empty() ? 1.0 : per_second / limit_per_second; }
};

// In the room of `ct-room`, with one camera of it; each loop runs for `seconds` at least, on one
// thread, and paths on `threads` too. `progress` counts loops. Writes and removes files in the
// folder for temporary files.
std::vector<Rate> MeasureRates(double seconds, int threads, Progress& progress);

}  // namespace retrolux
