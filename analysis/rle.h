// Masks of pixels as run lengths, in the form of COCO: the pixels column by column (top to bottom,
// then left to right), the lengths of the runs of 0 and 1 by turns, the first of 0s.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/plane.h"

namespace retrolux {

using MaskPlane = Plane<uint8_t>;  // 0 or 1

struct RunLengths {
  int width = 0, height = 0;
  std::vector<uint32_t> counts;

  // The number of 1s.
  int64_t Area() const;
};

RunLengths EncodeRuns(const MaskPlane& mask);
MaskPlane DecodeRuns(const RunLengths& runs);

// Columns [x0, x0 + width) and rows [y0, y0 + height) that hold all 1s; zeros if there are none.
struct MaskBounds {
  int x0 = 0, y0 = 0, width = 0, height = 0;
};
MaskBounds BoundsOf(const MaskPlane& mask);

// {"size": [height, width], "counts": "..."}: the counts as COCO's string, each as its difference
// from the one two before it (from the third on; signed), in groups of five bits, low ones first;
// 32 says that more follow, and 48 is added to make it a character.
nlohmann::json RunsToJson(const RunLengths& runs);
RunLengths RunsFromJson(const nlohmann::json& json);

}  // namespace retrolux
