// Scenes for measuring cameras: a chessboard and an even field.
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

}  // namespace retrolux
