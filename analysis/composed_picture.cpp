#include "analysis/composed_picture.h"

#include <cmath>

#include "renderer/exposure.h"

namespace retrolux {

namespace {

// Half the diagonal of a pixel, and room for what bulges out between the sample points of the
// surface.
constexpr double kMargin_px = 0.75 + 0.5;

// Distance of a point from a convex polygon (counter-clockwise in x, y); 0 inside.
double DistanceToHull(const Polygon& hull, const Vec2d& p) {
  if (Contains(hull, p)) return 0.0;
  double nearest2 = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < hull.size(); ++i) {
    const Vec2d& a = hull[i];
    const Vec2d edge = hull[(i + 1) % hull.size()] - a;
    const double t = std::clamp((p - a).dot(edge) / std::max(edge.squaredNorm(), 1e-30), 0.0, 1.0);
    nearest2 = std::min(nearest2, (a + t * edge - p).squaredNorm());
  }
  return std::sqrt(nearest2);
}

FloatPlane RenderBackground(const Scene& scene, const RayScene& rays, const Lights& lights,
                            const CameraResponse& response, const TraceOptions& options,
                            Progress& progress) {
  const std::vector<PlacedMarker> none;
  const PathTracer tracer(scene, rays, lights, response, none, options);
  return RenderFilm(tracer, response.Camera().model, lights.GroupNames(), progress).electrons;
}

}  // namespace

std::vector<Eigen::Vector2i> PixelsThatCanShow(const MarkerSurface& surface,
                                               const CameraModel& camera, double blur_px) {
  const double margin_px = kMargin_px + blur_px;
  Polygon points;
  for (const MarkerSurface::Point& point : surface.points) {
    if (const auto px = camera.Project(point.position)) points.push_back(*px);
  }
  for (const Vec3d& point : surface.outline) {
    if (const auto px = camera.Project(point)) points.push_back(*px);
  }
  if (points.empty()) return {};
  const Polygon hull = ConvexHull(std::move(points));
  Vec2d lo = hull.front(), hi = hull.front();
  for (const Vec2d& corner : hull) {
    lo = lo.cwiseMin(corner);
    hi = hi.cwiseMax(corner);
  }
  const auto first = [&](double v) {
    return std::max(0, static_cast<int>(std::ceil(v - margin_px)));
  };
  const auto last = [&](double v, int size) {
    return std::min(size - 1, static_cast<int>(std::floor(v + margin_px)));
  };
  std::vector<Eigen::Vector2i> pixels;
  for (int y = first(lo.y()); y <= last(hi.y(), camera.height); ++y) {
    for (int x = first(lo.x()); x <= last(hi.x(), camera.width); ++x) {
      if (DistanceToHull(hull, Vec2d(x, y)) <= margin_px) pixels.emplace_back(x, y);
    }
  }
  return pixels;
}

ComposedCamera::ComposedCamera(const Scene& scene, const RayScene& rays, const CameraSpec& camera,
                               RingChoice rings, const TraceOptions& options, Progress& progress)
    : scene_(scene),
      rays_(rays),
      lights_(scene, rays, rings, camera.model.name),
      response_(camera, lights_.Spectra(), retrolux::ExposureSeconds(scene, camera)),
      lens_(camera),
      scatter_(camera, response_.MeanWavelength_nm()),
      spread_px_(PixelSpread(camera, response_.MeanWavelength_nm()).Radius_px()),
      options_(options),
      traced_background_(RenderBackground(scene, rays, lights_, response_, options, progress)),
      background_(traced_background_) {
  scatter_.Apply(background_);
}

double ComposedCamera::Blur_px(const MarkerSurface& surface) const {
  const CameraModel& model = response_.Camera().model;
  double widest = 0.0;
  for (const MarkerSurface::Point& point : surface.points) {
    const double depth_mm = (model.camera_from_world * point.position).z();
    if (depth_mm > 0.0) widest = std::max(widest, lens_.BlurRadius_px(depth_mm));
  }
  return widest + spread_px_;
}

FloatPlane ComposedCamera::Signal(const PlacedMarker& marker, const MarkerSurface& surface,
                                  int64_t* retraced) const {
  const std::vector<PlacedMarker> markers = {marker};
  const PathTracer tracer(scene_, rays_, lights_, response_, markers, options_);
  FloatPlane signal = traced_background_;
  const std::vector<Eigen::Vector2i> pixels =
      PixelsThatCanShow(surface, response_.Camera().model, Blur_px(surface));
  for (const Eigen::Vector2i& px : pixels) {
    const PixelEstimate estimate = tracer.EstimatePixel(px.x(), px.y());
    float sum = 0.0f;
    for (int group = 0; group < lights_.GroupCount(); ++group) sum += estimate.electrons[group];
    signal(px.x(), px.y()) = sum;
  }
  scatter_.Apply(signal);
  if (retraced) *retraced += static_cast<int64_t>(pixels.size());
  return signal;
}

}  // namespace retrolux
