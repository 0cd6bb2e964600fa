// Scenes for measuring: a chessboard and an even field for cameras, a goniometer for sheeting.
#include <cmath>

#include "scenes/built_in.h"
#include "scenes/mesh_shapes.h"
#include "scenes/scene_parts.h"

namespace retrolux {

// 10 x 7 squares of 30 mm in a margin a square wide, in the plane z = 0 with the middle at the
// origin, lit from behind: what is not black emits, so that pictures are free of noise. A wide
// camera with distortion, as calibration likes it.
Scene ChessboardScene() {
  constexpr int kColumns = 10, kRows = 7;
  constexpr double kSquare_mm = 30.0;
  Scene scene;
  scene.name = "chessboard";
  scene.up_axis = UpAxis::kZ;
  const Vec3d edge_u(kSquare_mm, 0, 0), edge_v(0, kSquare_mm, 0);
  TriangleMesh black;
  for (int row = -1; row <= kRows; ++row) {
    for (int column = -1; column <= kColumns; ++column) {
      const Vec3d corner((column - 0.5 * kColumns) * kSquare_mm, (row - 0.5 * kRows) * kSquare_mm,
                         0);
      const bool margin = row < 0 || column < 0 || row == kRows || column == kColumns;
      if (!margin && (row + column) % 2 == 0) {
        black.Append(RectangleMesh(corner, edge_u, edge_v));
      } else {
        scene.ambient.panels.push_back({corner, edge_u, edge_v});
      }
    }
  }
  AddObject(scene, "black", black, "black");
  CameraSpec camera = ThesisCamera("camera", {0, 0, 520}, Vec3d::UnitY());
  camera.model.fx = camera.model.fy = 800.0;
  camera.model.distortion = {-0.2, 0.06, 0.0, 0.0, 0.0};
  camera.ring.reset();
  camera.filter.reset();
  scene.cameras.push_back(camera);
  scene.ambient.radiance_w_m2_sr = 1.0;
  scene.exposure.time_s = 7e-4;
  scene.UseMaterial(scene.exposure.marker_material);
  return scene;
}

// An even wall of radiance 1 W/(m2 sr) that fills the picture of the thesis's camera.
Scene FlatFieldScene() {
  Scene scene;
  scene.name = "flat-field";
  AddObject(scene, "wall", RectangleMesh({-1000, -1000, 0}, {2000, 0, 0}, {0, 2000, 0}), "black");
  scene.cameras.push_back(ThesisCamera("camera", {0, 0, 1600}, Vec3d::UnitX()));
  scene.cameras.back().ring.reset();
  scene.ambient.radiance_w_m2_sr = 1.0;
  scene.ambient.panels.push_back({{-500, -500, 10}, {1000, 0, 0}, {0, 1000, 0}});
  scene.exposure.time_s = 1e-3;
  scene.UseMaterial(scene.exposure.marker_material);
  return scene;
}

// ASTM E810 at 15 m: a square of sheeting of 200 mm at an entrance angle of 5 degrees, a lamp
// whose aperture is a tenth of a degree wide, and receivers at four observation angles in the plane
// of lamp and normal. R_A = radiance cos(nu) d^2 / I with d = 15 m, I = 50 W/sr and nu the angle
// between the receiver and the normal (5 degrees less the observation angle); 0.005 % lower for the
// lamp's width.
Scene GoniometerScene() {
  constexpr double kDistance_mm = 15000.0, kEntrance_deg = 5.0;
  const auto at = [](double deg) {
    return Vec3d(kDistance_mm * std::cos(RadFromDeg(deg)), kDistance_mm * std::sin(RadFromDeg(deg)),
                 0);
  };
  Scene scene;
  scene.name = "goniometer";
  scene.up_axis = UpAxis::kZ;
  AddObject(scene, "sheet", RectangleMesh({0, -100, -100}, {0, 200, 0}, {0, 0, 200}), "retro_bead");
  scene.objects[0].world_from_object.rotation =
      Eigen::AngleAxisd(RadFromDeg(kEntrance_deg), Vec3d::UnitZ()).toRotationMatrix();
  CameraSpec lamp = ThesisCamera("lamp", at(0.0), Vec3d::UnitZ());
  lamp.ring = DiodeRing{};
  lamp.ring->count = 1;
  lamp.ring->radius_mm = 0.0;
  lamp.ring->led_radius_mm = 0.5 * kDistance_mm * RadFromDeg(0.1);
  lamp.ring->radiant_intensity_w_sr = 50.0;
  for (const double observation_deg : {0.2, 0.33, 1.0, 1.5}) {
    CameraSpec receiver = ThesisCamera(fmt::format("receiver-{:.2f}", observation_deg),
                                       at(observation_deg), Vec3d::UnitZ());
    receiver.model.fx = receiver.model.fy = 20000.0;
    receiver.ring.reset();
    scene.cameras.push_back(receiver);
  }
  scene.cameras.push_back(lamp);
  scene.exposure.time_s = 1e-3;
  return scene;
}

}  // namespace retrolux
