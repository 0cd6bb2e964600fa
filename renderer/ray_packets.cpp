// Many rays at once.
#include <algorithm>
#include <limits>

#include "renderer/ray_scene_impl.h"

namespace retrolux {

namespace {

template <typename RayHitN, int N, typename Trace>
void TracePackets(const Vec3f& origin, std::span<const Vec3f> directions,
                  std::span<RayScene::PacketHit> hits, Trace trace) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  for (size_t first = 0; first < directions.size(); first += N) {
    const size_t count = std::min<size_t>(N, directions.size() - first);
    RayHitN packet{};
    alignas(64) int valid[N];
    for (size_t i = 0; i < N; ++i) {
      valid[i] = i < count ? -1 : 0;
      const Vec3f& d = directions[first + std::min(i, count - 1)];
      packet.ray.org_x[i] = origin.x();
      packet.ray.org_y[i] = origin.y();
      packet.ray.org_z[i] = origin.z();
      packet.ray.dir_x[i] = d.x();
      packet.ray.dir_y[i] = d.y();
      packet.ray.dir_z[i] = d.z();
      packet.ray.tnear[i] = 0.0f;
      packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
      packet.ray.mask[i] = ~0u;
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    trace(valid, &context, &packet);
    for (size_t i = 0; i < count; ++i) {
      hits[first + i] = {packet.hit.geomID[i], packet.hit.primID[i], packet.hit.u[i],
                         packet.hit.v[i], packet.ray.tfar[i]};
    }
  }
}

}  // namespace

void RayScene::IntersectPacket(const Vec3f& origin, std::span<const Vec3f> directions,
                               std::span<PacketHit> hits) const {
  static_assert(PacketHit::kNone == RTC_INVALID_GEOMETRY_ID);
  if (impl_->wide_packets) {
    TracePackets<RTCRayHit16, 16>(origin, directions, hits,
                                  [&](const int* valid, RTCIntersectContext* c, RTCRayHit16* p) {
                                    rtcIntersect16(valid, impl_->tree, c, p);
                                  });
  } else {
    TracePackets<RTCRayHit8, 8>(origin, directions, hits,
                                [&](const int* valid, RTCIntersectContext* c, RTCRayHit8* p) {
                                  rtcIntersect8(valid, impl_->tree, c, p);
                                });
  }
}

namespace {

// Tiles of WIDTH x HEIGHT rays, a packet each.
template <typename RayHitN, int kWidth, int kHeight, typename Trace>
void TraceGrid(const RayScene::RayGrid& grid, std::span<uint32_t> primitives,
               std::span<float> distances, Trace trace) {
  constexpr int kRays = kWidth * kHeight;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(64) int valid[kRays];
  RayHitN packet{};
  for (int y0 = 0; y0 < grid.height; y0 += kHeight) {
    for (int x0 = 0; x0 < grid.width; x0 += kWidth) {
      for (int i = 0; i < kRays; ++i) {
        const int x = x0 + i % kWidth, y = y0 + i / kWidth;
        valid[i] = x < grid.width && y < grid.height ? -1 : 0;
        const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
        packet.ray.org_x[i] = grid.origin.x();
        packet.ray.org_y[i] = grid.origin.y();
        packet.ray.org_z[i] = grid.origin.z();
        packet.ray.dir_x[i] = grid.first.x() + fx * grid.step_x.x() + fy * grid.step_y.x();
        packet.ray.dir_y[i] = grid.first.y() + fx * grid.step_x.y() + fy * grid.step_y.y();
        packet.ray.dir_z[i] = grid.first.z() + fx * grid.step_x.z() + fy * grid.step_y.z();
        packet.ray.tnear[i] = 0.0f;
        packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
        packet.ray.mask[i] = ~0u;
        packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        packet.hit.primID[i] = RTC_INVALID_GEOMETRY_ID;
      }
      trace(valid, &context, &packet);
      for (int i = 0; i < kRays; ++i) {
        if (valid[i] == 0) continue;
        const size_t pixel =
            static_cast<size_t>(y0 + i / kWidth) * static_cast<size_t>(grid.width) +
            static_cast<size_t>(x0 + i % kWidth);
        primitives[pixel] = packet.hit.primID[i];
        distances[pixel] = packet.ray.tfar[i];
      }
    }
  }
}

}  // namespace

void RayScene::IntersectGrid(const RayGrid& grid, std::span<uint32_t> primitives,
                             std::span<float> distances) const {
  if (impl_->wide_packets) {
    TraceGrid<RTCRayHit16, 4, 4>(grid, primitives, distances,
                                 [&](const int* valid, RTCIntersectContext* c, RTCRayHit16* p) {
                                   rtcIntersect16(valid, impl_->tree, c, p);
                                 });
  } else {
    TraceGrid<RTCRayHit8, 4, 2>(grid, primitives, distances,
                                [&](const int* valid, RTCIntersectContext* c, RTCRayHit8* p) {
                                  rtcIntersect8(valid, impl_->tree, c, p);
                                });
  }
}

void RayScene::OccludedFrom(const Vec3f& origin, std::span<const Vec3f> targets, float margin,
                            std::span<uint8_t> hidden) const {
  constexpr size_t kRays = 8;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(64) int valid[kRays];
  RTCRay8 packet{};
  for (size_t first = 0; first < targets.size(); first += kRays) {
    const size_t count = std::min(kRays, targets.size() - first);
    for (size_t i = 0; i < kRays; ++i) {
      valid[i] = i < count ? -1 : 0;
      const Vec3f way = targets[first + std::min(i, count - 1)] - origin;
      packet.org_x[i] = origin.x();
      packet.org_y[i] = origin.y();
      packet.org_z[i] = origin.z();
      packet.dir_x[i] = way.x();
      packet.dir_y[i] = way.y();
      packet.dir_z[i] = way.z();
      packet.tfar[i] = 1.0f - margin;
      packet.mask[i] = ~0u;
    }
    rtcOccluded8(valid, impl_->tree, &context, &packet);
    for (size_t i = 0; i < count; ++i) hidden[first + i] = packet.tfar[i] < 0.0f ? 1 : 0;
  }
}

}  // namespace retrolux
