#include "renderer/marker_truth.h"

#include <cmath>

#include "renderer/pixel_spread.h"

namespace retrolux {

namespace {

constexpr int kGrid = 24;             // points an axis over the square
constexpr double kOutlineStep = 0.5;  // mm

}  // namespace

std::optional<SurfaceHit> OntoSurface(const RayScene& rays, const PlacedMarker& marker,
                                      const Vec2d& x_in_marker) {
  // Through what lies over the marker: cables, plates.
  constexpr int kMostOver = 16;
  const double reach = 2.0 * marker.half_size_mm;
  Vec3f start =
      (marker.marker_from_world.Inverse() * Vec3d(x_in_marker.x(), x_in_marker.y(), reach))
          .cast<float>();
  const Vec3f down = (-marker.NormalInWorld()).cast<float>();
  auto left = static_cast<float>(2.0 * reach);
  for (int i = 0; i < kMostOver; ++i) {
    const auto hit = rays.Intersect(start, down, left);
    if (!hit || hit->body == marker.object) return hit;
    const Vec3f behind = OffSurface(hit->position, down);
    left -= (behind - start).norm();
    start = behind;
  }
  return std::nullopt;
}

bool IsSeen(const RayScene& rays, const CameraModel& camera, const Vec3d& position,
            const Vec3d& normal) {
  const Vec3d eye = camera.Centre();
  const auto px = camera.Project(position);
  if (!px || !camera.InFrame(*px) || normal.dot(eye - position) <= 0.0) return false;
  return !rays.Occluded(OffSurface(position.cast<float>(), normal.cast<float>()),
                        eye.cast<float>());
}

namespace {

std::vector<Vec3d> OutlineOnSurface(const RayScene& rays, const PlacedMarker& marker,
                                    const Polygon& outline, double step) {
  std::vector<Vec3d> points;
  for (size_t i = 0; i < outline.size(); ++i) {
    const Vec2d a = outline[i], b = outline[(i + 1) % outline.size()];
    const int pieces =
        step > 0.0 ? std::max(1, static_cast<int>(std::ceil((b - a).norm() / step))) : 1;
    for (int k = 0; k < pieces; ++k) {
      const Vec2d place = a + (b - a) * k / pieces;
      if (const auto hit = OntoSurface(rays, marker, place))
        points.push_back(hit->position.cast<double>());
    }
  }
  return points;
}

}  // namespace

MarkerSurface SampleMarkerSurface(const RayScene& rays, const PlacedMarker& marker) {
  MarkerSurface surface;
  surface.centre = marker.CentreInWorld();
  surface.normal = marker.NormalInWorld();
  surface.corners = OutlineOnSurface(rays, marker, marker.shape->outline_mm, 0.0);
  surface.outline = OutlineOnSurface(rays, marker, marker.shape->outline_mm, kOutlineStep);
  const double s = marker.half_size_mm;
  surface.square =
      OutlineOnSurface(rays, marker, {{-s, -s}, {s, -s}, {s, s}, {-s, s}}, kOutlineStep);
  const double cell = 2.0 * s / kGrid;
  for (int i = 0; i < kGrid; ++i) {
    for (int j = 0; j < kGrid; ++j) {
      const Vec2d place(-s + (i + 0.5) * cell, -s + (j + 0.5) * cell);
      if (!marker.IsBright(place)) continue;
      const auto hit = OntoSurface(rays, marker, place);
      if (!hit) continue;
      const Vec3d normal = hit->geometric_normal.cast<double>();
      surface.points.push_back(
          {hit->position.cast<double>(), normal, cell * cell / normal.dot(surface.normal)});
    }
  }
  return surface;
}

namespace {

Polygon ProjectAll(const CameraModel& camera, const std::vector<Vec3d>& points) {
  Polygon projected;
  for (const Vec3d& p : points) {
    if (const auto px = camera.Project(p)) projected.push_back(*px);
  }
  return projected;
}

void MeasureVisibility(const MarkerSurface& surface, const RayScene& rays,
                       const CameraModel& camera, MarkerView& view) {
  const Vec3d eye = camera.Centre();
  double total = 0.0, visible = 0.0, in_frame = 0.0, facing = 0.0;
  for (const MarkerSurface::Point& point : surface.points) {
    total += point.area_mm2;
    const auto px = camera.Project(point.position);
    if (px && camera.InFrame(*px)) in_frame += point.area_mm2;
    if (point.normal.dot(eye - point.position) > 0.0) facing += point.area_mm2;
    if (IsSeen(rays, camera, point.position, point.normal)) visible += point.area_mm2;
  }
  if (total <= 0.0) return;
  view.visible_fraction = visible / total;
  view.in_frame_fraction = in_frame / total;
  view.facing_fraction = facing / total;
}

}  // namespace

MarkerView ViewMarker(const MarkerSurface& surface, const RayScene& rays,
                      const CameraModel& camera) {
  MarkerView view;
  const Vec3d to_camera = camera.Centre() - surface.centre;
  view.distance_mm = to_camera.norm();
  view.incidence_deg = DegFromRad(
      std::acos(std::clamp(surface.normal.dot(to_camera) / view.distance_mm, -1.0, 1.0)));
  view.corners_px = ProjectAll(camera, surface.corners);
  view.outline_px = ProjectAll(camera, surface.outline);
  view.centroid_projected_px = camera.Project(surface.centre);
  if (view.outline_px.size() >= 3 && std::abs(SignedArea(view.outline_px)) > 1e-9) {
    view.centroid_outline_px = Centroid(view.outline_px);
  }
  view.in_frame = !view.outline_px.empty() && view.outline_px.size() == surface.outline.size();
  for (const Vec2d& px : view.outline_px) view.in_frame = view.in_frame && camera.InFrame(px);
  MeasureVisibility(surface, rays, camera, view);
  return view;
}

std::optional<Vec2d> RadiometricCentroid(const Film& film, uint32_t instance,
                                         const SensorSpec& sensor) {
  Vec2d moment = Vec2d::Zero();
  double sum = 0.0;
  for (size_t rank = 0; rank < film.marker_id.size(); ++rank) {
    for (int y = 0; y < film.electrons.height; ++y) {
      for (int x = 0; x < film.electrons.width; ++x) {
        if (film.marker_id[rank](x, y) != instance) continue;
        const auto electrons = static_cast<double>(film.marker_electrons[rank](x, y));
        sum += electrons;
        moment += electrons * Vec2d(x, y);
      }
    }
  }
  if (sum <= 0.0) return std::nullopt;
  return moment / sum + Vec2d(0.0, LineOffset_px(sensor));
}

}  // namespace retrolux
