#include "renderer/id_pass.h"

#include "core/parallel.h"

namespace retrolux {

namespace {

uint32_t MarkerAt(const std::vector<PlacedMarker>& markers, const SurfaceHit& hit) {
  for (const PlacedMarker& marker : markers) {
    if (marker.object != hit.body) continue;
    const auto place =
        marker.Locate(hit.position.cast<double>(), hit.geometric_normal.cast<double>());
    if (place && marker.IsBright(*place)) return marker.instance;
  }
  return 0;
}

}  // namespace

IdBuffers RenderIds(const RayScene& rays, const CameraModel& camera,
                    const std::vector<PlacedMarker>& markers) {
  const int width = camera.width, height = camera.height;
  IdBuffers ids{IdPlane(width, height),
                IdPlane(width, height),
                IdPlane(width, height),
                FloatPlane(width, height),
                {},
                {}};
  ids.position.fill(FloatPlane(width, height));
  ids.normal.fill(FloatPlane(width, height));
  const Vec3f origin = camera.Centre().cast<float>();
  const Eigen::Matrix3f world_from_camera =
      camera.camera_from_world.rotation.transpose().cast<float>();
  ParallelFor(height, [&](int64_t row) {
    const int y = static_cast<int>(row);
    std::vector<Vec3f> directions(static_cast<size_t>(width));
    std::vector<RayScene::PacketHit> hits(directions.size());
    for (int x = 0; x < width; ++x) {
      // Camera z = 1, so that the distance along the ray is the depth along the axis.
      const Vec3d in_camera = camera.PlanePoint(Vec2d(x, y))->homogeneous();
      directions[static_cast<size_t>(x)] = world_from_camera * in_camera.cast<float>();
    }
    rays.IntersectPacket(origin, directions, hits);
    for (int x = 0; x < width; ++x) {
      const RayScene::PacketHit& packet = hits[static_cast<size_t>(x)];
      if (packet.body == RayScene::PacketHit::kNone) continue;
      const SurfaceHit hit = rays.Resolve(origin, directions[static_cast<size_t>(x)], packet);
      const size_t i = ids.object.Index(x, y);
      ids.object.data[i] = hit.body + 1;
      ids.triangle.data[i] = hit.primitive + 1;
      ids.marker.data[i] = MarkerAt(markers, hit);
      ids.depth.data[i] = hit.distance;
      for (size_t axis = 0; axis < 3; ++axis) {
        ids.position[axis].data[i] = hit.position[static_cast<Eigen::Index>(axis)];
        ids.normal[axis].data[i] = hit.shading_normal[static_cast<Eigen::Index>(axis)];
      }
    }
  });
  return ids;
}

}  // namespace retrolux
