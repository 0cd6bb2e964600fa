#include "renderer/path_tracer.h"

#include "core/hash.h"
#include "core/sampling.h"
#include "materials/blend.h"

namespace retrolux {

// A surface point of a path, with its local frame and what scatters there.
struct PathTracer::Vertex {
  Vec3f position, geometric_normal;
  Frame frame;
  Vec3f wo;  // local, towards where the path came from
  BsdfBlend bsdf;
  uint32_t marker = 0;
};

PathTracer::PathTracer(const Scene& scene, const RayScene& rays, const Lights& lights,
                       const CameraResponse& response, const std::vector<PlacedMarker>& markers,
                       const TraceOptions& options)
    : scene_(scene),
      rays_(rays),
      lights_(lights),
      response_(response),
      lens_(response.Camera()),
      spread_(response.Camera(), response.MeanWavelength_nm()),
      markers_(markers),
      options_(options),
      image_key_(CombineKeys(options.seed, HashBytes(response.Camera().model.name))) {
  for (const SceneObject& object : scene_.objects)
    material_of_object_.push_back(&scene_.materials.at(object.material));
  for (int group = 0; group < lights_.GroupCount(); ++group) {
    group_value_[group] =
        static_cast<float>(response.ExpectedElectrons(lights_.SpectrumOf(group), 1.0, 1.0));
  }
}

namespace {

// A share that no group reaches.
constexpr float kNoneItsOwn = 2.0f;

BsdfBlend BsdfAt(const Material& material, const Vec2f& uv) {
  if (!material.texture) return {material.bsdf.get(), nullptr, 1.0f};
  return {material.bsdf.get(), material.dark.get(), material.texture->At(uv)};
}

}  // namespace

PathTracer::Vertex PathTracer::MakeVertex(const Vec3f& direction, const SurfaceHit& hit) const {
  // Near the limb the interpolated normal may face away from the ray; the triangle's own never
  // does.
  const bool smooth = hit.shading_normal.dot(direction) < 0.0f;
  const Vec3f& normal = smooth ? hit.shading_normal : hit.geometric_normal;
  Vertex vertex{hit.position,
                hit.geometric_normal,
                Frame(normal),
                Vec3f::Zero(),
                BsdfAt(*material_of_object_[hit.body], hit.uv),
                0};
  vertex.wo = vertex.frame.LocalFromWorld(-direction);
  for (const PlacedMarker& marker : markers_) {
    if (marker.object != hit.body) continue;
    const std::optional<Vec2d> place =
        marker.Locate(hit.position.cast<double>(), hit.geometric_normal.cast<double>());
    if (!place || !marker.IsBright(*place)) continue;
    vertex.bsdf = {marker.bright.get(), nullptr, 1.0f};
    vertex.marker = marker.instance;
    break;
  }
  return vertex;
}

void PathTracer::AddDirect(const Vertex& vertex, const Spectral& throughput, const Spectral& nm,
                           float own_ray_share, PixelSampler& sampler,
                           GroupValues& radiance) const {
  const float pick = sampler.Next1D();
  const Vec2f u = sampler.Next2D();
  const float choice = sampler.Next1D();
  const Vec3f origin = OffSurface(vertex.position, vertex.geometric_normal);
  GroupValues unshadowed = GroupValues::Zero();
  std::array<Vec3f, kMaxLightGroups> targets;
  for (int group = 0; group < lights_.GroupCount(); ++group) {
    const std::optional<LightSample> light = lights_.Sample(group, vertex.position, pick, u);
    if (!light || light->direction.dot(vertex.geometric_normal) <= 0.0f) continue;
    const Vec3f wi = vertex.frame.LocalFromWorld(light->direction);
    const int k = lights_.SpectrumOf(group);
    const BsdfValue value = vertex.bsdf.Evaluate(vertex.wo, wi, nm);
    const float share = PowerHeuristic(light->pdf, value.pdf);
    unshadowed[group] = throughput[k] * value.f_cos[k] * light->radiance / light->pdf * share;
    targets[static_cast<size_t>(group)] = light->position;
  }
  const auto is_lit = [&](int group) {
    return !rays_.Occluded(origin, targets[static_cast<size_t>(group)]);
  };
  // Drawn by electrons, not by radiance: of two equal radiances the filter may pass one and stop
  // the other, and a shadow ray for what makes no signal is thrown away.
  GroupValues electrons = unshadowed * group_value_;
  const float least = own_ray_share * electrons.sum();
  for (int group = 0; group < lights_.GroupCount(); ++group) {
    if (unshadowed[group] <= 0.0f || electrons[group] < least) continue;
    if (is_lit(group)) radiance[group] += unshadowed[group];
    electrons[group] = 0.0f;
  }
  const float sum = electrons.sum();
  if (sum <= 0.0f) return;
  float rest = choice * sum;
  int chosen = 0;
  for (int group = 0; group < lights_.GroupCount() && rest >= 0.0f; ++group) {
    if (electrons[group] <= 0.0f) continue;
    chosen = group;
    rest -= electrons[group];
  }
  if (is_lit(chosen)) radiance[chosen] += sum / group_value_[chosen];
}

PathTracer::PathSample PathTracer::TracePath(Vec3f origin, Vec3f direction, const Spectral& nm,
                                             PixelSampler& sampler) const {
  PathSample path;
  Spectral throughput = Spectral::Ones();
  float pdf = 0.0f;  // of the direction by the last BSDF; 0 for the camera's ray
  const auto add_emission = [&](const Lights::Emission& emission) {
    const float share = pdf > 0.0f ? PowerHeuristic(pdf, emission.pdf) : 1.0f;
    path.radiance[emission.group] +=
        throughput[lights_.SpectrumOf(emission.group)] * emission.radiance * share;
  };
  for (int surface = 0;; ++surface) {
    const std::optional<SurfaceHit> hit = rays_.Intersect(origin, direction);
    if (!hit) {
      if (const auto emission = lights_.Environment()) add_emission(*emission);
      break;
    }
    if (!rays_.IsObject(hit->body)) {
      if (const auto emission = lights_.Emitted(origin, direction, *hit)) add_emission(*emission);
      break;
    }
    if (surface == options_.max_surfaces) break;  // only what emits there counts
    const Vertex vertex = MakeVertex(direction, *hit);
    if (surface == 0) path.marker = vertex.marker;
    const float own_ray_share = surface == 0 ? options_.own_ray_share : kNoneItsOwn;
    AddDirect(vertex, throughput, nm, own_ray_share, sampler, path.radiance);

    const float lobe = sampler.Next1D();
    const std::optional<BsdfSample> next =
        vertex.bsdf.Sample(vertex.wo, lobe, sampler.Next2D(), nm);
    if (!next) break;
    direction = vertex.frame.WorldFromLocal(next->wi);
    if (direction.dot(vertex.geometric_normal) <= 0.0f) break;
    throughput *= next->weight;
    pdf = next->pdf;
    // Russian roulette: a path goes on with the share of light that it carries.
    const float survival = std::min(0.95f, options_.roulette * throughput.maxCoeff());
    if (sampler.Next1D() >= survival) break;
    throughput /= survival;
    origin = OffSurface(vertex.position, vertex.geometric_normal);
  }
  return path;
}

namespace {

// Sums over the samples of a pixel by the marker that they show.
class CoverageSum {
 public:
  void Add(uint32_t marker, float electrons) {
    if (marker == 0) return;
    for (size_t i = 0; i < count_; ++i) {
      if (entries_[i].marker != marker) continue;
      entries_[i].samples += 1.0f;
      entries_[i].electrons += electrons;
      return;
    }
    if (count_ < entries_.size()) entries_[count_++] = {marker, 1.0f, electrons};
  }

