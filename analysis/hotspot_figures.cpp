#include "analysis/hotspot_figures.h"

#include <algorithm>
#include <cmath>

#include "analysis/cross_highlight.h"
#include "analysis/signal_noise.h"

namespace retrolux {

namespace {

constexpr const char* kOwn = "own";
constexpr const char* kOwnPolarised = "own_polarised";

// The bare mask: its pixels that show neither a marker nor an edge.
bool IsBare(const HotspotLight& light, size_t mask, size_t i) {
  return light.ids.object.data[i] == mask + 1 && light.ids.marker.data[i] == 0 &&
         light.edges.data[i] == 0;
}

// The median of each pixel and those around it that `shown` names; 0 elsewhere.
template <typename Shown>
FloatPlane MedianOf9(const FloatPlane& plane, Shown shown) {
  FloatPlane median(plane.width, plane.height);
  for (int y = 0; y < plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) {
      if (!shown(plane.Index(x, y))) continue;
      std::array<float, 9> values;
      size_t count = 0;
      for (int v = y - 1; v <= y + 1; ++v) {
        for (int u = x - 1; u <= x + 1; ++u) {
          if (plane.Contains(u, v) && shown(plane.Index(u, v))) values[count++] = plane(u, v);
        }
      }
      const auto middle = values.begin() + static_cast<ptrdiff_t>(count / 2);
      std::nth_element(values.begin(), middle, values.begin() + static_cast<ptrdiff_t>(count));
      median(x, y) = *middle;
    }
  }
  return median;
}

double MeanOver(const std::vector<size_t>& pixels, const FloatPlane& plane) {
  double sum = 0.0;
  for (const size_t i : pixels) sum += static_cast<double>(plane.data[i]);
  return pixels.empty() ? 0.0 : sum / static_cast<double>(pixels.size());
}

double PowerOf(const HotspotLight& light, size_t group, const HotspotMix& mix) {
  if (group == light.own) return mix.own;
  if (!light.IsRing(group)) return 1.0;
  return mix.only.empty() || mix.only == light.groups[group] ? mix.neighbours : 0.0;
}

// Value at the centre and slope (per px) of the plane that fits best.
struct Ground {
  double level = 0.0, slope = 0.0;
};
Ground GroundOf(const HotspotMarker& marker, const FloatPlane& signal) {
  Mat3d normal = Mat3d::Zero();
  Vec3d right = Vec3d::Zero();
  const auto width = static_cast<size_t>(signal.width);
  for (const size_t i : marker.around) {
    const Vec3d row(1.0, static_cast<double>(i % width) - marker.centre_px.x(),
                    static_cast<double>(i / width) - marker.centre_px.y());
    normal += row * row.transpose();
    right += row * static_cast<double>(signal.data[i]);
  }
  const Vec3d fit = normal.ldlt().solve(right);
  return {fit[0], std::hypot(fit[1], fit[2])};
}

// The mean over the markers of the mean over the pixels that `which` names of each.
double MeanOf(const std::vector<HotspotMarker>& markers, std::vector<size_t> HotspotMarker::*which,
              const FloatPlane& plane) {
  double sum = 0.0;
  for (const HotspotMarker& marker : markers) sum += MeanOver(marker.*which, plane);
  return markers.empty() ? 0.0 : sum / static_cast<double>(markers.size());
}

}  // namespace

std::vector<HotspotMix> HotspotMixes(const std::vector<double>& powers) {
  std::vector<HotspotMix> mixes = {{kOwn, 1.0, 0.0},
                                   {"both", 1.0, 1.0},
                                   {"neighbour", 0.0, 1.0},
                                   {kOwnPolarised, 1.0, 0.0, true},
                                   {"both_polarised", 1.0, 1.0, true}};
  for (const double power : powers) mixes.push_back({fmt::format("both_x{:g}", power), 1.0, power});
  return mixes;
}

const char* ReferenceOf(const HotspotMix& mix) {
  return mix.polarised ? kOwnPolarised : kOwn;
}

FloatPlane Mixed(const HotspotLight& light, const HotspotMix& mix) {
  FloatPlane signal(light.edges.width, light.edges.height);
  for (size_t g = 0; g < light.groups.size(); ++g) {
    const double power = PowerOf(light, g, mix);
    if (power == 0.0) continue;
    for (size_t i = 0; i < signal.data.size(); ++i) {
      const float glint = mix.polarised ? light.glints[g].data[i] : 0.0f;
      // Below zero by the paths' noise only.
      signal.data[i] += static_cast<float>(power) * std::max(0.0f, light.all[g].data[i] - glint);
    }
  }
  return signal;
}

