// The set of markers that a system uses: shapes as data (scenes/data/markers.json).
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/polygon.h"

namespace retrolux {

// One shape in the marker frame: mm, origin at the centre of the 15 x 15 mm square, x right and y
// up when one looks at the marker from outside.
struct MarkerShape {
  int number = 0;  // 1 .. 6 for identifiable markers, 0 for the standard marker
  std::string name;
  Polygon outline_mm;      // corners, counter-clockwise; a disc is given by 128 corners
  int straight_edges = 0;  // 0 for a disc
  // Parts inside the outline that are not bright, any corners' order: the pattern of a tag.
  std::vector<Polygon> holes_mm = {};

  bool Contains(const Vec2d& x_in_marker) const;
  // Radius of the circle about the origin that holds the shape.
  double Radius() const;
};

struct MarkerSet {
  double size_mm = 0.0;         // side of the square that each shape fits into
  double dark_square_mm = 0.0;  // side of the bright square that a dark shape lies on
  std::vector<MarkerShape> shapes;

  // Side of the square that a marker takes.
  double Side_mm(bool dark) const { return dark ? dark_square_mm : size_mm; }
  // InputError that lists the known names or numbers.
  const MarkerShape& ByName(const std::string& name) const;
  const MarkerShape& ByNumber(int number) const;
  // The identifiable marker with that many straight edges, if there is one.
  std::optional<int> NumberWithEdges(int straight_edges) const;
};

MarkerSet ReadMarkerSet(const std::filesystem::path& file);
// The file that ReadMarkerSet reads (retrolux/markers-1).
nlohmann::json ToJson(const MarkerSet& set);

// scenes/data/markers.json
const MarkerSet& DefaultMarkerSet();

}  // namespace retrolux
