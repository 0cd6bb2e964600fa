#include "analysis/hotspot_shot.h"

#include <algorithm>
#include <cmath>

#include "analysis/signal_noise.h"
#include "classifier/label_match.h"
#include "classifier/method.h"
#include "classifier/triangulation.h"
#include "core/parallel.h"
#include "renderer/render_files.h"
#include "renderer/sensor.h"

namespace retrolux {

namespace {

constexpr const char* kMethods[] = {"edges", "robust"};
// Farther from a marker's outline a pattern is not of it (docs/evaluation.md).
constexpr double kMargin_px = 2.0;

// What is found of a picture's markers (the identifiable ones).
struct Found {
  std::vector<std::optional<Detection>> markers;
  int wrong_names = 0, strays = 0;
};

size_t MaskOf(const Scene& scene) {
  if (scene.markers.empty())
    throw InputError(fmt::format("scene '{}': no markers; expected some on the mask", scene.name));
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].name == scene.markers.front().object) return i;
  }
  throw InputError(
      fmt::format("scene '{}': no object '{}'", scene.name, scene.markers.front().object));
}

// A picture as the sensor would take it if nothing were noisy: all of its light ten thousandfold
// in wells of that size, clipped where the sensor's are.
class CalmSensor {
 public:
  explicit CalmSensor(const CameraSpec& camera) : sensor_(SpecOf(camera)) {}

  DigitalImage Expose(FloatPlane signal, double exposure_s, uint64_t key) const {
    for (float& e : signal.data) e *= kMore;
    return sensor_.Expose(signal, exposure_s, key);
  }

 private:
  static constexpr float kMore = 1e4f;
  static CameraSpec SpecOf(CameraSpec camera) {
    SensorSpec& spec = camera.sensor;
    spec.full_well_e *= static_cast<double>(kMore);
    spec.read_noise_e = spec.dark_current_e_s = spec.prnu = spec.dsnu_e = spec.gain_dn_e = 0.0;
    spec.offset_dn *= 256.0;
    spec.adc_bits = 16;
    spec.blooming.reset();
    spec.smear.reset();
    spec.defects.reset();
    return camera;
  }
  Sensor sensor_;
};

Found Identify(const DigitalImage& image, const std::string& method, const HotspotStage& stage) {
  std::vector<LabelledShape> shapes;
  for (const HotspotMarker& marker : stage.markers)
    shapes.push_back({marker.number, marker.hull_px, marker.centre_px, marker.number > 0});
  const std::vector<Detection> detections =
      MethodByName(method)(image, *stage.scene.marker_set, nullptr);
  const PictureMatch match = MatchDetections(shapes, detections, kMargin_px);
  Found found;
  for (size_t m = 0; m < shapes.size(); ++m) {
    if (!shapes[m].counts) continue;
    const MarkerOutcome& outcome = match.markers[m];
    found.markers.emplace_back();
    if (outcome.outcome == LabelOutcome::kFound)
      found.markers.back() = detections[*outcome.detection];
  }
  for (const JudgedDetection& judged : match.detections) {
    const bool named = judged.verdict != Verdict::kUnnamed && judged.verdict != Verdict::kFound &&
                       judged.verdict != Verdict::kIgnored;
    if (named) ++found.wrong_names;
    if (judged.verdict == Verdict::kUnnamed && !judged.marker) ++found.strays;
  }
  return found;
}

// rms distance of corners from the nearest ones of the reference: which corner a triangle begins
// with is not told by its shape.
double CornerShift(const Detection& detection, const Detection& reference) {
  double sum = 0.0;
  for (const Vec2d& corner : detection.corners_px) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec2d& other : reference.corners_px)
      nearest = std::min(nearest, (corner - other).squaredNorm());
    sum += nearest;
  }
  return std::sqrt(sum / static_cast<double>(detection.corners_px.size()));
}

// All pictures of one mix: the calm one, then the exposures.
using FoundByPicture = std::vector<Found>;

