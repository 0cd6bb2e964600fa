#include "analysis/visibility.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/hash.h"

namespace retrolux {

namespace {

constexpr std::array<const char*, 3> kRuleNames = {"ids", "rays", "triangles"};

RayScene TraceableMesh(const TriangleMesh& mesh) {
  Scene scene;
  scene.objects.push_back({"mask", mesh, {}, "", false});
  return RayScene(scene);
}

template <typename T>
uint64_t HashVector(const std::vector<T>& values, uint64_t hash) {
  return HashBytes({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)}, hash);
}

SampleSet EmptySet(size_t samples) {
  return SampleSet((samples + 63) / 64, 0);
}

void Insert(SampleSet& set, size_t sample) {
  set[sample / 64] |= uint64_t{1} << (sample % 64);
}

// A camera in single precision: 20,000 samples are projected for each of 10^5 pictures.
struct FastCamera {
  Vec3f centre;
  Eigen::Matrix3f rotation;
  Vec3f translation;
  float fx, fy, cx, cy, right, bottom;

  explicit FastCamera(const CameraModel& camera)
      : centre(camera.Centre().cast<float>()),
        rotation(camera.camera_from_world.rotation.cast<float>()),
        translation(camera.camera_from_world.translation.cast<float>()),
        fx(static_cast<float>(camera.fx)),
        fy(static_cast<float>(camera.fy)),
        cx(static_cast<float>(camera.cx)),
        cy(static_cast<float>(camera.cy)),
        right(static_cast<float>(camera.width) - 0.5f),
        bottom(static_cast<float>(camera.height) - 0.5f) {}

  struct Projection {
    float u, v, depth;
  };
  Projection Project(const Vec3f& point) const {
    const Vec3f in_camera = rotation * point + translation;
    return {fx * in_camera.x() / in_camera.z() + cx, fy * in_camera.y() / in_camera.z() + cy,
            in_camera.z()};
  }
  bool InFrame(const Projection& p) const {
    return p.depth > 0.0f && p.u >= -0.5f && p.v >= -0.5f && p.u <= right && p.v <= bottom;
  }
  bool Faces(const Vec3f& position, const Vec3f& normal) const {
    return normal.dot(centre - position) > 0.0f;
  }
  // What a surface is raised by before something may hide it: where it is seen at a grazing angle,
  // rounded coordinates would make it hide itself.
  float Rounding_mm(const Vec3f& position) const {
    return 8.0f * std::numeric_limits<float>::epsilon() * (centre - position).norm();
  }
};

}  // namespace

VisibilityRule VisibilityRuleNamed(const std::string& name) {
  for (size_t i = 0; i < kRuleNames.size(); ++i) {
    if (name == kRuleNames[i]) return static_cast<VisibilityRule>(i);
  }
  throw InputError(fmt::format("no visibility rule '{}'; expected ids, rays or triangles", name));
}

const char* NameOf(VisibilityRule rule) {
  return kRuleNames[static_cast<size_t>(rule)];
}

Mask::Mask(std::string name, TriangleMesh mesh, VisibilityRule rule, double part_area_mm2,
           uint64_t sample_seed)
    : name_(std::move(name)),
      mesh_(std::move(mesh)),
      rule_(rule),
      samples_(rule == VisibilityRule::kTriangles
                   ? TriangleCentres(mesh_)
                   : SampleSurface(mesh_, part_area_mm2, sample_seed)),
      rays_(TraceableMesh(mesh_)) {
  if (!(samples_.area_mm2 > 0.0))
    throw InputError(fmt::format("mask {}: a mesh of zero area; expected triangles", name_));
  for (const Vec3f& position : mesh_.positions)
    radius_mm_ = std::max(radius_mm_, static_cast<double>(position.norm()));
  patches_ = Patches();
  uint64_t hash = HashVector(samples_.positions, HashBytes(NameOf(rule)));
  hash = HashVector(samples_.normals, HashVector(mesh_.positions, hash));
  hash_ = HexHash(HashVector(mesh_.triangles, hash));
}

SampleSet Mask::SeenBy(const CameraModel& camera_from_mask) const {
  return rule_ == VisibilityRule::kIdBuffer ? SeenInBuffer(camera_from_mask)
                                            : SeenByRays(camera_from_mask);
}

