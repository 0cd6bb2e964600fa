#include "analysis/rle.h"

#include <algorithm>

#include "core/error.h"

namespace retrolux {

int64_t RunLengths::Area() const {
  int64_t area = 0;
  for (size_t i = 1; i < counts.size(); i += 2) area += counts[i];
  return area;
}

RunLengths EncodeRuns(const MaskPlane& mask) {
  RunLengths runs{mask.width, mask.height, {}};
  uint8_t value = 0;
  uint32_t length = 0;
  for (int x = 0; x < mask.width; ++x) {
    for (int y = 0; y < mask.height; ++y) {
      if (mask(x, y) != value) {
        runs.counts.push_back(length);
        length = 0;
        value = mask(x, y);
      }
      ++length;
    }
  }
  runs.counts.push_back(length);
  return runs;
}

MaskPlane DecodeRuns(const RunLengths& runs) {
  MaskPlane mask(runs.width, runs.height, 0);
  size_t place = 0;
  uint8_t value = 0;
  for (const uint32_t count : runs.counts) {
    RETROLUX_CHECK(place + count <= mask.data.size(), "runs of more than {} pixels",
                   mask.data.size());
    for (uint32_t i = 0; i < count; ++i, ++place) {
      const auto x = static_cast<int>(place / static_cast<size_t>(runs.height));
      const auto y = static_cast<int>(place % static_cast<size_t>(runs.height));
      mask(x, y) = value;
    }
    value ^= 1;
  }
  return mask;
}

MaskBounds BoundsOf(const MaskPlane& mask) {
  int x0 = mask.width, y0 = mask.height, x1 = -1, y1 = -1;
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      if (mask(x, y) == 0) continue;
      x0 = std::min(x0, x);
      x1 = std::max(x1, x);
      y0 = std::min(y0, y);
      y1 = std::max(y1, y);
    }
  }
  if (x1 < 0) return {};
  return {x0, y0, x1 - x0 + 1, y1 - y0 + 1};
}

nlohmann::json RunsToJson(const RunLengths& runs) {
  std::string text;
  for (size_t i = 0; i < runs.counts.size(); ++i) {
    int64_t rest = runs.counts[i];
    if (i > 2) rest -= runs.counts[i - 2];
    for (bool more = true; more;) {
      const int64_t group = rest & 31;
      rest >>= 5;  // arithmetic: the sign stays
      more = (group & 16) != 0 ? rest != -1 : rest != 0;
      text += static_cast<char>((group | (more ? 32 : 0)) + 48);
    }
  }
  return {{"size", {runs.height, runs.width}}, {"counts", text}};
}

RunLengths RunsFromJson(const nlohmann::json& json) {
  RunLengths runs{json.at("size").at(1).get<int>(), json.at("size").at(0).get<int>(), {}};
  const auto text = json.at("counts").get<std::string>();
  for (size_t p = 0; p < text.size();) {
    int64_t value = 0;
    int shift = 0;
    for (bool more = true; more && p < text.size(); ++p, shift += 5) {
      const int64_t group = text[p] - 48;
      value |= (group & 31) << shift;
      more = (group & 32) != 0;
      if (!more && (group & 16) != 0) value |= -(int64_t{1} << (shift + 5));
    }
    const size_t i = runs.counts.size();
    if (i > 2) value += runs.counts[i - 2];
    runs.counts.push_back(static_cast<uint32_t>(value));
  }
  return runs;
}

}  // namespace retrolux
