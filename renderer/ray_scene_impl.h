// What stands behind RayScene: Embree's tree, and what Embree does not hold of the bodies in it.
// For ray_scene.cpp (single rays), ray_geometry.cpp and ray_packets.cpp only.
#pragma once

#include <embree3/rtcore.h>

#include <algorithm>

#include "renderer/ray_scene.h"
#include "scenes/marker_placement.h"

namespace retrolux {

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

struct RayScene::Impl {
  RTCDevice device = nullptr;
  RTCScene tree = nullptr;
  uint32_t objects = 0;
  uint32_t rings = 0;
  bool wide_packets = false;
  std::vector<Body> bodies;

  Impl();
  ~Impl();
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void AddTriangles(const std::string& name, const TriangleMesh& mesh,
                    const RigidTransform& world_from_object,
                    const std::optional<Perforation>& perforation = std::nullopt);
  // The emitting surfaces of a ring's LEDs, kLedCorners triangles each about its centre.
  void AddRing(const CameraSpec& camera);
  void AddPanels(const std::vector<LightPanel>& panels);
  // Markers close the holes under them.
  void CoverHoles(const Scene& scene);

  SurfaceHit Resolve(const Vec3f& origin, const Vec3f& direction, uint32_t body_id,
                     uint32_t primitive, float u, float v, float distance) const;
};

}  // namespace retrolux
