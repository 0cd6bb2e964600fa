#include "classifier/detections_json.h"

#include <set>

#include "core/atomic_file.h"
#include "core/json_reader.h"

namespace retrolux {

namespace {

constexpr const char* kSchema = "retrolux/detections-1";

using Json = nlohmann::ordered_json;

Json Point(const Vec2d& px) {
  return Json::array({px.x(), px.y()});
}

Json DetectionJson(const std::string& method, const Detection& detection) {
  Json json;
  json["marker"] = nullptr;
  if (detection.marker) json["marker"] = *detection.marker;
  if (detection.marker == 0) json["marker"] = "standard";
  json["corners_px"] = Json::array();
  for (const Vec2d& corner : detection.corners_px) json["corners_px"].push_back(Point(corner));
  json["centroid_px"] = Point(detection.centroid_px);
  json["centre_px"] = nullptr;
  if (detection.centre_px) json["centre_px"] = Point(*detection.centre_px);
  json["confidence"] = detection.confidence;
  json["method"] = method;
  json["straight_edges"] = detection.straight_edges;
  json["area_px"] = detection.area_px;
  return json;
}

std::optional<int> MarkerOf(const JsonReader& json, const MarkerSet& markers) {
  if (json.Raw().is_null()) return std::nullopt;
  if (json.IsString() && json.AsString() == "standard") return 0;
  std::vector<std::string> names;
  for (const MarkerShape& shape : markers.shapes) {
    if (shape.number == 0) continue;
    names.push_back(std::to_string(shape.number));
    if (json.Raw().is_number_integer() && json.Raw() == shape.number) return shape.number;
  }
  json.Fail(json.Raw().dump(), JoinNames(names) + ", \"standard\" or null");
}

Vec2d PointOf(const JsonReader& json) {
  const std::vector<double> numbers = json.Numbers(2);
  return {numbers[0], numbers[1]};
}

Detection ReadDetection(JsonReader json, const MarkerSet& markers, std::set<std::string>& methods) {
  Detection detection;
  detection.marker = MarkerOf(json.Child("marker"), markers);
  detection.centroid_px = PointOf(json.Child("centroid_px"));
  if (json.Has("corners_px")) {
    const JsonReader corners = json.Child("corners_px");
    for (size_t i = 0; i < corners.Size(); ++i)
      detection.corners_px.push_back(PointOf(corners.Child(i)));
  }
  if (json.Has("centre_px") && !json.Child("centre_px").Raw().is_null())
    detection.centre_px = PointOf(json.Child("centre_px"));
  detection.confidence = json.Number("confidence", 0.0, 1.0, detection.marker ? 1.0 : 0.0);
  detection.straight_edges = json.Integer("straight_edges", 0, 1000, 0);
  detection.area_px = json.Number("area_px", 0.0, 1e9, 0.0);
  methods.insert(json.String("method", ""));
  json.Finish();
  return detection;
}

}  // namespace

Json DetectionsJson(const std::string& method, const std::vector<PictureDetections>& pictures) {
  Json json;
  json["schema"] = kSchema;
  json["version"] = RETROLUX_VERSION;
  json["pixel_origin"] = "center";
  json["units"] = {
      {"corners_px", "px"}, {"centroid_px", "px"}, {"centre_px", "px"}, {"area_px", "px^2"}};
  json["images"] = Json::array();
  for (const PictureDetections& picture : pictures) {
    Json image;
    image["file"] = picture.file;
    image["camera"] = picture.camera;
    image["detections"] = Json::array();
    for (const Detection& detection : picture.detections) {
      image["detections"].push_back(DetectionJson(method, detection));
    }
    json["images"].push_back(std::move(image));
  }
  return json;
}

void WriteDetections(const std::filesystem::path& file, const std::string& method,
                     const std::vector<PictureDetections>& pictures) {
  WriteTextFile(file, DetectionsJson(method, pictures).dump(1) + "\n");
}

DetectionsFile ReadDetections(const std::filesystem::path& file, const MarkerSet& markers) {
  JsonReader json = JsonReader::FromFile(file);
  json.Schema(kSchema);
  json.Choice("pixel_origin", {"center"});
  for (const char* unread : {"version", "units"}) json.Has(unread);
  DetectionsFile read;
  std::set<std::string> methods;
  const JsonReader images = json.Child("images");
  for (size_t i = 0; i < images.Size(); ++i) {
    JsonReader image = images.Child(i);
    PictureDetections picture{image.String("file"), image.String("camera", ""), {}};
    const JsonReader detections = image.Child("detections");
    for (size_t k = 0; k < detections.Size(); ++k)
      picture.detections.push_back(ReadDetection(detections.Child(k), markers, methods));
    image.Finish();
    read.pictures.push_back(std::move(picture));
  }
  json.Finish();
  if (methods.size() == 1) read.method = *methods.begin();
  return read;
}

}  // namespace retrolux
