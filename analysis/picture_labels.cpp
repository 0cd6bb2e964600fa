#include "analysis/picture_labels.h"

#include <algorithm>

#include "analysis/signal_noise.h"

namespace retrolux {

namespace {

// The local background: farther from the bright outline than the first, not farther than the
// second, in columns or rows.
constexpr int kApart_px = 3;
constexpr int kAround_px = 8;

MaskPlane VisibleMask(const IdPlane& ids, uint32_t instance) {
  MaskPlane mask(ids.width, ids.height, 0);
  for (size_t i = 0; i < ids.data.size(); ++i) mask.data[i] = ids.data[i] == instance ? 1 : 0;
  return mask;
}

Polygon ProjectedSquare(const LabelledMarker& marker, const CameraModel& camera) {
  Polygon square;
  for (const Vec3d& p : marker.surface.square) {
    if (const auto px = camera.Project(p)) square.push_back(*px);
  }
  return square;
}

// Of a dark marker the square without the shape in it.
MaskPlane AmodalMask(const LabelledMarker& marker, const MarkerView& view,
                     const CameraModel& camera) {
  MaskPlane mask(camera.width, camera.height, 0);
  if (view.facing_fraction <= 0.0) return mask;
  FillPolygon(view.outline_px, mask);
  if (marker.placed.dark) FillPolygon(ProjectedSquare(marker, camera), mask);
  return mask;
}

bool HasAny(const MaskPlane& mask) {
  return std::any_of(mask.data.begin(), mask.data.end(), [](uint8_t v) { return v != 0; });
}

bool IsInside(const MaskPlane& mask, int x, int y) {
  for (int v = y - 1; v <= y + 1; ++v) {
    for (int u = x - 1; u <= x + 1; ++u) {
      if (!mask.Contains(u, v) || mask(u, v) == 0) return false;
    }
  }
  return true;
}

double Mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

// Of the visible pixels whose eight neighbours are visible too; of all, if there are none.
std::optional<double> InnerSignal(const MaskPlane& mask, const FloatPlane& electrons) {
  std::vector<double> inner, all;
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      if (mask(x, y) == 0) continue;
      all.push_back(static_cast<double>(electrons(x, y)));
      if (IsInside(mask, x, y)) inner.push_back(all.back());
    }
  }
  if (all.empty()) return std::nullopt;
  return Mean(inner.empty() ? all : inner);
}

// The median of the pixels around the amodal mask that show no part of any marker.
std::optional<double> BackgroundSignal(const MaskPlane& amodal, const Film& film) {
  const MaskBounds bounds = BoundsOf(amodal);
  const auto near = [&](int x, int y, int distance) {
    for (int v = y - distance; v <= y + distance; ++v) {
      for (int u = x - distance; u <= x + distance; ++u) {
        if (amodal.Contains(u, v) && amodal(u, v) != 0) return true;
      }
    }
    return false;
  };
  std::vector<double> values;
  const int x1 = std::min(bounds.x0 + bounds.width + kAround_px, amodal.width);
  const int y1 = std::min(bounds.y0 + bounds.height + kAround_px, amodal.height);
  for (int y = std::max(bounds.y0 - kAround_px, 0); y < y1; ++y) {
    for (int x = std::max(bounds.x0 - kAround_px, 0); x < x1; ++x) {
      if (film.marker_id[0](x, y) == 0 && !near(x, y, kApart_px) && near(x, y, kAround_px))
        values.push_back(static_cast<double>(film.electrons(x, y)));
    }
  }
  if (values.empty()) return std::nullopt;
  const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

MarkerKeypoint Keypoint(const LabelledMarker& marker, const std::optional<SurfaceHit>& corner,
                        const RayScene& rays, const CameraModel& camera) {
  if (!corner) return {};
  const Vec3d position = corner->position.cast<double>();
  MarkerKeypoint keypoint;
  keypoint.in_marker = marker.placed.marker_from_world * position;
  keypoint.px = camera.Project(position);
  if (!keypoint.px || !camera.InFrame(*keypoint.px)) return keypoint;
  const bool seen = IsSeen(rays, camera, position, corner->geometric_normal.cast<double>());
  keypoint.visibility = seen ? KeypointVisibility::kVisible : KeypointVisibility::kHidden;
  return keypoint;
}

void MeasureSignal(const MaskPlane& visible, const MaskPlane& amodal, const Film& film,
                   const SensorSpec& sensor, double exposure_s, MarkerLabel& label) {
  label.centroid_radiometric_px = RadiometricCentroid(film, label.instance, sensor);
  label.signal_e = InnerSignal(visible, film.electrons);
  label.background_e = BackgroundSignal(amodal, film);
  if (!label.signal_e || !label.background_e) return;
  // Of what is read: the charge of all lines of a row.
  label.snr = sensor.LinesPerRow() * (*label.signal_e - *label.background_e) /
              NoiseSigma_e(sensor, exposure_s, *label.signal_e);
}

void CheckMasks(const std::vector<MarkerLabel>& labels, const IdPlane& ids) {
  IdPlane painted(ids.width, ids.height, 0);
  for (const MarkerLabel& label : labels) {
    const MaskPlane mask = DecodeRuns(label.visible);
    for (size_t i = 0; i < mask.data.size(); ++i) {
      if (mask.data[i] != 0) painted.data[i] = label.instance;
    }
  }
  RETROLUX_CHECK(painted.data == ids.data, "the visible masks of {} labels are not id.marker",
                 labels.size());
}

}  // namespace

