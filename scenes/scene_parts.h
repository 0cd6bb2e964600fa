// What the built-in scenes are put together from.
#pragma once

#include <string>

#include "scenes/scene.h"

namespace retrolux {

// An object at the world's origin; its material is taken from the library.
void AddObject(Scene& scene, const std::string& name, TriangleMesh mesh,
               const std::string& material, bool moves_with_pose = false);

// The thesis's camera (640 x 480 px, 12.18 x 9.15 degrees) with filter and diode ring, looking at
// the origin from `eye`, `up` upwards in the picture.
CameraSpec ThesisCamera(const std::string& name, const Vec3d& eye, const Vec3d& up);

}  // namespace retrolux
