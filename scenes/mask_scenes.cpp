// A mask and cameras, nothing else: scenes to look at and to try things on.
#include "scenes/built_in.h"
#include "scenes/masks.h"
#include "scenes/scene_parts.h"

namespace retrolux {

namespace {

Scene MaskScene(const std::string& mask, const std::string& object) {
  Scene scene;
  scene.name = mask;
  AddObject(scene, object, MakeMask(mask), "mask");
  scene.UseMaterial("retro_bead");
  return scene;
}

// The six identifiable markers and a standard one, in this order, near these points of the mask,
// each turned by another 15 degrees.
void AddMarkers(Scene& scene, const std::array<Vec3d, 7>& places) {
  for (int i = 0; i < 6; ++i) {
    scene.markers.push_back(
        {fmt::format("marker-{}", i + 1), i + 1, "mask", places[static_cast<size_t>(i)], 15.0 * i});
  }
  scene.markers.push_back({"standard", 0, "mask", places[6]});
}

// At `distance_mm` from the origin, at a polar angle from +z and an azimuth from +x.
Vec3d OnRig(double distance_mm, double polar_deg, double azimuth_deg) {
  const double polar = RadFromDeg(polar_deg), azimuth = RadFromDeg(azimuth_deg);
  return distance_mm * Vec3d(std::sin(polar) * std::cos(azimuth),
                             std::sin(polar) * std::sin(azimuth), std::cos(polar));
}

}  // namespace

Scene OvalScene() {
  Scene scene = MaskScene("oval", "mask");
  scene.cameras.push_back(ThesisCamera("camera", {1600, 0, 0}, Vec3d::UnitZ()));
  // Spread over the side that the camera sees.
  AddMarkers(scene, {Vec3d(90, -45, -55), Vec3d(90, 0, -55), Vec3d(90, 45, -55), Vec3d(90, -45, 55),
                     Vec3d(90, 0, 55), Vec3d(90, 45, 55), Vec3d(100, 0, 0)});
  return scene;
}

Scene SphereScene() {
  Scene scene = MaskScene("sphere", "sphere");
  scene.cameras.push_back(ThesisCamera("camera", {1600, 0, 0}, Vec3d::UnitZ()));
  return scene;
}

// Cameras at 2 m, because from 1600 mm the face is as high as the picture.
Scene FaceScene() {
  constexpr double kDistance_mm = 2000.0;
  Scene scene = MaskScene("face", "mask");
  scene.up_axis = UpAxis::kZ;
  scene.cameras.push_back(ThesisCamera("front", {kDistance_mm, 0, 0}, Vec3d::UnitZ()));
  scene.cameras.push_back(ThesisCamera("oblique", OnRig(kDistance_mm, 55, 45), Vec3d::UnitZ()));
  scene.cameras.push_back(ThesisCamera("side", OnRig(kDistance_mm, 90, 90), Vec3d::UnitZ()));
  // Forehead, temples, cheeks, chin, bridge of the nose.
  AddMarkers(scene, {Vec3d(100, -30, 65), Vec3d(100, 30, 65), Vec3d(80, -60, 30), Vec3d(80, 60, 30),
                     Vec3d(90, -45, -30), Vec3d(90, 45, -30), Vec3d(110, 0, -85)});
  return scene;
}

// From above, the feet to the right of the picture; 2.4 m away, so that all of it is in the
// picture.
Scene BodyScene() {
  Scene scene = MaskScene("body", "mask");
  scene.up_axis = UpAxis::kZ;
  scene.cameras.push_back(ThesisCamera("above", {0, 0, 2400}, Vec3d::UnitY()));
  scene.cameras.push_back(ThesisCamera("oblique", OnRig(2400, 50, -90), Vec3d::UnitZ()));
  AddMarkers(scene,
             {Vec3d(-150, -70, 100), Vec3d(-150, 70, 100), Vec3d(-20, -80, 100),
              Vec3d(-20, 80, 100), Vec3d(130, -90, 90), Vec3d(130, 90, 90), Vec3d(30, 0, 100)});
  return scene;
}

}  // namespace retrolux
