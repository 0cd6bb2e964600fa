// A known constellation: where the markers of a mask are, in the mask's frame.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/conventions.h"
#include "core/marker_set.h"

namespace retrolux {

struct KnownMarker {
  std::string name;          // unique
  int number = 0;            // in the marker set; 0: standard
  Vec3d at = Vec3d::Zero();  // the middle of the shape's area, mm in the mask's frame
  std::optional<Vec3d> normal = std::nullopt;  // unit, outwards
};

using Constellation = std::vector<KnownMarker>;

// The middle of the area of a marker's shape in the marker's frame: the point that a constellation
// and the triangulation are about. The origin of the frame is the middle of the shape's square,
// which no view can tell of a shape that looks the same turned (a triangle).
Vec3d ShapeCentre(const MarkerShape& shape);

// A file retrolux/constellation-1 (docs/file-formats.md). InputError with the place; names must
// differ, numbers must be in the set.
Constellation ReadConstellation(const std::filesystem::path& file, const MarkerSet& markers);
nlohmann::ordered_json ConstellationJson(const Constellation& constellation);

}  // namespace retrolux
