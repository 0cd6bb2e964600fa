#include "analysis/coco.h"

#include "core/atomic_file.h"
#include "core/marker_set.h"

namespace retrolux {

using Json = nlohmann::json;

namespace {

int CategoryOf(int number) {
  return number + 1;
}

Json Info(const DatasetIndex& index) {
  const Json& h = index.header;
  return {
      {"description", h.at("description")},
      {"version", h.at("version")},
      {"contributor", "retrolux"},
      {"url", ""},
      {"pixel_origin",
       "bbox and masks: COCO's, (0, 0) the top-left corner of the top-left pixel, so pixel i "
       "covers "
       "[i, i + 1]; keypoints and centroids: center, (0, 0) the centre of the top-left pixel: add "
       "0.5 for the frame of bbox (Detectron2 does so itself)"},
      {"units", "px, mm, deg, e-"},
      {"axes", "x right, y down"},
      {"image_folder", "images"}};
}

Json Categories() {
  Json categories = Json::array();
  for (const MarkerShape& shape : DefaultMarkerSet().shapes) {
    Json keypoints = Json::array(), skeleton = Json::array();
    for (int i = 0; i < shape.straight_edges; ++i) {
      keypoints.push_back(fmt::format("corner-{}", i + 1));
      skeleton.push_back({i + 1, (i + 1) % shape.straight_edges + 1});  // COCO counts from 1
    }
    categories.push_back({{"id", CategoryOf(shape.number)},
                          {"name", shape.name},
                          {"supercategory", "marker"},
                          {"keypoints", keypoints},
                          {"skeleton", skeleton}});
  }
  return categories;
}

// x, y, v for each; 0, 0, 0 where there is none.
Json Keypoints(const MarkerLabel& label, int& labelled) {
  Json numbers = Json::array();
  for (const MarkerKeypoint& corner : label.corners) {
    const bool is_there = corner.visibility != KeypointVisibility::kNone;
    labelled += is_there ? 1 : 0;
    numbers.push_back(is_there ? corner.px->x() : 0.0);
    numbers.push_back(is_there ? corner.px->y() : 0.0);
    numbers.push_back(static_cast<int>(corner.visibility));
  }
  return numbers;
}

Json PointOrNull(const std::optional<Vec2d>& px) {
  return px ? Json{px->x(), px->y()} : Json();
}

Json Annotation(const MarkerLabel& label, int id, int image) {
  const MaskBounds box = BoundsOf(DecodeRuns(label.visible));
  int labelled = 0;
  const Json keypoints = Keypoints(label, labelled);
  return {{"id", id},
          {"image_id", image},
          {"category_id", CategoryOf(label.number)},
          {"bbox", {box.x0, box.y0, box.width, box.height}},
          {"area", label.visible.Area()},
          {"iscrowd", 0},
          {"segmentation", RunsToJson(label.visible)},
          {"amodal", RunsToJson(label.amodal)},
          {"keypoints", keypoints},
          {"num_keypoints", labelled},
          {"instance", label.instance},
          {"polarity", label.dark ? "dark" : "bright"},
          {"centroid_projected_px", PointOrNull(label.centroid_projected_px)},
          {"centroid_outline_px", PointOrNull(label.centroid_outline_px)},
          {"centroid_radiometric_px", PointOrNull(label.centroid_radiometric_px)},
          {"visible_fraction", label.visible_fraction},
          {"incidence_deg", label.incidence_deg},
          {"distance_mm", label.distance_mm},
          {"size_px", label.size_px},
          {"snr", label.snr ? Json(*label.snr) : Json()}};
}

}  // namespace

Json CocoJson(const DatasetIndex& index, const std::string& split) {
  Json images = Json::array(), annotations = Json::array();
  for (const DatasetScene& scene : index.scenes) {
    if (scene.split != split) continue;
    for (const DatasetPicture& picture : scene.pictures) {
      const int image = static_cast<int>(images.size()) + 1;
      images.push_back({{"id", image},
                        {"file_name", std::filesystem::path(picture.file).filename().string()},
                        {"width", picture.model.width},
                        {"height", picture.model.height},
                        {"license", 1},
                        {"scene", scene.name},
                        {"camera", picture.camera}});
      for (const MarkerLabel& label : picture.markers) {
        if (label.visible.Area() == 0) continue;
        annotations.push_back(Annotation(label, static_cast<int>(annotations.size()) + 1, image));
      }
    }
  }
  return {{"info", Info(index)},
          {"licenses", {{{"id", 1}, {"name", index.header.at("licence")}, {"url", ""}}}},
          {"images", images},
          {"annotations", annotations},
          {"categories", Categories()}};
}

std::vector<std::filesystem::path> ExportCoco(const DatasetIndex& index,
                                              const std::filesystem::path& folder) {
  EnsureWritableFolder(folder / "coco");
  std::vector<std::filesystem::path> files;
  for (const auto& [split, counts] : index.header.at("splits").items()) {
    if (counts.at("pictures") == 0) continue;
    files.push_back(folder / "coco" / (split + ".json"));
    WriteTextFile(files.back(), CocoJson(index, split).dump() + "\n");
  }
  return files;
}

}  // namespace retrolux