PlaceShift ShiftOf(size_t marker, const FoundByPicture& mix, const FoundByPicture& reference) {
  PlaceShift shift;
  const auto both = [&](size_t picture) {
    return mix[picture].markers[marker] && reference[picture].markers[marker];
  };
  if (both(0)) {
    const Detection &here = *mix[0].markers[marker], &there = *reference[0].markers[marker];
    shift.centroid_px = (here.centroid_px - there.centroid_px).norm();
    shift.corners_px = CornerShift(here, there);
  }
  Vec2d sum = Vec2d::Zero();
  double squares = 0.0, corner_squares = 0.0;
  for (size_t k = 1; k < mix.size(); ++k) {
    if (!both(k)) continue;
    ++shift.pairs;
    const Detection& there = *reference[k].markers[marker];
    sum += mix[k].markers[marker]->centroid_px - there.centroid_px;
    // About the calm place: the fixed pattern of the pixels is part of the noise of a place.
    const Detection& origin = reference[0].markers[marker] ? *reference[0].markers[marker] : there;
    const Vec2d off = there.centroid_px - origin.centroid_px;
    squares += off.squaredNorm();
    corner_squares += std::pow(CornerShift(there, origin), 2);
  }
  if (shift.pairs == 0) return shift;
  const double n = shift.pairs;
  shift.mean_px = {sum.x() / n, sum.y() / n};
  shift.centroid_noise_px = std::sqrt(squares / (2.0 * n));
  shift.corner_noise_px = std::sqrt(corner_squares / (2.0 * n));
  return shift;
}

MixDetections DetectionsOf(const FoundByPicture& mix, const FoundByPicture& reference,
                           size_t markers) {
  MixDetections result;
  for (size_t m = 0; m < markers; ++m) {
    std::vector<int>& found = result.found.emplace_back();
    for (size_t k = 1; k < mix.size(); ++k) found.push_back(mix[k].markers[m] ? 1 : 0);
    result.shifts.push_back(ShiftOf(m, mix, reference));
  }
  for (size_t k = 1; k < mix.size(); ++k) {
    result.wrong_names.push_back(mix[k].wrong_names);
    result.strays.push_back(mix[k].strays);
  }
  return result;
}

