#include "analysis/hotspot_room.h"

#include <array>

#include "core/error.h"

namespace retrolux {

namespace {

// On the oval, which is looked at from 41 degrees off its top in front and 65 degrees behind: three
// around where its normal points at the front cameras, three around where it does at the back ones.
constexpr std::array<std::array<double, 3>, 6> kPlaces = {
    {{75, -45, 60}, {70, 0, 95}, {75, 45, 60}, {55, -40, -100}, {75, 0, -85}, {55, 40, -100}}};

}  // namespace

Scene HotspotRoom(const Scene& room) {
  Scene scene = room;
  for (const CameraSpec& camera : scene.cameras) {
    if (!camera.ring)
      throw InputError(fmt::format("scene '{}': camera '{}' has no ring; expected one on each",
                                   scene.name, camera.model.name));
  }
  if (!scene.markers.empty()) return scene;
  scene.Object("mask");
  scene.UseMaterial("retro_bead");
  for (size_t i = 0; i < kPlaces.size(); ++i) {
    const int number = static_cast<int>(i) + 1;
    scene.markers.push_back({fmt::format("marker-{}", number), number, "mask",
                             Vec3d(kPlaces[i].data()), 15.0 * static_cast<double>(i)});
  }
  return scene;
}

}  // namespace retrolux
