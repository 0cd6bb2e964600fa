#include "scenes/masks.h"

#include "core/error.h"
#include "scenes/mesh_shapes.h"

namespace retrolux {

namespace {

constexpr int kEllipsoidLevels = 5;  // 20,480 triangles

TriangleMesh DefaultFace() {
  return FaceMask();
}

// 280 x 200 x 200 mm, the long axis along z (thesis, section 3.4).
TriangleMesh Oval() {
  return EllipsoidMesh({100.0, 100.0, 140.0}, kEllipsoidLevels);
}

TriangleMesh Sphere() {
  return EllipsoidMesh(Vec3d::Constant(100.0), kEllipsoidLevels);
}

}  // namespace

const std::vector<MaskEntry>& Masks() {
  static const std::vector<MaskEntry> masks = {
      {"face", "a face's outer side, 76,459 mm2, looking along +x", DefaultFace},
      {"body", "a lying trunk's front, 450 x 360 x 110 mm, feet towards +x", BodyMask},
      {"oval", "an ellipsoid of 280 x 200 x 200 mm, long axis along z", Oval},
      {"sphere", "radius 100 mm", Sphere},
  };
  return masks;
}

std::vector<std::string> MaskNames() {
  std::vector<std::string> names;
  for (const MaskEntry& entry : Masks()) names.emplace_back(entry.name);
  return names;
}

TriangleMesh MakeMask(const std::string& name) {
  for (const MaskEntry& entry : Masks()) {
    if (name == entry.name) return entry.make();
  }
  const std::vector<std::string> names = MaskNames();
  const std::string nearest = NearestName(name, names);
  throw InputError(fmt::format(
      "no mask '{}'; expected {}", name,
      nearest.empty() ? fmt::format("one of {}", JoinNames(names)) : fmt::format("'{}'", nearest)));
}

}  // namespace retrolux
