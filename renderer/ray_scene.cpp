#include "renderer/ray_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "core/parallel.h"
#include "scenes/marker_placement.h"

namespace retrolux {

namespace {

void OnEmbreeError(void*, RTCError code, const char* message) {
  if (code == RTC_ERROR_OUT_OF_MEMORY) throw TryAgainError("not enough memory for the geometry");
  throw std::logic_error(fmt::format("Embree error {}: {}", static_cast<int>(code), message));
}

// The holes of a perforated object, some of them closed by markers.
struct Holes {
  HolePattern pattern;
  RigidTransform object_from_world;
  std::vector<PlacedMarker> covers;

  // x, direction, outward normal in the world.
  bool LetPass(const Vec3d& x, const Vec3d& direction, const Vec3d& normal) const {
    const Mat3d& turn = object_from_world.rotation;
    if (!pattern.LetsPass(object_from_world * x, turn * direction, turn * normal)) return false;
    return std::none_of(covers.begin(), covers.end(), [&](const PlacedMarker& marker) {
      const std::optional<Vec2d> place = marker.Locate(x, normal);
      return place && (marker.dark || marker.IsBright(*place));
    });
  }
};

// A mesh as Embree holds it, with what Embree does not hold.
struct Body {
  std::string name;
  std::vector<Vec3f> normals;  // world, per vertex; empty: flat
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<Vec3f> positions;
  std::vector<Vec2f> uvs;  // none, or per vertex
  std::unique_ptr<Holes> holes;
};

// Embree's filter function: hits where the sheet has a hole are none.
void PassHoles(const RTCFilterFunctionNArguments* query) {
  const auto& holes = *static_cast<const Holes*>(query->geometryUserPtr);
  for (unsigned int i = 0; i < query->N; ++i) {
    if (query->valid[i] != -1) continue;
    const RTCRay ray = rtcGetRayFromRayN(query->ray, query->N, i);
    const RTCHit hit = rtcGetHitFromHitN(query->hit, query->N, i);
    const Vec3f direction(ray.dir_x, ray.dir_y, ray.dir_z);
    const Vec3f x = Vec3f(ray.org_x, ray.org_y, ray.org_z) + ray.tfar * direction;
    const Vec3f normal(hit.Ng_x, hit.Ng_y, hit.Ng_z);
    if (holes.LetPass(x.cast<double>(), direction.cast<double>().normalized(),
                      normal.cast<double>().normalized())) {
      query->valid[i] = 0;
    }
  }
}

template <typename T>
T* NewBuffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, size_t count) {
  return static_cast<T*>(rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), count));
}

}  // namespace

struct RayScene::Impl {
  RTCDevice device = nullptr;
  RTCScene tree = nullptr;
  uint32_t objects = 0;
  uint32_t rings = 0;
  bool wide_packets = false;
  std::vector<Body> bodies;

