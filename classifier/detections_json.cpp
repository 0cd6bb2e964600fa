#include "classifier/detections_json.h"

#include "core/atomic_file.h"

namespace retrolux {

namespace {

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
  json["confidence"] = detection.confidence;
  json["method"] = method;
  json["straight_edges"] = detection.straight_edges;
  json["area_px"] = detection.area_px;
  return json;
}

}  // namespace

Json DetectionsJson(const std::string& method, const std::vector<PictureDetections>& pictures) {
  Json json;
  json["schema"] = "retrolux/detections-1";
  json["version"] = RETROLUX_VERSION;
  json["pixel_origin"] = "center";
  json["units"] = {{"corners_px", "px"}, {"centroid_px", "px"}, {"area_px", "px^2"}};
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

}  // namespace retrolux
