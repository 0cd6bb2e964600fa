#include "classifier/constellation.h"

#include <set>

#include "core/json_reader.h"

namespace retrolux {

namespace {

constexpr const char* kSchema = "retrolux/constellation-1";
constexpr double kFar_mm = 1e5;

int NumberOf(const JsonReader& json, const MarkerSet& markers) {
  if (json.IsString() && json.AsString() == "standard") return 0;
  std::vector<std::string> numbers;
  for (const MarkerShape& shape : markers.shapes) {
    if (shape.number == 0) continue;
    numbers.push_back(std::to_string(shape.number));
    if (json.Raw().is_number_integer() && json.Raw() == shape.number) return shape.number;
  }
  json.Fail(json.Raw().dump(), JoinNames(numbers) + " or \"standard\"");
}

KnownMarker ReadMarker(JsonReader json, const MarkerSet& markers) {
  KnownMarker marker;
  marker.name = json.String("name");
  marker.number = NumberOf(json.Child("marker"), markers);
  marker.at = json.Vector3("at_mm");
  if (marker.at.norm() > kFar_mm) {
    json.Child("at_mm").Fail(fmt::format("{:g} mm from the origin", marker.at.norm()),
                             fmt::format("at most {:g}", kFar_mm));
  }
  if (json.Has("normal")) {
    const Vec3d normal = json.Vector3("normal");
    if (!(normal.norm() > 0.0)) json.Child("normal").Fail("no direction", "an outward normal");
    marker.normal = normal.normalized();
  }
  json.Finish();
  return marker;
}

}  // namespace

Vec3d ShapeCentre(const MarkerShape& shape) {
  const Vec2d centre = Centroid(shape.outline_mm);
  return {centre.x(), centre.y(), 0.0};
}

Constellation ReadConstellation(const std::filesystem::path& file, const MarkerSet& markers) {
  JsonReader json = JsonReader::FromFile(file);
  json.Schema(kSchema);
  for (const char* unread : {"version", "units", "pixel_origin", "comment"}) json.Has(unread);
  Constellation constellation;
  std::set<std::string> names;
  const JsonReader list = json.Child("markers");
  for (size_t i = 0; i < list.Size(); ++i) {
    constellation.push_back(ReadMarker(list.Child(i), markers));
    const std::string& name = constellation.back().name;
    if (!names.insert(name).second)
      list.Child(i).Fail(fmt::format("the name '{}' again", name), "names that differ");
  }
  json.Finish();
  return constellation;
}

nlohmann::ordered_json ConstellationJson(const Constellation& constellation) {
  nlohmann::ordered_json json = {{"schema", kSchema},
                                 {"version", RETROLUX_VERSION},
                                 {"units", "mm"},
                                 {"pixel_origin", "center"},
                                 {"markers", nlohmann::ordered_json::array()}};
  for (const KnownMarker& marker : constellation) {
    nlohmann::ordered_json entry;
    entry["name"] = marker.name;
    entry["marker"] = marker.number;
    if (marker.number == 0) entry["marker"] = "standard";
    entry["at_mm"] = {marker.at.x(), marker.at.y(), marker.at.z()};
    if (marker.normal)
      entry["normal"] = {marker.normal->x(), marker.normal->y(), marker.normal->z()};
    json["markers"].push_back(std::move(entry));
  }
  return json;
}

}  // namespace retrolux
