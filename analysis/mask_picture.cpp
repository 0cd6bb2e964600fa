#include "analysis/mask_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/image_file.h"

namespace retrolux {

namespace {

using Colour = std::array<uint8_t, 3>;

// Between the lightest and the darkest of the categories, so that both stand out.
constexpr Colour kBackground = {128, 133, 140};
constexpr Colour kInnerSide = {92, 96, 102};
constexpr Colour kRoom = {22, 24, 28};
constexpr int kOversampling = 2;

Colour ColourNamed(const std::string& css) {
  RETROLUX_CHECK(css.size() == 7 && css[0] == '#', "colour '{}'", css);
  const unsigned long rgb = std::stoul(css.substr(1), nullptr, 16);
  return {static_cast<uint8_t>(rgb >> 16), static_cast<uint8_t>(rgb >> 8 & 255),
          static_cast<uint8_t>(rgb & 255)};
}

// Lit from the camera; never dark enough to be taken for another colour.
Colour Lit(const Colour& colour, double facing) {
  const double light = 0.5 + 0.5 * facing;
  Colour lit{};
  for (size_t k = 0; k < 3; ++k) lit[k] = static_cast<uint8_t>(std::lround(light * colour[k]));
  return lit;
}

// Neighbours in number are far apart in hue; none is as dark as the room.
Colour ColourOfId(uint32_t id) {
  uint32_t hash = (id + 1) * 0x9e3779b9u;
  hash = (hash ^ (hash >> 15)) * 0x85ebca6bu;
  hash ^= hash >> 13;
  const double hue = 6.0 * (hash & 0xffffu) / 65536.0;
  const double value = 175.0 + 80.0 * ((hash >> 16) & 0xffu) / 255.0;
  const double saturation = 0.35 + 0.4 * (hash >> 24) / 255.0;
  Colour colour{};
  for (size_t k = 0; k < 3; ++k) {
    const double place = std::fmod(hue + 5.0 - 2.0 * static_cast<double>(k), 6.0);
    const double weight = std::clamp(std::min(place, 4.0 - place), 0.0, 1.0);
    colour[k] = static_cast<uint8_t>(std::lround(value * (1.0 - saturation * weight)));
  }
  return colour;
}

Scene SceneOf(const TriangleMesh& mesh) {
  Scene scene;
  scene.objects.push_back({"mask", mesh, {}, "", false});
  return scene;
}

IdBuffer IdsOfFrame(const RayScene& rays, const CameraModel& camera) {
  return RenderIdBuffer(rays, camera, {0, 0, camera.width, camera.height});
}

RgbPicture Reduced(const RgbPicture& large, int factor) {
  RgbPicture small(large.width / factor, large.height / factor, {0, 0, 0});
  const int samples = factor * factor;
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      std::array<int, 3> sum{};
      for (int i = 0; i < samples; ++i) {
        const Colour colour = large.At(factor * x + i % factor, factor * y + i / factor);
        for (size_t k = 0; k < 3; ++k) sum[k] += colour[k];
      }
      Colour mean{};
      for (size_t k = 0; k < 3; ++k)
        mean[k] = static_cast<uint8_t>((sum[k] + samples / 2) / samples);
      small.Set(x, y, mean);
    }
  }
  return small;
}

// Where a ray meets the nearest nozzle, and of which part of it.
struct NozzleHit {
  double distance = std::numeric_limits<double>::infinity();
  bool snout = false;
};

NozzleHit NearestNozzle(const std::vector<PlacedNozzle>& nozzles, const Ray& ray) {
  NozzleHit nearest;
  for (const PlacedNozzle& nozzle : nozzles) {
    for (const bool snout : {true, false}) {
      const auto hit = FirstHit(snout ? nozzle.snout : nozzle.cylinder, ray);
      if (hit && *hit < nearest.distance) nearest = {*hit, snout};
    }
  }
  return nearest;
}

Colour Hatched(bool snout, int x, int y) {
  constexpr int kPeriod_px = 14, kStripe_px = 5;
  const bool stripe = (x + y) % kPeriod_px < kStripe_px;
  const auto grey = static_cast<uint8_t>((snout ? 165 : 120) - (stripe ? 45 : 0));
  return {grey, grey, grey};
}

}  // namespace

RgbPicture::RgbPicture(int width_px, int height_px, const Colour& fill)
    : width(width_px), height(height_px) {
  rgb.reserve(3 * static_cast<size_t>(width) * static_cast<size_t>(height));
  for (int i = 0; i < width * height; ++i) rgb.insert(rgb.end(), fill.begin(), fill.end());
}

Colour RgbPicture::At(int x, int y) const {
  const size_t at =
      3 * (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x));
  return {rgb[at], rgb[at + 1], rgb[at + 2]};
}

void RgbPicture::Set(int x, int y, const Colour& colour) {
  const size_t at =
      3 * (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x));
  std::copy(colour.begin(), colour.end(), rgb.begin() + static_cast<std::ptrdiff_t>(at));
}

std::string RgbPicture::Png() const {
  return EncodeRgbPng(width, height, rgb);
}

std::vector<int> CamerasPerTriangle(const SurfaceSamples& samples, size_t triangles,
                                    std::span<const SampleSet> sets) {
  std::vector<int> counts(triangles, 0);
  std::vector<double> total(triangles, 0.0);
  for (size_t i = 0; i < samples.Size(); ++i) {
    total[samples.triangles[i]] += static_cast<double>(samples.areas_mm2[i]);
  }
  for (const SampleSet& set : sets) {
    std::vector<double> seen(triangles, 0.0);
    for (size_t i = 0; i < samples.Size(); ++i) {
      if (Contains(set, i)) seen[samples.triangles[i]] += static_cast<double>(samples.areas_mm2[i]);
    }
    for (size_t t = 0; t < triangles; ++t) counts[t] += seen[t] > 0.5 * total[t] ? 1 : 0;
  }
  return counts;
}

