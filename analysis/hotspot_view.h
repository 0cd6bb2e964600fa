// What the study of hot spots keeps of a camera for people.
#pragma once

#include <string>
#include <vector>

#include "analysis/hotspot_rows.h"

namespace retrolux {

struct HotspotPicture {
  std::string kind;  // "own", "both", "neighbours"
  std::string file;  // relative to the study's folder
};

// A camera of a room; "neighbours" are all its other rings.
struct HotspotRoomView {
  std::string camera;
  HotspotRow row;
  std::vector<HotspotPicture> pictures;
};

}  // namespace retrolux
