#include "analysis/bop.h"

#include "core/atomic_file.h"
#include "core/image_file.h"
#include "core/marker_set.h"

namespace retrolux {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

Json RowByRow(const Mat3d& r) {
  return {r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)};
}

Json Numbers(const Vec3d& v) {
  return {v.x(), v.y(), v.z()};
}

// BOP's boxes: x, y, width, height of whole pixels; -1 for none.
Json Box(const MaskPlane& mask) {
  const MaskBounds b = BoundsOf(mask);
  if (b.width == 0) return {-1, -1, -1, -1};
  return {b.x0, b.y0, b.width, b.height};
}

void WriteMask(const fs::path& file, const MaskPlane& mask) {
  DigitalImage image;
  image.dn = Plane<uint16_t>(mask.width, mask.height);
  for (size_t i = 0; i < mask.data.size(); ++i) image.dn.data[i] = mask.data[i] != 0 ? 255 : 0;
  WriteTextFile(file, EncodeGreyPng(image));
}

Json Camera(const DatasetPicture& picture) {
  const CameraModel& m = picture.model;
  const std::array<double, 5> d = m.distortion.Coefficients();
  return {{"cam_K", {m.fx, 0, m.cx, 0, m.fy, m.cy, 0, 0, 1}},
          {"depth_scale", 1.0},
          {"cam_R_w2c", RowByRow(m.camera_from_world.rotation)},
          {"cam_t_w2c", Numbers(m.camera_from_world.translation)},
          // Beside what BOP asks for:
          {"distortion", std::vector<double>(d.begin(), d.end())},
          {"width", m.width},
          {"height", m.height},
          {"camera", picture.camera},
          {"pixel_origin", "center"},
          {"units", "px, mm"}};
}

Json Pose(const MarkerLabel& label) {
  Json corners = Json::array(), px = Json::array(), visibility = Json::array();
  for (const MarkerKeypoint& corner : label.corners) {
    corners.push_back(Numbers(corner.in_marker));
    px.push_back(corner.px ? Json{corner.px->x(), corner.px->y()} : Json());
    visibility.push_back(static_cast<int>(corner.visibility));
  }
  return {{"cam_R_m2c", RowByRow(label.camera_from_marker.rotation)},
          {"cam_t_m2c", Numbers(label.camera_from_marker.translation)},
          {"obj_id", label.number + 1},
          {"instance", label.instance},
          {"corners_in_marker_mm", corners},
          {"corners_px", px},
          {"corners_visibility", visibility}};
}

Json PoseInfo(const MarkerLabel& label, const MaskPlane& visible, const MaskPlane& amodal) {
  return {{"bbox_obj", Box(amodal)},
          {"bbox_visib", Box(visible)},
          {"px_count_all", label.amodal.Area()},
          {"px_count_valid", label.amodal.Area()},
          {"px_count_visib", label.visible.Area()},
          {"visib_fract", label.visible_fraction}};
}

void WriteScene(const DatasetScene& scene, const fs::path& from, const fs::path& to) {
  for (const char* name : {"gray", "mask", "mask_visib"}) EnsureWritableFolder(to / name);
  Json cameras = Json::object(), poses = Json::object(), infos = Json::object();
  for (size_t i = 0; i < scene.pictures.size(); ++i) {
    const DatasetPicture& picture = scene.pictures[i];
    const std::string image = std::to_string(i);
    WriteTextFile(to / "gray" / fmt::format("{:06}.png", i), ReadTextFile(from / picture.file));
    cameras[image] = Camera(picture);
    poses[image] = infos[image] = Json::array();
    for (size_t k = 0; k < picture.markers.size(); ++k) {
      const MarkerLabel& label = picture.markers[k];
      const MaskPlane visible = DecodeRuns(label.visible), amodal = DecodeRuns(label.amodal);
      poses[image].push_back(Pose(label));
      infos[image].push_back(PoseInfo(label, visible, amodal));
      const std::string file = fmt::format("{:06}_{:06}.png", i, k);
      WriteMask(to / "mask" / file, amodal);
      WriteMask(to / "mask_visib" / file, visible);
    }
  }
  WriteTextFile(to / "scene_camera.json", cameras.dump(1) + "\n");
  WriteTextFile(to / "scene_gt.json", poses.dump(1) + "\n");
  WriteTextFile(to / "scene_gt_info.json", infos.dump(1) + "\n");
}

Json DatasetInfo(const DatasetIndex& index) {
  Json objects = Json::object();
  for (const MarkerShape& shape : DefaultMarkerSet().shapes)
    objects[std::to_string(shape.number + 1)] = shape.name;
  return {
      {"name", index.header.at("name")},
      {"version", index.header.at("version")},
      {"licence", index.header.at("licence")},
      {"pixel_origin", "center"},
      {"units", "px, mm"},
      {"axes",
       "camera: x right, y down, z forward; marker: z along the outward normal, x right and y up "
       "seen from outside; pixel (0, 0) is the centre of the top-left pixel (cam_K, corners_px); "
       "boxes: first column, first row, columns, rows"},
      {"distortion", "k1 k2 p1 p2 k3 of OpenCV, in scene_camera.json; BOP itself knows cam_K only"},
      {"visib_fract",
       "share of the bright surface in mm2, not of pixels: px_count_* count pixel centres"},
      {"objects", objects}};
}

}  // namespace

std::vector<fs::path> ExportBop(const DatasetIndex& index, const fs::path& folder) {
  const fs::path bop = folder / "bop";
  EnsureWritableFolder(bop);
  WriteTextFile(bop / "dataset_info.json", DatasetInfo(index).dump(1) + "\n");
  std::vector<fs::path> folders;
  for (size_t i = 0; i < index.scenes.size(); ++i) {
    folders.push_back(bop / index.scenes[i].split / fmt::format("{:06}", i));
    WriteScene(index.scenes[i], folder, folders.back());
  }
  return folders;
}

}  // namespace retrolux