std::vector<HotspotMarker> HotspotMarkers(const Scene& scene, const RayScene& rays,
                                          const CameraModel& camera, const HotspotLight& light) {
  std::vector<HotspotMarker> markers;
  for (const PlacedMarker& placed : PlaceMarkers(scene)) {
    const MarkerSurface surface = SampleMarkerSurface(rays, placed);
    const MarkerView view = ViewMarker(surface, rays, camera);
    if (view.visible_fraction < 0.999) continue;
    HotspotMarker marker;
    marker.number = placed.shape->number;
    marker.hull_px = ConvexHull(view.outline_px);
    marker.centre_px = Centroid(marker.hull_px);
    double radius = 0.0;
    for (const Vec2d& corner : marker.hull_px)
      radius = std::max(radius, (corner - marker.centre_px).norm());
    const auto width = static_cast<size_t>(camera.width);
    for (size_t i = 0; i < light.edges.data.size(); ++i) {
      const Vec2d px(static_cast<double>(i % width), static_cast<double>(i / width));
      const double distance = (px - marker.centre_px).norm();
      if (light.ids.marker.data[i] == placed.instance && light.edges.data[i] == 0)
        marker.inside.push_back(i);
      if (distance <= 1.5 * radius && IsBare(light, placed.object, i)) marker.around.push_back(i);
    }
    if (!marker.inside.empty() && marker.around.size() > 2) markers.push_back(std::move(marker));
  }
  return markers;
}

HotspotLevels LevelsOf(const FloatPlane& signal, const HotspotLight& light, size_t mask,
                       const std::vector<HotspotMarker>& markers, const SensorSpec& sensor) {
  HotspotLevels levels;
  const auto bare = [&](size_t i) { return IsBare(light, mask, i); };
  for (const float e : MedianOf9(signal, bare).data)
    levels.peak_e = std::max(levels.peak_e, static_cast<double>(e));
  for (size_t i = 0; i < signal.data.size(); ++i) {
    if (static_cast<double>(signal.data[i]) < sensor.full_well_e) continue;
    ++levels.saturated_px;
    if (bare(i)) ++levels.saturated_mask_px;
  }
  if (markers.empty()) return levels;
  const auto count = static_cast<double>(markers.size());
  for (const HotspotMarker& marker : markers) {
    const Ground ground = GroundOf(marker, signal);
    levels.background_e += ground.level / count;
    levels.gradient_e_px += ground.slope / count;
    levels.marker_px += static_cast<double>(marker.inside.size()) / count;
  }
  levels.marker_e = MeanOf(markers, &HotspotMarker::inside, signal);
  levels.contrast = levels.background_e > 0.0
                        ? (levels.marker_e - levels.background_e) / levels.background_e
                        : 0.0;
  levels.background_noise_e = NoiseSigma_e(sensor, light.exposure_s, levels.background_e);
  levels.marker_noise_e = NoiseSigma_e(sensor, light.exposure_s, levels.marker_e);
  return levels;
}

Highlight HighlightOf(const FloatPlane& bare_glints, const IdBuffers& ids, size_t mask) {
  Highlight highlight;
  const FloatPlane glints =
      MedianOf9(bare_glints, [&](size_t i) { return ids.object.data[i] == mask + 1; });
  for (const float e : glints.data)
    highlight.peak_e = std::max(highlight.peak_e, static_cast<double>(e));
  if (highlight.peak_e <= 0.0) return highlight;
  double sum = 0.0;
  const auto width = static_cast<size_t>(glints.width);
  for (size_t i = 0; i < glints.data.size(); ++i) {
    const auto e = static_cast<double>(glints.data[i]);
    if (e < 0.5 * highlight.peak_e) continue;
    ++highlight.area_px;
    sum += e;
    highlight.at_px[0] += e * static_cast<double>(i % width);
    highlight.at_px[1] += e * static_cast<double>(i / width);
    for (size_t axis = 0; axis < 3; ++axis)
      highlight.at_mm[axis] += e * static_cast<double>(ids.position[axis].data[i]);
  }
  for (double& v : highlight.at_px) v /= sum;
  for (double& v : highlight.at_mm) v /= sum;
  return highlight;
}

std::vector<RingLight> RingsOf(const Scene& scene, const RayScene& rays, const CameraSpec& camera,
                               size_t mask, const HotspotLight& light,
                               const std::vector<FloatPlane>& bare_glints,
                               const std::vector<HotspotMarker>& markers) {
  const std::vector<std::string> bodies = rays.BodyNames();
  std::vector<RingLight> rings;
  for (size_t g = 0; g < light.groups.size(); ++g) {
    if (!light.IsRing(g)) continue;
    RingLight ring;
    ring.name = light.groups[g];
    const CameraModel& other = scene.Camera(ring.name).model;
    if (g != light.own) ring.separation_deg = Separation_deg(camera.model, other);
    ring.highlight = HighlightOf(bare_glints[g], light.ids, mask);
    const auto around = [&](const FloatPlane& plane) {
      return MeanOf(markers, &HotspotMarker::around, plane);
    };
    const auto inside = [&](const FloatPlane& plane) {
      return MeanOf(markers, &HotspotMarker::inside, plane);
    };
    ring.gloss_e = around(light.glints[g]);
    ring.beam_e = around(light.all[g]) - ring.gloss_e;
    ring.cover_e = inside(light.glints[g]);
    ring.sheet_e = inside(light.plain[g]) - ring.cover_e;
    ring.lobe_e = inside(light.all[g]) - inside(light.plain[g]);
    for (size_t i = 0; i < light.ids.object.data.size(); ++i) {
      const uint32_t body = light.ids.object.data[i];
      if (body == 0 || bodies[body - 1] != "ring-" + ring.name) continue;
      ++ring.direct_px;
      ring.direct_peak_e = std::max(ring.direct_peak_e, static_cast<double>(light.all[g].data[i]));
    }
    rings.push_back(std::move(ring));
  }
  return rings;
}

}  // namespace retrolux
