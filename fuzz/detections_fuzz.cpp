// detections.json.
#include "classifier/detections_json.h"
#include "core/marker_set.h"
#include "fuzz/target.h"

namespace retrolux::fuzz {

void FuzzOne(std::string_view input) {
  Try([&] { ReadDetections(FileOf("detections.json", input), DefaultMarkerSet()); });
}

}  // namespace retrolux::fuzz
