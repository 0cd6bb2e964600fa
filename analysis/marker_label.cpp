#include "analysis/marker_label.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace retrolux {

using Json = nlohmann::json;

namespace {

template <typename Vector>
Json Numbers(const Vector& v) {
  return std::vector<double>(v.data(), v.data() + v.size());
}

Json Numbers(const std::optional<Vec2d>& v) {
  return v ? Numbers(*v) : Json();
}

Json OrNull(const std::optional<double>& value) {
  return value ? Json(*value) : Json();
}

std::optional<Vec2d> Point(const Json& json) {
  if (json.is_null()) return std::nullopt;
  return Vec2d(json[0].get<double>(), json[1].get<double>());
}

std::optional<double> Number(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

Json RowByRow(const Mat3d& r) {
  return {r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)};
}

}  // namespace

Json MarkerLabel::ToJson() const {
  Json px = Json::array(), visibility = Json::array(), in_marker = Json::array();
  for (const MarkerKeypoint& corner : corners) {
    px.push_back(Numbers(corner.px));
    visibility.push_back(static_cast<int>(corner.visibility));
    in_marker.push_back(Numbers(corner.in_marker));
  }
  return {{"instance", instance},
          {"name", name},
          {"marker", number == 0 ? Json("standard") : Json(number)},
          {"polarity", dark ? "dark" : "bright"},
          {"corners_px", px},
          {"corners_visibility", visibility},
          {"corners_in_marker_mm", in_marker},
          {"centroid_projected_px", Numbers(centroid_projected_px)},
          {"centroid_outline_px", Numbers(centroid_outline_px)},
          {"centroid_radiometric_px", Numbers(centroid_radiometric_px)},
          {"visible_fraction", visible_fraction},
          {"incidence_deg", incidence_deg},
          {"distance_mm", distance_mm},
          {"in_frame", in_frame},
          {"size_px", size_px},
          {"signal_e", OrNull(signal_e)},
          {"background_e", OrNull(background_e)},
          {"snr", OrNull(snr)},
          {"visible_px", visible.Area()},
          {"mask_visible", RunsToJson(visible)},
          {"mask_amodal", RunsToJson(amodal)},
          {"R_camera_from_marker", RowByRow(camera_from_marker.rotation)},
          {"t_camera_from_marker_mm", Numbers(camera_from_marker.translation)}};
}

MarkerLabel MarkerLabel::FromJson(const Json& json) {
  MarkerLabel label;
  label.instance = json.at("instance");
  label.name = json.at("name");
  label.number = json.at("marker").is_string() ? 0 : json.at("marker").get<int>();
  label.dark = json.at("polarity") == "dark";
  for (size_t i = 0; i < json.at("corners_px").size(); ++i) {
    const Json& x = json.at("corners_in_marker_mm")[i];
    label.corners.push_back({Vec3d(x[0], x[1], x[2]), Point(json.at("corners_px")[i]),
                             json.at("corners_visibility")[i].get<KeypointVisibility>()});
  }
  label.centroid_projected_px = Point(json.at("centroid_projected_px"));
  label.centroid_outline_px = Point(json.at("centroid_outline_px"));
  label.centroid_radiometric_px = Point(json.at("centroid_radiometric_px"));
  label.visible_fraction = json.at("visible_fraction");
  label.incidence_deg = json.at("incidence_deg");
  label.distance_mm = json.at("distance_mm");
  label.in_frame = json.at("in_frame");
  label.size_px = json.at("size_px");
  label.signal_e = Number(json.at("signal_e"));
  label.background_e = Number(json.at("background_e"));
  label.snr = Number(json.at("snr"));
  label.visible = RunsFromJson(json.at("mask_visible"));
  label.amodal = RunsFromJson(json.at("mask_amodal"));
  const Json& r = json.at("R_camera_from_marker");
  for (Eigen::Index i = 0; i < 9; ++i)
    label.camera_from_marker.rotation(i / 3, i % 3) = r[static_cast<size_t>(i)];
  const Json& t = json.at("t_camera_from_marker_mm");
  label.camera_from_marker.translation = Vec3d(t[0], t[1], t[2]);
  return label;
}

double LongSide(const Polygon& points) {
  if (points.size() < 3) return 0.0;
  const Polygon hull = ConvexHull(points);
  double least_area = std::numeric_limits<double>::infinity(), side = 0.0;
  for (size_t i = 0; i < hull.size(); ++i) {
    const Vec2d along = (hull[(i + 1) % hull.size()] - hull[i]).normalized();
    const Vec2d across(-along.y(), along.x());
    Eigen::Array2d lo = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Array2d hi = -lo;
    for (const Vec2d& p : hull) {
      const Eigen::Array2d place(p.dot(along), p.dot(across));
      lo = lo.min(place);
      hi = hi.max(place);
    }
    const Eigen::Array2d size = hi - lo;
    if (size.prod() >= least_area) continue;
    least_area = size.prod();
    side = size.maxCoeff();
  }
  return side;
}

void FillPolygon(const Polygon& polygon, MaskPlane& mask) {
  if (polygon.size() < 3) return;
  for (int y = 0; y < mask.height; ++y) {
    std::vector<double> crossings;
    for (size_t i = 0; i < polygon.size(); ++i) {
      const Vec2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      if ((a.y() <= y) == (b.y() <= y)) continue;
      crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
    }
    std::sort(crossings.begin(), crossings.end());
    for (size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const double first = std::max(std::ceil(crossings[i]), 0.0);
      for (int x = static_cast<int>(std::min(first, 1e6)); x < mask.width && x < crossings[i + 1];
           ++x)
        mask(x, y) ^= 1;
    }
  }
}

}  // namespace retrolux
