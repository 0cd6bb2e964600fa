// Rays against the geometry of a scene. The only part that knows Embree.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "scenes/scene.h"

namespace retrolux {

// Where a ray meets a surface, in world coordinates. Both normals are unit vectors and face the
// ray's origin; the shading normal is interpolated where the mesh has vertex normals.
struct SurfaceHit {
  float distance = 0.0f;
  Vec3f position;
  Vec3f geometric_normal;
  Vec3f shading_normal;
  Vec2f uv = Vec2f::Zero();  // texture coordinates, where the mesh has some
  // Index of what was hit: first the objects of the scene, then the rings (in the order of the
  // cameras that have one), then the light panels as one.
  uint32_t body = 0;
  uint32_t primitive =
      0;  // triangle of an object, of a ring (kLedCorners an LED), of the panels (two each)
};

class RayScene {
 public:
  // Builds the acceleration structure; nothing of `scene` is needed afterwards. Rays pass through
  // the holes of perforated objects, but for those under the scene's markers.
  explicit RayScene(const Scene& scene);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  std::optional<SurfaceHit> Intersect(const Vec3f& origin, const Vec3f& direction,
                                      float max_distance) const;
  std::optional<SurfaceHit> Intersect(const Vec3f& origin, const Vec3f& direction) const;
  // Whether anything lies on the segment, its last thousandth of a millimetre left out.
  bool Occluded(const Vec3f& origin, const Vec3f& target) const;

  // The nearest hits of many rays from one origin, in packets of 16 (8 where the processor has no
  // wider ones); hits[i] belongs to directions[i]. Directions need not have unit length: distances
  // are in their units.
  struct PacketHit {
    static constexpr uint32_t kNone = 0xffffffffu;
    uint32_t body = kNone;
    uint32_t primitive = 0;
    float u = 0.0f, v = 0.0f, distance = 0.0f;
  };
  void IntersectPacket(const Vec3f& origin, std::span<const Vec3f> directions,
                       std::span<PacketHit> hits) const;
  // The nearest hits of a grid of rays from one origin, ray (x, y) along first + x step_x + y
  // step_y: row by row the primitive (kNone: nothing) and the distance in units of the ray's
  // direction. Traced in packets of neighbours, several times as fast as IntersectPacket's rows of
  // small tiles.
  struct RayGrid {
    Vec3f origin, first, step_x, step_y;
    int width = 0, height = 0;
  };
  void IntersectGrid(const RayGrid& grid, std::span<uint32_t> primitives,
                     std::span<float> distances) const;
  // hidden[i] = 1 if anything lies between the origin and targets[i], the last `margin` of the way
  // (a fraction) left out. In packets; neighbours in `targets` should be neighbours in space.
  void OccludedFrom(const Vec3f& origin, std::span<const Vec3f> targets, float margin,
                    std::span<uint8_t> hidden) const;
  // What Intersect would have said about a packet's hit.
  SurfaceHit Resolve(const Vec3f& origin, const Vec3f& direction, const PacketHit& hit) const;

  uint32_t ObjectCount() const;
  uint32_t RingCount() const;
  bool IsObject(uint32_t body) const { return body < ObjectCount(); }
  // The names behind `body`, objects, rings and panels.
  std::vector<std::string> BodyNames() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// A point moved off its surface along the geometric normal, so that a ray that starts there does
// not meet the surface again.
inline Vec3f OffSurface(const Vec3f& position, const Vec3f& geometric_normal) {
  // Ten times the rounding of coordinates of 4 m in single precision.
  constexpr float kOffset_mm = 5e-3f;
  return position + kOffset_mm * geometric_normal;
}

}  // namespace retrolux