// From second differences along rows, which the mask's smooth light leaves next to nothing of: of
// independent pixels with variance v they have 6 v.
double RenderNoise(const HotspotStage& stage) {
  const HotspotLight& light = stage.light;
  const FloatPlane signal = Mixed(light, {"both", 1.0, 1.0});
  const auto bare = [&](size_t i) {
    return light.ids.object.data[i] == stage.mask + 1 && light.ids.marker.data[i] == 0 &&
           light.edges.data[i] == 0;
  };
  double sum = 0.0, count = 0.0;
  for (size_t i = 1; i + 1 < signal.data.size(); ++i) {
    if (!bare(i - 1) || !bare(i) || !bare(i + 1)) continue;
    const auto e = static_cast<double>(signal.data[i]);
    const double second = static_cast<double>(signal.data[i - 1] + signal.data[i + 1]) - 2.0 * e;
    const double sigma = NoiseSigma_e(stage.camera.sensor, light.exposure_s, e);
    sum += second * second / (6.0 * sigma * sigma);
    ++count;
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

}  // namespace

HotspotStage::HotspotStage(Scene of, size_t camera_index, const HotspotSamples& samples,
                           uint64_t seed)
    : scene(std::move(of)),
      rays(scene),
      camera(scene.cameras.at(camera_index)),
      mask(MaskOf(scene)),
      light(TraceHotspots(scene, rays, camera, mask, samples, seed)),
      bare_glints(TraceBareGlints(scene, rays, camera, mask, samples, seed)),
      markers(HotspotMarkers(scene, rays, camera.model, light)) {}

HotspotShot ShootHotspots(const HotspotStage& stage, const std::vector<HotspotMix>& mixes,
                          const HotspotShotOptions& options, const std::string& picture) {
  HotspotShot shot;
  for (const HotspotMarker& marker : stage.markers) {
    if (marker.number > 0) shot.markers.push_back(marker.number);
  }
  shot.rings = RingsOf(stage.scene, stage.rays, stage.camera, stage.mask, stage.light,
                       stage.bare_glints, stage.markers);
  shot.render_noise = RenderNoise(stage);
  const size_t pictures = static_cast<size_t>(options.exposures) + 1;
  const Sensor sensor(stage.camera);
  const CalmSensor calm(stage.camera);
  std::vector<FloatPlane> signals;
  for (const HotspotMix& mix : mixes) signals.push_back(Mixed(stage.light, mix));
  std::map<std::string, std::vector<FoundByPicture>> found;  // by method, mix, picture
  for (const char* method : kMethods) found[method].assign(mixes.size(), FoundByPicture(pictures));
  ParallelFor(static_cast<int64_t>(mixes.size() * pictures), [&](int64_t i) {
    const size_t mix = static_cast<size_t>(i) / pictures, k = static_cast<size_t>(i) % pictures;
    const double exposure_s = stage.light.exposure_s;
    const uint64_t key = NoiseKey(options.noise_seed, fmt::format("{}_{}", picture, k));
    const DigitalImage image = k == 0 ? calm.Expose(signals[mix], exposure_s, key)
                                      : sensor.Expose(signals[mix], exposure_s, key);
    for (const char* method : kMethods) found.at(method)[mix][k] = Identify(image, method, stage);
  });
  for (size_t i = 0; i < mixes.size(); ++i) {
    MixResult result{
        mixes[i].name,
        LevelsOf(signals[i], stage.light, stage.mask, stage.markers, stage.camera.sensor),
        {}};
    const auto reference = static_cast<size_t>(
        std::find_if(mixes.begin(), mixes.end(),
                     [&](const HotspotMix& m) { return m.name == ReferenceOf(mixes[i]); }) -
        mixes.begin());
    for (const auto& [method, by_mix] : found) {
      result.methods[method] = DetectionsOf(by_mix[i], by_mix[reference], shot.markers.size());
    }
    shot.mixes.push_back(std::move(result));
  }
  return shot;
}

HighlightDepths DepthsOfHighlights(const HotspotStage& stage, const CameraSpec& other,
                                   const HotspotSamples& samples, uint64_t seed) {
  const std::vector<FloatPlane> glints =
      TraceBareGlints(stage.scene, stage.rays, other, stage.mask, samples, seed);
  const IdBuffers ids = RenderIds(stage.rays, other.model, {});
  const auto group = [&](const std::string& name) {
    return static_cast<size_t>(
        std::find(stage.light.groups.begin(), stage.light.groups.end(), name) -
        stage.light.groups.begin());
  };
  const size_t here = stage.light.own, there = group(other.model.name);
  const Highlight own_here = HighlightOf(stage.bare_glints[here], stage.light.ids, stage.mask);
  const Highlight cross_here = HighlightOf(stage.bare_glints[there], stage.light.ids, stage.mask);
  const Highlight own_there = HighlightOf(glints[there], ids, stage.mask);
  const Highlight cross_there = HighlightOf(glints[here], ids, stage.mask);
  HighlightDepths depths;
  for (const Highlight* highlight : {&own_here, &cross_here, &own_there, &cross_there}) {
    if (highlight->peak_e <= 0.0) return depths;
  }
  const Vec3d surface(cross_here.at_mm.data());
  const Vec3d towards = ((stage.camera.model.Centre() - surface).normalized() +
                         (other.model.Centre() - surface).normalized())
                            .normalized();
  TriangulationOptions options;
  options.max_residual_px = 100.0;  // no marker, but the middle of a spot: measured, not sieved
  options.min_angle_deg = 0.1;
  const auto depth = [&](const Highlight& a, const Highlight& b) -> std::optional<double> {
    const std::array<Sighting, 2> sightings = {Sighting{&stage.camera.model, Vec2d(a.at_px.data())},
                                               Sighting{&other.model, Vec2d(b.at_px.data())}};
    const Triangulation found = Triangulate(sightings, options);
    if (!found.point) return std::nullopt;
    return (surface - found.point->position).dot(towards);
  };
  const auto cross = depth(cross_here, cross_there), own = depth(own_here, own_there);
  if (!cross || !own) return depths;
  return {true, *cross, *own, (Vec3d(own_here.at_mm.data()) - surface).norm()};
}

}  // namespace retrolux