std::vector<LabelledMarker> LabelledMarkers(const Scene& scene, const RayScene& rays) {
  std::vector<LabelledMarker> markers;
  for (const PlacedMarker& placed : PlaceMarkers(scene)) {
    LabelledMarker marker{
        &scene.markers[markers.size()], placed, SampleMarkerSurface(rays, placed), {}};
    if (placed.shape->straight_edges > 0) {
      for (const Vec2d& corner : placed.shape->outline_mm)
        marker.corners.push_back(OntoSurface(rays, placed, corner));
    }
    markers.push_back(std::move(marker));
  }
  return markers;
}

std::vector<MarkerLabel> LabelPicture(const std::vector<LabelledMarker>& markers,
                                      const RayScene& rays, const CameraSpec& camera,
                                      const IdBuffers& ids, const Film& film, double exposure_s) {
  std::vector<MarkerLabel> labels;
  for (const LabelledMarker& marker : markers) {
    const MarkerView view = ViewMarker(marker.surface, rays, camera.model);
    const MaskPlane visible = VisibleMask(ids.marker, marker.placed.instance);
    const MaskPlane amodal = AmodalMask(marker, view, camera.model);
    if (!HasAny(visible) && !HasAny(amodal)) continue;
    MarkerLabel label;
    label.instance = marker.placed.instance;
    label.name = marker.spec->name;
    label.number = marker.spec->number;
    label.dark = marker.placed.dark;
    for (const std::optional<SurfaceHit>& corner : marker.corners)
      label.corners.push_back(Keypoint(marker, corner, rays, camera.model));
    label.centroid_projected_px = view.centroid_projected_px;
    label.centroid_outline_px = view.centroid_outline_px;
    label.visible_fraction = view.visible_fraction;
    label.incidence_deg = view.incidence_deg;
    label.distance_mm = view.distance_mm;
    label.in_frame = view.in_frame;
    label.size_px =
        LongSide(marker.placed.dark ? ProjectedSquare(marker, camera.model) : view.outline_px);
    label.visible = EncodeRuns(visible);
    label.amodal = EncodeRuns(amodal);
    label.camera_from_marker =
        camera.model.camera_from_world * marker.placed.marker_from_world.Inverse();
    MeasureSignal(visible, amodal, film, camera.sensor, exposure_s, label);
    labels.push_back(std::move(label));
  }
  CheckMasks(labels, ids.marker);
  return labels;
}

}  // namespace retrolux