SampleSet Mask::SeenInBuffer(const CameraModel& camera) const {
  const IdBuffer buffer = RenderIdBuffer(rays_, camera, Crop(camera, mesh_.positions));
  const FastCamera fast(camera);
  const Eigen::Matrix3f mask_from_camera = fast.rotation.transpose();
  // What hides a sample is nearer and rises over the tangent plane there: a round surface lies
  // behind that plane in every pixel. One pixel's width is left for hollow ones.
  const float slack = 1.0f / fast.fx;
  SampleSet seen = EmptySet(samples_.Size());
  for (size_t i = 0; i < samples_.Size(); ++i) {
    const Vec3f &position = samples_.positions[i], &normal = samples_.normals[i];
    if (!fast.Faces(position, normal)) continue;
    const FastCamera::Projection at = fast.Project(position);
    if (!fast.InFrame(at)) continue;
    const int x = static_cast<int>(std::floor(at.u + 0.5f)) - buffer.crop.x0;
    const int y = static_cast<int>(std::floor(at.v + 0.5f)) - buffer.crop.y0;
    if (buffer.triangle.Contains(x, y)) {
      const size_t pixel = buffer.triangle.Index(x, y);
      const uint32_t triangle = buffer.triangle.data[pixel];
      if (triangle != IdBuffer::kNone && triangle != samples_.triangles[i]) {
        const Vec3f in_camera((static_cast<float>(x + buffer.crop.x0) - fast.cx) / fast.fx,
                              (static_cast<float>(y + buffer.crop.y0) - fast.cy) / fast.fy, 1.0f);
        const float reached = buffer.depth.data[pixel] + slack * at.depth;
        const float height =
            normal.dot(fast.centre - position) + reached * normal.dot(mask_from_camera * in_camera);
        if (reached < at.depth && height > fast.Rounding_mm(position)) continue;
      }
    }
    Insert(seen, i);
  }
  return seen;
}

bool Mask::CornersInFrame(const CameraModel& camera, uint32_t triangle) const {
  for (const uint32_t corner : mesh_.triangles[triangle]) {
    const auto px = camera.Project(mesh_.positions[corner].cast<double>());
    if (!px || !camera.InFrame(*px)) return false;
  }
  return true;
}

SampleSet Mask::SeenByRays(const CameraModel& camera) const {
  const FastCamera fast(camera);
  std::vector<uint32_t> candidates;
  std::vector<Vec3f> targets;
  for (size_t i = 0; i < samples_.Size(); ++i) {
    const Vec3f& position = samples_.positions[i];
    if (!fast.Faces(position, samples_.normals[i])) continue;
    const bool inside = rule_ == VisibilityRule::kTriangles
                            ? CornersInFrame(camera, samples_.triangles[i])
                            : fast.InFrame(fast.Project(position));
    if (!inside) continue;
    candidates.push_back(static_cast<uint32_t>(i));
    targets.push_back(position + fast.Rounding_mm(position) * samples_.normals[i]);
  }
  // Short of the sample by more than coordinates of 2 m are rounded.
  constexpr float kMargin = 1e-5f;
  std::vector<uint8_t> hidden(targets.size());
  rays_.OccludedFrom(fast.centre, targets, kMargin, hidden);
  SampleSet seen = EmptySet(samples_.Size());
  for (size_t i = 0; i < candidates.size(); ++i) {
    if (hidden[i] == 0) Insert(seen, candidates[i]);
  }
  return seen;
}

double Mask::AreaOutsidePicture(const CameraModel& camera_from_mask) const {
  const FastCamera fast(camera_from_mask);
  double area = 0.0;
  for (size_t i = 0; i < samples_.Size(); ++i) {
    const Vec3f& position = samples_.positions[i];
    if (fast.Faces(position, samples_.normals[i]) && !fast.InFrame(fast.Project(position)))
      area += static_cast<double>(samples_.areas_mm2[i]);
  }
  return area;
}