namespace {

// The mean of the surface's normals, weighted by area; +x for a closed mesh.
Vec3d FrontOf(const TriangleMesh& mesh) {
  Vec3d sum = Vec3d::Zero();
  for (const auto& t : mesh.triangles) {
    const Vec3d a = mesh.positions[t[0]].cast<double>();
    sum += 0.5 *
           (mesh.positions[t[1]].cast<double>() - a).cross(mesh.positions[t[2]].cast<double>() - a);
  }
  return sum.norm() > 1e-3 * mesh.Area() ? Vec3d(sum.normalized()) : Vec3d::UnitX();
}

// The top of a mask that stands (face), or the head's end of one that lies (body: feet at +x).
Vec3d UpOf(const Vec3d& front) {
  return std::abs(front.z()) < 0.7 ? Vec3d(Vec3d::UnitZ()) : Vec3d(-Vec3d::UnitX());
}

}  // namespace

std::vector<Viewpoint> ViewpointsOf(const TriangleMesh& mesh, int width_px, int height_px) {
  constexpr double kSide_deg = 60.0;
  constexpr double kDistanceInRadii = 6.0;
  Eigen::AlignedBox3d box;
  for (const Vec3f& position : mesh.positions) box.extend(position.cast<double>());
  const Vec3d middle = box.center();
  double radius = 0.0;
  for (const Vec3f& position : mesh.positions)
    radius = std::max(radius, (position.cast<double>() - middle).norm());
  // The shorter side of the picture holds the sphere around the mesh.
  const double half = std::asin(1.0 / kDistanceInRadii);
  const double aspect = static_cast<double>(width_px) / height_px;
  const double vertical = 2.0 * std::atan(std::tan(half) / std::min(1.0, aspect));
  const double horizontal = 2.0 * std::atan(std::tan(0.5 * vertical) * aspect);
  const Vec3d front = FrontOf(mesh), up = UpOf(front);
  std::vector<Viewpoint> views;
  const std::pair<const char*, double> sides[] = {
      {"from its right", -kSide_deg}, {"from the front", 0.0}, {"from its left", kSide_deg}};
  for (const auto& [name, turn_deg] : sides) {
    const Vec3d direction = Eigen::AngleAxisd(RadFromDeg(turn_deg), up) * front;
    const Vec3d eye = middle + kDistanceInRadii * radius * direction;
    views.push_back(
        {name, CameraModel::FromFieldOfView(name, width_px, height_px, DegFromRad(horizontal),
                                            DegFromRad(vertical), LookAt(eye, middle, up))});
  }
  return views;
}

MaskPainter::MaskPainter(const TriangleMesh& mesh)
    : mesh_(mesh), scene_(SceneOf(mesh)), rays_(scene_) {}

double MaskPainter::Facing(uint32_t triangle, const Vec3d& camera_centre) const {
  const auto& t = mesh_.triangles[triangle];
  const Vec3d a = mesh_.positions[t[0]].cast<double>(), b = mesh_.positions[t[1]].cast<double>(),
              c = mesh_.positions[t[2]].cast<double>();
  return (b - a).cross(c - a).normalized().dot((camera_centre - a).normalized());
}

RgbPicture MaskPainter::Counts(const std::vector<int>& counts,
                               const std::vector<OvalCategory>& colours,
                               const CameraModel& camera_from_mask) const {
  const CameraModel camera = camera_from_mask.Resized(kOversampling * camera_from_mask.width,
                                                      kOversampling * camera_from_mask.height);
  const IdBuffer ids = IdsOfFrame(rays_, camera);
  const Vec3d centre = camera.Centre();
  RgbPicture picture(camera.width, camera.height, kBackground);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const uint32_t triangle = ids.triangle(x, y);
      if (triangle == IdBuffer::kNone) continue;
      const double facing = Facing(triangle, centre);
      const auto count = static_cast<size_t>(counts[triangle]);
      picture.Set(x, y,
                  facing < 0.0 ? kInnerSide : Lit(ColourNamed(colours.at(count).colour), facing));
    }
  }
  return Reduced(picture, kOversampling);
}

RgbPicture MaskPainter::Ids(const CameraModel& camera, const Mat3d& world_from_mask,
                            const std::vector<PlacedNozzle>& nozzles) const {
  CameraModel from_mask = camera;
  from_mask.camera_from_world =
      camera.camera_from_world * RigidTransform{world_from_mask, Vec3d::Zero()};
  const IdBuffer ids = IdsOfFrame(rays_, from_mask);
  const Vec3d centre = from_mask.Centre();
  RgbPicture picture(camera.width, camera.height, kRoom);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Ray ray = camera.RayThrough({x, y});
      const NozzleHit nozzle = NearestNozzle(nozzles, ray);
      const uint32_t triangle = ids.triangle(x, y);
      // The buffer's depth is along the camera's axis; infinite where no mask is.
      const double mask_distance =
          static_cast<double>(ids.depth(x, y)) / ray.direction.dot(camera.Forward());
      if (nozzle.distance < mask_distance) {
        picture.Set(x, y, Hatched(nozzle.snout, x, y));
      } else if (triangle != IdBuffer::kNone) {
        const double facing = Facing(triangle, centre);
        picture.Set(x, y, facing < 0.0 ? kInnerSide : Lit(ColourOfId(triangle), facing));
      }
    }
  }
  return picture;
}

}  // namespace retrolux
