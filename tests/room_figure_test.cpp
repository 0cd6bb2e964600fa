// The room that reports draw.
#include "analysis/room_figure.h"

#include <gtest/gtest.h>

#include "scenes/built_in.h"
#include "scenes/scene_parts.h"

namespace retrolux {
namespace {

double SeenArea_mm2(const Scene& scene, const TriangleNumbers& seen, const std::string& name) {
  const TriangleMesh& mesh = scene.Object(name).mesh;
  double area = 0.0;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    const Vec3f u = mesh.positions[t[1]] - mesh.positions[t[0]];
    const Vec3f v = mesh.positions[t[2]] - mesh.positions[t[0]];
    if (seen.numbers[i] > 0) area += 0.5 * static_cast<double>(u.cross(v).norm());
  }
  return area;
}

// From a distance d a sphere of radius R shows a cap of height R - R^2 / d: 2 pi R^2 (1 - R / d).
// Whole triangles count, so that the rim is ragged by a triangle; its share of the rim's band falls
// on both sides.
TEST(CamerasThatSee, CapOfASphere) {
  Scene scene = SphereScene();
  scene.cameras = {ThesisCamera("camera", {1600, 0, 0}, Vec3d::UnitZ())};
  scene.objects.resize(1);
  const SceneObject& sphere = scene.objects.front();
  double radius = 0.0;
  for (const Vec3f& p : sphere.mesh.positions)
    radius = std::max(radius, static_cast<double>(p.norm()));
  const TriangleNumbers seen = CamerasThatSee(scene, sphere.name);
  EXPECT_EQ(seen.most, 1);
  const double cap = 2.0 * kPi * radius * radius * (1.0 - radius / 1600.0);
  EXPECT_NEAR(SeenArea_mm2(scene, seen, sphere.name) / cap, 1.0, 0.01);
}

// The couch and the mask move with the pose, the rest stands: drawn once, as the cameras.
TEST(DrawRoom, WhatStandsIsDrawnOnce) {
  const Scene room = CtRoom();
  std::vector<RoomScene> scenes;
  for (const char* pose : {"reference", "start"}) {
    RoomScene& state = scenes.emplace_back(RoomScene{pose, room.AtPose(std::string(pose)), {}});
    state.numbers = CamerasThatSee(state.scene, "mask");
  }
  const RoomFigure figure = DrawRoom("Pose", scenes);
  size_t moving = 0, walls = 0;
  for (const SceneObject& object : room.objects) {
    moving += object.moves_with_pose ? 1 : 0;
    walls += object.name == "walls" || object.name == "floor" || object.name == "ceiling" ? 1 : 0;
  }
  ASSERT_EQ(walls, 3u);
  ASSERT_EQ(figure.states.size(), 2u);
  const size_t markers = room.markers.empty() ? 0 : 1;
  EXPECT_EQ(figure.states[0].traces.size(), moving + markers);
  EXPECT_EQ(figure.traces.size(), room.objects.size() - moving - walls + 4)
      << "without the walls; four traces of cameras";
  EXPECT_EQ(figure.up, Vec3d::UnitX());
  const nlohmann::json& mask = figure.states[1].traces[0];
  EXPECT_EQ(mask["intensity"].size(), room.Object("mask").mesh.triangles.size());
  EXPECT_EQ(mask["cmax"], 6.5);
}

}  // namespace
}  // namespace retrolux