namespace {

// The solid with everything within `margin` of it and a little more; for a negative margin, what is
// left when that much and a little more is taken off its surface. Nothing if nothing is left.
std::optional<TruncatedCone> Inflated(const TruncatedCone& cone, double margin) {
  const double slope = std::abs(cone.top_radius_mm - cone.base_radius_mm) / cone.length_mm;
  const double wider = margin * (1.0 + slope);
  const TruncatedCone inflated = {cone.base - margin * cone.axis, cone.axis,
                                  cone.length_mm + 2.0 * margin, cone.base_radius_mm + wider,
                                  cone.top_radius_mm + wider};
  if (inflated.length_mm <= 0.0 || inflated.base_radius_mm <= 0.0 || inflated.top_radius_mm <= 0.0)
    return std::nullopt;
  return inflated;
}

}  // namespace

std::vector<Mask::Patch> Mask::Patches() const {
  std::vector<Patch> patches;
  for (size_t first = 0; first < samples_.Size(); first += 64) {
    const size_t last = std::min(first + 64, samples_.Size());
    Patch patch{Vec3d::Zero()};
    for (size_t i = first; i < last; ++i)
      patch.centre += samples_.positions[i].cast<double>() / static_cast<double>(last - first);
    for (size_t i = first; i < last; ++i) {
      patch.radius_mm =
          std::max(patch.radius_mm, (samples_.positions[i].cast<double>() - patch.centre).norm());
      for (const uint32_t corner : mesh_.triangles[samples_.triangles[i]]) {
        patch.radius_mm = std::max(patch.radius_mm,
                                   (mesh_.positions[corner].cast<double>() - patch.centre).norm());
      }
    }
    patches.push_back(patch);
  }
  return patches;
}

bool Mask::HiddenSample(size_t sample, const Mat3d& world_from_mask,
                        const std::vector<TruncatedCone>& solids,
                        const Vec3d& camera_centre) const {
  const auto hidden = [&](const Vec3f& in_mask) {
    const Vec3d point = world_from_mask * in_mask.cast<double>();
    return std::any_of(solids.begin(), solids.end(), [&](const TruncatedCone& solid) {
      return SegmentHits(solid, point, camera_centre);
    });
  };
  if (rule_ != VisibilityRule::kTriangles) return hidden(samples_.positions[sample]);
  const auto& corners = mesh_.triangles[samples_.triangles[sample]];
  return std::any_of(corners.begin(), corners.end(),
                     [&](uint32_t corner) { return hidden(mesh_.positions[corner]); });
}

void Mask::RemoveHidden(SampleSet& seen, const Mat3d& world_from_mask,
                        const std::vector<PlacedNozzle>& nozzles,
                        const Vec3d& camera_centre) const {
  // Lines of sight that start within r of each other stay so: a patch is all in sight if the
  // line from its centre passes a solid by its radius, and all hidden if it passes that deep
  // through one. Only the patches between are looked at sample by sample.
  std::vector<TruncatedCone> solids;  // those that can hide any of the mask at all
  for (const PlacedNozzle& nozzle : nozzles) {
    for (const TruncatedCone& solid : {nozzle.snout, nozzle.cylinder}) {
      if (SegmentHits(*Inflated(solid, radius_mm_), Vec3d::Zero(), camera_centre))
        solids.push_back(solid);
    }
  }
  for (size_t word = 0; word < seen.size() && !solids.empty(); ++word) {
    if (seen[word] == 0) continue;
    const Patch& patch = patches_[word];
    const Vec3d centre = world_from_mask * patch.centre;
    bool near = false, inside = false;
    for (const TruncatedCone& solid : solids) {
      if (!SegmentHits(*Inflated(solid, patch.radius_mm), centre, camera_centre)) continue;
      near = true;
      const auto core = Inflated(solid, -patch.radius_mm);
      inside = inside || (core && SegmentHits(*core, centre, camera_centre));
    }
    if (inside) seen[word] = 0;
    for (uint64_t rest = near ? seen[word] : 0; rest != 0; rest &= rest - 1) {
      const auto bit = static_cast<size_t>(std::countr_zero(rest));
      if (HiddenSample(word * 64 + bit, world_from_mask, solids, camera_centre))
        seen[word] &= ~(uint64_t{1} << bit);
    }
  }
}

double Mask::AreaOf(const SampleSet& set) const {
  double area = 0.0;
  for (size_t word = 0; word < set.size(); ++word) {
    for (uint64_t rest = set[word]; rest != 0; rest &= rest - 1)
      area += static_cast<double>(
          samples_.areas_mm2[word * 64 + static_cast<size_t>(std::countr_zero(rest))]);
  }
  return area;
}

}  // namespace retrolux