  Impl() {
    device = rtcNewDevice(nullptr);
    rtcSetDeviceErrorFunction(device, OnEmbreeError, nullptr);
    tree = rtcNewScene(device);
    // Without it one ray in 10^5 slips between two triangles, and every 25th of those aimed at an
    // edge.
    rtcSetSceneFlags(tree, RTC_SCENE_FLAG_ROBUST);
    wide_packets = rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
  }
  ~Impl() {
    rtcReleaseScene(tree);
    rtcReleaseDevice(device);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void AddTriangles(const std::string& name, const TriangleMesh& mesh,
                    const RigidTransform& world_from_object,
                    const std::optional<Perforation>& perforation = std::nullopt) {
    Body body{name, {}, mesh.triangles, {}, mesh.uvs, nullptr};
    for (const Vec3f& p : mesh.positions)
      body.positions.push_back((world_from_object * p.cast<double>()).cast<float>());
    for (const Vec3f& n : mesh.normals) {
      body.normals.push_back((world_from_object.rotation * n.cast<double>()).cast<float>());
    }
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = NewBuffer<Vec3f>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3,
                                      body.positions.size());
    std::copy(body.positions.begin(), body.positions.end(), vertices);
    auto* indices = NewBuffer<std::array<uint32_t, 3>>(geometry, RTC_BUFFER_TYPE_INDEX,
                                                       RTC_FORMAT_UINT3, body.triangles.size());
    std::copy(body.triangles.begin(), body.triangles.end(), indices);
    if (perforation) {
      body.holes = std::make_unique<Holes>(
          Holes{HolePattern(*perforation), world_from_object.Inverse(), {}});
      rtcSetGeometryUserData(geometry, body.holes.get());
      rtcSetGeometryIntersectFilterFunction(geometry, PassHoles);
      rtcSetGeometryOccludedFilterFunction(geometry, PassHoles);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(tree, geometry, static_cast<uint32_t>(bodies.size()));
    rtcReleaseGeometry(geometry);
    bodies.push_back(std::move(body));
  }

  // The emitting surfaces of a ring's LEDs, kLedCorners triangles each about its centre.
  void AddRing(const CameraSpec& camera) {
    TriangleMesh mesh;
    for (int led = 0; led < camera.ring->count; ++led) {
      const auto centre = static_cast<uint32_t>(mesh.positions.size());
      mesh.positions.push_back(LedCentre(camera, led).cast<float>());
      for (const Vec3d& corner : LedOutline(camera, led))
        mesh.positions.push_back(corner.cast<float>());
      for (uint32_t i = 0; i < kLedCorners; ++i) {
        mesh.triangles.push_back({centre, centre + 1 + i, centre + 1 + (i + 1) % kLedCorners});
      }
    }
    AddTriangles("ring-" + camera.model.name, mesh, {});
  }

  void CoverHoles(const Scene& scene) {
    for (size_t i = 0; i < scene.markers.size(); ++i) {
      const PlacedMarker marker =
          PlaceMarker(scene, scene.markers[i], static_cast<uint32_t>(i + 1));
      if (Body& body = bodies[marker.object]; body.holes) body.holes->covers.push_back(marker);
    }
  }

  SurfaceHit Resolve(const Vec3f& origin, const Vec3f& direction, uint32_t body_id,
                     uint32_t primitive, float u, float v, float distance) const {
    SurfaceHit hit;
    hit.distance = distance;
    hit.body = body_id;
    hit.primitive = primitive;
    const Body& body = bodies[body_id];
    const auto& t = body.triangles[primitive];
    const Vec3f& a = body.positions[t[0]];
    const Vec3f ab = body.positions[t[1]] - a, ac = body.positions[t[2]] - a;
    hit.geometric_normal = ab.cross(ac).normalized();
    // The ray is right across its direction, also on triangles of metres; the triangle's plane is
    // right along it.
    const Vec3f on_ray = origin + distance * direction;
    hit.position = on_ray - hit.geometric_normal.dot(on_ray - a) * hit.geometric_normal;
    hit.shading_normal = hit.geometric_normal;
    if (!body.normals.empty()) {
      hit.shading_normal =
          ((1.0f - u - v) * body.normals[t[0]] + u * body.normals[t[1]] + v * body.normals[t[2]])
              .normalized();
    }
    if (!body.uvs.empty()) {
      hit.uv = (1.0f - u - v) * body.uvs[t[0]] + u * body.uvs[t[1]] + v * body.uvs[t[2]];
    }
    if (hit.geometric_normal.dot(direction) > 0.0f) hit.geometric_normal = -hit.geometric_normal;
    if (hit.shading_normal.dot(hit.geometric_normal) < 0.0f)
      hit.shading_normal = -hit.shading_normal;
    return hit;
  }
};

RayScene::RayScene(const Scene& scene) : impl_(std::make_unique<Impl>()) {
  for (const SceneObject& object : scene.objects)
    impl_->AddTriangles(object.name, object.mesh, object.world_from_object, object.perforation);
  impl_->objects = static_cast<uint32_t>(scene.objects.size());
  for (const CameraSpec& camera : scene.cameras) {
    if (!camera.ring) continue;
    impl_->AddRing(camera);
    ++impl_->rings;
  }
  if (!scene.ambient.panels.empty()) {
    TriangleMesh panels;
    for (const LightPanel& panel : scene.ambient.panels) {
      const auto first = static_cast<uint32_t>(panels.positions.size());
      for (const Vec3d& corner : {panel.corner, Vec3d(panel.corner + panel.edge_u),
                                  Vec3d(panel.corner + panel.edge_u + panel.edge_v),
                                  Vec3d(panel.corner + panel.edge_v)}) {
        panels.positions.push_back(corner.cast<float>());
      }
      panels.triangles.push_back({first, first + 1, first + 2});
      panels.triangles.push_back({first, first + 2, first + 3});
    }
    impl_->AddTriangles("panels", panels, {});
  }
  // Built by one thread, so that the tree, and with it ties on edges, are the same on every run.
  // (Embree's own option for that would limit the whole process.)
  const LimitThreads one(1);
  rtcCommitScene(impl_->tree);
  impl_->CoverHoles(scene);
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

std::optional<SurfaceHit> RayScene::Intersect(const Vec3f& origin, const Vec3f& direction) const {
  return Intersect(origin, direction, std::numeric_limits<float>::infinity());
}

std::optional<SurfaceHit> RayScene::Intersect(const Vec3f& origin, const Vec3f& direction,
                                              float max_distance) const {
  RTCRayHit query{};
  query.ray.org_x = origin.x();
  query.ray.org_y = origin.y();
  query.ray.org_z = origin.z();
  query.ray.dir_x = direction.x();
  query.ray.dir_y = direction.y();
  query.ray.dir_z = direction.z();
  query.ray.tfar = max_distance;
  query.ray.mask = ~0u;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(impl_->tree, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return impl_->Resolve(origin, direction, query.hit.geomID, query.hit.primID, query.hit.u,
                        query.hit.v, query.ray.tfar);
}

bool RayScene::Occluded(const Vec3f& origin, const Vec3f& target) const {
  const Vec3f segment = target - origin;
  const float length = segment.norm();
  if (length <= 0.0f) return false;
  RTCRay ray{};
  ray.org_x = origin.x();
  ray.org_y = origin.y();
  ray.org_z = origin.z();
  ray.dir_x = segment.x() / length;
  ray.dir_y = segment.y() / length;
  ray.dir_z = segment.z() / length;
  // The target lies on a body; stop short of it by more than its coordinates are rounded.
  ray.tfar = length - (1e-3f + 1e-6f * length);
  ray.mask = ~0u;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(impl_->tree, &context, &ray);
  return ray.tfar < 0.0f;
}

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

SurfaceHit RayScene::Resolve(const Vec3f& origin, const Vec3f& direction,
                             const PacketHit& hit) const {
  return impl_->Resolve(origin, direction, hit.body, hit.primitive, hit.u, hit.v, hit.distance);
}

uint32_t RayScene::ObjectCount() const {
  return impl_->objects;
}
uint32_t RayScene::RingCount() const {
  return impl_->rings;
}

std::vector<std::string> RayScene::BodyNames() const {
  std::vector<std::string> names;
  for (const Body& body : impl_->bodies) names.push_back(body.name);
  return names;
}

}  // namespace retrolux
