#include "classifier/tags.h"

#include <Eigen/LU>
#include <algorithm>

#include "classifier/debug_pictures.h"
#include "classifier/tag_libraries.h"
#include "core/error.h"
#include "core/tag_shape.h"

namespace retrolux {

namespace {

std::string NameOf(const TagFamily& family, int id) {
  return fmt::format("{}-{}", family.name, id);
}

const MarkerShape* ShapeOf(const TagFamily& family, int id, const MarkerSet& markers) {
  const std::string name = NameOf(family, id);
  for (const MarkerShape& shape : markers.shapes) {
    if (shape.name == name) return &shape;
  }
  return nullptr;
}

// The homography, last entry 1, that takes four points to four others.
Mat3d HomographyOf(const std::array<Vec2d, 4>& from, const std::array<Vec2d, 4>& to) {
  Eigen::Matrix<double, 8, 8> a;
  Eigen::Matrix<double, 8, 1> b;
  for (size_t i = 0; i < 4; ++i) {
    const double x = from[i].x(), y = from[i].y(), u = to[i].x(), v = to[i].y();
    const auto row = static_cast<Eigen::Index>(2 * i);
    a.row(row) << x, y, 1, 0, 0, 0, -u * x, -u * y;
    a.row(row + 1) << 0, 0, 0, x, y, 1, -v * x, -v * y;
    b.segment<2>(row) = to[i];
  }
  const Eigen::Matrix<double, 8, 1> h = a.fullPivLu().solve(b);
  Mat3d homography;
  homography << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], 1.0;
  return homography;
}

Vec2d Apply(const Mat3d& homography, const Vec2d& x) {
  return (homography * x.homogeneous()).hnormalized();
}

Detection DetectionOf(const TagFamily& family, const FoundTag& tag, const MarkerSet& markers) {
  const double size_mm = markers.size_mm;
  const Mat3d px_from_marker = HomographyOf(DarkSquare(family, size_mm), tag.corners_px);
  Detection detection;
  const double s = 0.5 * size_mm;
  for (const Vec2d& corner : Polygon{{-s, -s}, {s, -s}, {s, s}, {-s, s}})
    detection.corners_px.push_back(Apply(px_from_marker, corner));
  detection.centroid_px = Centroid(detection.corners_px);
  detection.straight_edges = 4;
  detection.area_px = std::abs(SignedArea(detection.corners_px));
  if (const MarkerShape* shape = ShapeOf(family, tag.id, markers)) {
    detection.marker = shape->number;
    detection.centre_px = Apply(px_from_marker, Vec2d::Zero());
    detection.confidence = 1.0;
  }
  return detection;
}

}  // namespace

const std::vector<TagFamily>& TagFamilies() {
  static const std::vector<TagFamily> families = {
#ifdef RETROLUX_APRILTAG
      AprilTag36h11(),
#endif
#ifdef RETROLUX_ARUCO
      Aruco4x4(),
#endif
  };
  return families;
}

const TagFamily* FindTagFamily(const std::string& name) {
  for (const TagFamily& family : TagFamilies()) {
    if (family.name == name) return &family;
  }
  return nullptr;
}

std::array<Vec2d, 4> DarkSquare(const TagFamily& family, double size_mm) {
  const double s = size_mm * (0.5 - 1.0 / family.cells);
  return {Vec2d(-s, -s), Vec2d(s, -s), Vec2d(s, s), Vec2d(-s, s)};
}

MarkerSet MakeTagSet(const TagFamily& family, const std::vector<int>& ids, double size_mm) {
  MarkerSet set;
  set.size_mm = set.dark_square_mm = size_mm;
  for (const int id : ids) {
    if (id < 1 || id >= family.count) {
      throw InputError(fmt::format("tag {} of {}; expected ids from 1 to {}", id, family.name,
                                   family.count - 1));
    }
    set.shapes.push_back(TagShape(id, NameOf(family, id), family.pattern(id), size_mm));
  }
  return set;
}

std::vector<Detection> IdentifyTags(const TagFamily& family, const DigitalImage& image,
                                    const MarkerSet& markers, const std::filesystem::path* debug) {
  const auto is_ours = [&](const MarkerShape& shape) {
    return shape.name.starts_with(family.name + "-");
  };
  if (std::none_of(markers.shapes.begin(), markers.shapes.end(), is_ours)) {
    throw InputError(fmt::format(
        "the marker set has no tag of {}; expected shapes named {}-ID, as `retrolux tags` makes",
        family.name, family.name));
  }
  const std::vector<FoundTag> found = family.finders.front().find(image);
  if (debug != nullptr) WriteDebugPictures(*debug, image, found);
  std::vector<Detection> detections;
  for (const FoundTag& tag : found) detections.push_back(DetectionOf(family, tag, markers));
  return detections;
}

Plane<uint8_t> EightBits(const DigitalImage& image) {
  Plane<uint8_t> plane(image.dn.width, image.dn.height);
  const int shift = std::max(image.bits - 8, 0);
  for (size_t i = 0; i < plane.data.size(); ++i)
    plane.data[i] = static_cast<uint8_t>(image.dn.data[i] >> shift);
  return plane;
}

}  // namespace retrolux
