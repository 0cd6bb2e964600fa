// The geometry of a scene as Embree holds it.
#include <algorithm>

#include "renderer/ray_scene_impl.h"

namespace retrolux {

namespace {

void OnEmbreeError(void*, RTCError code, const char* message) {
  if (code == RTC_ERROR_OUT_OF_MEMORY) throw TryAgainError("not enough memory for the geometry");
  throw std::logic_error(fmt::format("Embree error {}: {}", static_cast<int>(code), message));
}

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

RayScene::Impl::Impl() {
  device = rtcNewDevice(nullptr);
  rtcSetDeviceErrorFunction(device, OnEmbreeError, nullptr);
  tree = rtcNewScene(device);
  // Without it one ray in 10^5 slips between two triangles, and every 25th of those aimed at an
  // edge.
  rtcSetSceneFlags(tree, RTC_SCENE_FLAG_ROBUST);
  wide_packets = rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
}

RayScene::Impl::~Impl() {
  rtcReleaseScene(tree);
  rtcReleaseDevice(device);
}

void RayScene::Impl::AddTriangles(const std::string& name, const TriangleMesh& mesh,
                                  const RigidTransform& world_from_object,
                                  const std::optional<Perforation>& perforation) {
  Body body{name, {}, mesh.triangles, {}, mesh.uvs, nullptr};
  for (const Vec3f& p : mesh.positions)
    body.positions.push_back((world_from_object * p.cast<double>()).cast<float>());
  for (const Vec3f& n : mesh.normals) {
    body.normals.push_back((world_from_object.rotation * n.cast<double>()).cast<float>());
  }
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices =
      NewBuffer<Vec3f>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, body.positions.size());
  std::copy(body.positions.begin(), body.positions.end(), vertices);
  auto* indices = NewBuffer<std::array<uint32_t, 3>>(geometry, RTC_BUFFER_TYPE_INDEX,
                                                     RTC_FORMAT_UINT3, body.triangles.size());
  std::copy(body.triangles.begin(), body.triangles.end(), indices);
  if (perforation) {
    body.holes =
        std::make_unique<Holes>(Holes{HolePattern(*perforation), world_from_object.Inverse(), {}});
    rtcSetGeometryUserData(geometry, body.holes.get());
    rtcSetGeometryIntersectFilterFunction(geometry, PassHoles);
    rtcSetGeometryOccludedFilterFunction(geometry, PassHoles);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(tree, geometry, static_cast<uint32_t>(bodies.size()));
  rtcReleaseGeometry(geometry);
  bodies.push_back(std::move(body));
}

void RayScene::Impl::AddRing(const CameraSpec& camera) {
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

void RayScene::Impl::AddPanels(const std::vector<LightPanel>& panels) {
  TriangleMesh mesh;
  for (const LightPanel& panel : panels) {
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (const Vec3d& corner :
         {panel.corner, Vec3d(panel.corner + panel.edge_u),
          Vec3d(panel.corner + panel.edge_u + panel.edge_v), Vec3d(panel.corner + panel.edge_v)}) {
      mesh.positions.push_back(corner.cast<float>());
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  AddTriangles("panels", mesh, {});
}

void RayScene::Impl::CoverHoles(const Scene& scene) {
  for (size_t i = 0; i < scene.markers.size(); ++i) {
    const PlacedMarker marker = PlaceMarker(scene, scene.markers[i], static_cast<uint32_t>(i + 1));
    if (Body& body = bodies[marker.object]; body.holes) body.holes->covers.push_back(marker);
  }
}

}  // namespace retrolux
