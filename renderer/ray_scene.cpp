#include "renderer/ray_scene.h"

#include <limits>

#include "core/parallel.h"
#include "renderer/ray_scene_impl.h"

namespace retrolux {

RayScene::RayScene(const Scene& scene) : impl_(std::make_unique<Impl>()) {
  for (const SceneObject& object : scene.objects)
    impl_->AddTriangles(object.name, object.mesh, object.world_from_object, object.perforation);
  impl_->objects = static_cast<uint32_t>(scene.objects.size());
  for (const CameraSpec& camera : scene.cameras) {
    if (!camera.ring) continue;
    impl_->AddRing(camera);
    ++impl_->rings;
  }
  if (!scene.ambient.panels.empty()) impl_->AddPanels(scene.ambient.panels);
  // Built by one thread, so that the tree, and with it ties on edges, are the same on every run.
  // (Embree's own option for that would limit the whole process.)
  const LimitThreads one(1);
  rtcCommitScene(impl_->tree);
  impl_->CoverHoles(scene);
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

SurfaceHit RayScene::Impl::Resolve(const Vec3f& origin, const Vec3f& direction, uint32_t body_id,
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
  if (hit.shading_normal.dot(hit.geometric_normal) < 0.0f) hit.shading_normal = -hit.shading_normal;
  return hit;
}

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
