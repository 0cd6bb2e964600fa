#include "renderer/bare_embree.h"

#include <embree3/rtcore.h>

#include <limits>

namespace retrolux {

struct BareEmbree::Impl {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene tree = rtcNewScene(device);

  Impl() = default;
  ~Impl() {
    rtcReleaseScene(tree);
    rtcReleaseDevice(device);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void Add(const SceneObject& object) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<Vec3f*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(Vec3f), object.mesh.positions.size()));
    for (const Vec3f& position : object.mesh.positions)
      *vertices++ = (object.world_from_object * position.cast<double>()).cast<float>();
    auto* indices = static_cast<std::array<uint32_t, 3>*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                sizeof(object.mesh.triangles[0]), object.mesh.triangles.size()));
    std::copy(object.mesh.triangles.begin(), object.mesh.triangles.end(), indices);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(tree, geometry);
    rtcReleaseGeometry(geometry);
  }
};

namespace {

RTCRay RayAlong(const Vec3f& origin, const Vec3f& direction, float length) {
  RTCRay ray{};
  ray.org_x = origin.x(), ray.org_y = origin.y(), ray.org_z = origin.z();
  ray.dir_x = direction.x(), ray.dir_y = direction.y(), ray.dir_z = direction.z();
  ray.tfar = length;
  ray.mask = ~0u;
  return ray;
}

}  // namespace

BareEmbree::BareEmbree(const Scene& scene) : impl_(std::make_unique<Impl>()) {
  for (const SceneObject& object : scene.objects) impl_->Add(object);
  rtcCommitScene(impl_->tree);
}
BareEmbree::~BareEmbree() = default;
BareEmbree::BareEmbree(BareEmbree&&) noexcept = default;
BareEmbree& BareEmbree::operator=(BareEmbree&&) noexcept = default;

int BareEmbree::Hits(const Vec3f& origin, std::span<const Vec3f> directions) const {
  int hits = 0;
  for (const Vec3f& direction : directions) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray{};
    ray.ray = RayAlong(origin, direction, std::numeric_limits<float>::infinity());
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(impl_->tree, &context, &ray);
    hits += ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }
  return hits;
}

int BareEmbree::HitsInPackets(const Vec3f& origin, std::span<const Vec3f> directions) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(64) int valid[16];
  std::fill(valid, valid + 16, -1);
  int hits = 0;
  for (size_t first = 0; first + 16 <= directions.size(); first += 16) {
    RTCRayHit16 packet{};
    for (size_t i = 0; i < 16; ++i) {
      const Vec3f& direction = directions[first + i];
      packet.ray.org_x[i] = origin.x();
      packet.ray.org_y[i] = origin.y();
      packet.ray.org_z[i] = origin.z();
      packet.ray.dir_x[i] = direction.x();
      packet.ray.dir_y[i] = direction.y();
      packet.ray.dir_z[i] = direction.z();
      packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
      packet.ray.mask[i] = ~0u;
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect16(valid, impl_->tree, &context, &packet);
    for (size_t i = 0; i < 16; ++i) hits += packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
  }
  return hits;
}

int BareEmbree::Blocked(const Vec3f& origin, std::span<const Vec3f> directions) const {
  int blocked = 0;
  for (const Vec3f& direction : directions) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = RayAlong(origin, direction, 1.0f);
    rtcOccluded1(impl_->tree, &context, &ray);
    blocked += ray.tfar < 0.0f;
  }
  return blocked;
}

}  // namespace retrolux