  MarkerCoverage Ranked(float samples) {
    std::sort(entries_.begin(), entries_.begin() + static_cast<ptrdiff_t>(count_),
              [](const Entry& a, const Entry& b) {
                return a.samples != b.samples ? a.samples > b.samples : a.marker < b.marker;
              });
    MarkerCoverage coverage;
    for (size_t i = 0; i < std::min<size_t>(3, count_); ++i) {
      coverage.instance[i] = entries_[i].marker;
      coverage.weight[i] = entries_[i].samples / samples;
      coverage.electrons[i] = entries_[i].electrons / samples;
    }
    return coverage;
  }

 private:
  struct Entry {
    uint32_t marker;
    float samples, electrons;
  };
  std::array<Entry, 8> entries_;
  size_t count_ = 0;
};

}  // namespace

std::optional<LensRays::LensRay> PathTracer::SampleLens(int x, int y, PixelSampler& sampler) const {
  const Vec2d px = Vec2d(x, y) + spread_.Sample(sampler);
  return lens_.Through(px, lens_.HasAperture() ? sampler.Next2D() : Vec2f::Zero());
}

PixelEstimate PathTracer::EstimatePixel(int x, int y, int samples) const {
  const uint64_t pixel_key =
      CombineKeys(image_key_, static_cast<uint64_t>(y) << 32 | static_cast<uint64_t>(x));
  Eigen::Array<double, kMaxLightGroups, 1> sums = Eigen::Array<double, kMaxLightGroups, 1>::Zero();
  double sum = 0.0, sum2 = 0.0, radiance = 0.0;
  CoverageSum coverage;
  for (int s = 0; s < samples; ++s) {
    PixelSampler sampler(pixel_key, static_cast<uint32_t>(s));
    const std::optional<LensRays::LensRay> ray = SampleLens(x, y, sampler);
    if (!ray) continue;  // a sample that brings no light
    const Spectral nm = response_.SampleWavelengths(sampler.Next1D(), ray->cos_field);
    const PathSample path = TracePath(ray->origin, ray->direction, nm, sampler);
    const CameraResponse::Weights weights = response_.WeightsAt(nm, ray->cos_field, ray->falloff);
    double total = 0.0;
    for (int group = 0; group < lights_.GroupCount(); ++group) {
      const int k = lights_.SpectrumOf(group);
      const auto electrons = static_cast<double>(path.radiance[group] * weights.electrons[k]);
      sums[group] += electrons;
      total += electrons;
      radiance += static_cast<double>(path.radiance[group] * weights.in_band[k]);
    }
    sum += total;
    sum2 += total * total;
    coverage.Add(path.marker, static_cast<float>(total));
  }
  const double n = samples;
  PixelEstimate estimate;
  estimate.electrons = (sums / n).cast<float>();
  if (n > 1.0)
    estimate.variance = static_cast<float>(std::max(0.0, (sum2 - sum * sum / n) / (n * (n - 1.0))));
  estimate.radiance = static_cast<float>(radiance / n);
  estimate.coverage = coverage.Ranked(static_cast<float>(n));
  return estimate;
}

}  // namespace retrolux
