#include "core/marker_set.h"

#include <algorithm>
#include <cmath>

#include "core/data_path.h"
#include "core/json_reader.h"

namespace retrolux {

bool MarkerShape::Contains(const Vec2d& x_in_marker) const {
  return retrolux::Contains(outline_mm, x_in_marker) &&
         std::none_of(holes_mm.begin(), holes_mm.end(),
                      [&](const Polygon& hole) { return retrolux::Contains(hole, x_in_marker); });
}

double MarkerShape::Radius() const {
  double radius = 0.0;
  for (const Vec2d& corner : outline_mm) radius = std::max(radius, corner.norm());
  return radius;
}

const MarkerShape& MarkerSet::ByName(const std::string& name) const {
  std::vector<std::string> names;
  for (const MarkerShape& shape : shapes) {
    if (shape.name == name) return shape;
    names.push_back(shape.name);
  }
  throw InputError(
      fmt::format("marker '{}' is not in the set; expected one of {}", name, JoinNames(names)));
}

const MarkerShape& MarkerSet::ByNumber(int number) const {
  std::vector<std::string> numbers;
  for (const MarkerShape& shape : shapes) {
    if (shape.number == number) return shape;
    numbers.push_back(std::to_string(shape.number));
  }
  throw InputError(
      fmt::format("marker {} is not in the set; expected one of {}", number, JoinNames(numbers)));
}

std::optional<int> MarkerSet::NumberWithEdges(int straight_edges) const {
  for (const MarkerShape& shape : shapes) {
    if (shape.number > 0 && shape.straight_edges == straight_edges) return shape.number;
  }
  return std::nullopt;
}

namespace {

constexpr int kDiscCorners = 128;  // sagitta of a 7.5 mm disc: 2 um

Polygon Disc(double radius_mm) {
  Polygon corners;
  for (int i = 0; i < kDiscCorners; ++i) {
    const double angle = 2.0 * kPi * i / kDiscCorners;
    corners.emplace_back(radius_mm * std::cos(angle), radius_mm * std::sin(angle));
  }
  return corners;
}

// Corners within the square; at least three.
Polygon ReadCorners(JsonReader json, double size_mm) {
  Polygon polygon;
  for (size_t i = 0; i < json.Size(); ++i) {
    const std::vector<double> corner = json.Child(i).Numbers(2);
    polygon.emplace_back(corner[0], corner[1]);
    if (polygon.back().cwiseAbs().maxCoeff() > 0.5 * size_mm) {
      json.Child(i).Fail("a corner outside the square of the marker",
                         "coordinates within +- size_mm / 2");
    }
  }
  if (polygon.size() < 3) json.Fail("no outline", "at least three corners");
  return polygon;
}

MarkerShape ReadShape(JsonReader& json, double size_mm) {
  MarkerShape shape;
  shape.number = json.Integer("number", 0, 1000);
  shape.name = json.String("name");
  if (json.Has("radius_mm")) {
    shape.outline_mm = Disc(json.Number("radius_mm", 0.1, 0.5 * size_mm));
  } else {
    JsonReader corners = json.Child("outline_mm");
    shape.outline_mm = ReadCorners(corners, size_mm);
    if (!(SignedArea(shape.outline_mm) > 0.0)) {
      corners.Fail("no outline", "at least three corners, counter-clockwise, with an area");
    }
    shape.straight_edges = static_cast<int>(shape.outline_mm.size());
  }
  if (json.Has("holes_mm")) {
    JsonReader holes = json.Child("holes_mm");
    for (size_t i = 0; i < holes.Size(); ++i)
      shape.holes_mm.push_back(ReadCorners(holes.Child(i), size_mm));
  }
  json.Finish();
  return shape;
}

}  // namespace

MarkerSet ReadMarkerSet(const std::filesystem::path& file) {
  JsonReader json = JsonReader::FromFile(file);
  json.Schema("retrolux/markers-1");
  MarkerSet set;
  set.size_mm = json.Number("size_mm", 1.0, 1000.0);
  set.dark_square_mm = json.Number("dark_square_mm", set.size_mm, 1000.0, set.size_mm);
  JsonReader shapes = json.Child("shapes");
  for (size_t i = 0; i < shapes.Size(); ++i) {
    JsonReader entry = shapes.Child(i);
    set.shapes.push_back(ReadShape(entry, set.size_mm));
  }
  if (set.shapes.empty()) shapes.Fail("an empty list", "at least one shape");
  json.Finish();
  return set;
}

namespace {

nlohmann::json ToJson(const Polygon& polygon) {
  nlohmann::json corners = nlohmann::json::array();
  for (const Vec2d& corner : polygon) corners.push_back({corner.x(), corner.y()});
  return corners;
}

nlohmann::json ToJson(const MarkerShape& shape) {
  nlohmann::json json = {{"number", shape.number}, {"name", shape.name}};
  if (shape.straight_edges == 0) {
    json["radius_mm"] = shape.outline_mm.front().x();  // as Disc() has it, to the bit
  } else {
    json["outline_mm"] = ToJson(shape.outline_mm);
  }
  if (!shape.holes_mm.empty()) {
    json["holes_mm"] = nlohmann::json::array();
    for (const Polygon& hole : shape.holes_mm) json["holes_mm"].push_back(ToJson(hole));
  }
  return json;
}

}  // namespace

nlohmann::json ToJson(const MarkerSet& set) {
  nlohmann::json json = {{"schema", "retrolux/markers-1"},
                         {"size_mm", set.size_mm},
                         {"dark_square_mm", set.dark_square_mm},
                         {"shapes", nlohmann::json::array()}};
  for (const MarkerShape& shape : set.shapes) json["shapes"].push_back(ToJson(shape));
  return json;
}

const MarkerSet& DefaultMarkerSet() {
  static const MarkerSet set = ReadMarkerSet(DataPath("scenes/data/markers.json"));
  return set;
}

}  // namespace retrolux
