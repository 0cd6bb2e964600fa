#include "analysis/dataset_room.h"

#include <algorithm>
#include <cmath>

#include "scenes/built_in.h"
#include "scenes/mesh_shapes.h"
#include "scenes/scene_parts.h"
#include "scenes/vault.h"

namespace retrolux {

namespace {

using Json = nlohmann::json;

// The couch under masks that have no room, or the backrest behind them: as in the CT room.
constexpr double kCouchTop_mm = -105.0;
const Vec3d kCouchMin_mm(kCouchTop_mm - 50.0, -210.0, -300.0);
const Vec3d kCouchMax_mm(kCouchTop_mm, 210.0, 400.0);

// Where there is no room, its light comes from everywhere: about the radiance that a mask in the CT
// room sends back of its luminaires' light.
constexpr double kEnvironment_w_m2_sr = 0.3;

// Of the free cameras: the pixels of the thesis's.
constexpr int kWidth_px = 640, kHeight_px = 480;
constexpr double kPitch_mm = 0.01;

Mat3d Turned(const Vec3d& deg) {
  const auto about = [](double angle_deg, const Vec3d& axis) -> Mat3d {
    return Eigen::AngleAxisd(RadFromDeg(angle_deg), axis).toRotationMatrix();
  };
  return about(deg.z(), Vec3d::UnitZ()) * about(-deg.y(), Vec3d::UnitY()) *
         about(deg.x(), Vec3d::UnitX());
}

Vec3d DrawAxes(const std::array<Range, 3>& axes, const SceneDraw& draw, const std::string& name) {
  return {axes[0].Draw(draw, name + " x"), axes[1].Draw(draw, name + " y"),
          axes[2].Draw(draw, name + " z")};
}

void AddCouch(Scene& scene, const RigidTransform& world_from_mask) {
  AddObject(scene, kCouchObject, BoxMesh(kCouchMin_mm, kCouchMax_mm), "couch_carbon");
  scene.objects.back().world_from_object = world_from_mask;
}

Scene CtRoomWith(const DatasetMask& mask, const RigidTransform& world_from_mask) {
  Scene scene = CtRoom();
  for (SceneObject& object : scene.objects) {
    if (object.moves_with_pose) object.world_from_object.translation = world_from_mask.translation;
  }
  SceneObject& object = ObjectOf(scene, kMaskObject);
  object.mesh = mask.mesh;
  object.world_from_object = world_from_mask;
  return scene;
}

// The nozzles stand where the scenario's own face lets them, whatever the mask.
Scene VaultWith(const DatasetMask& mask, const RigidTransform& world_from_mask, const Vec3d& deg) {
  Scene scene = VaultScene(LoadScenario("1a"), {60.0, 31.67, 70.52}, "face",
                           {deg.x(), deg.y(), deg.z(), world_from_mask.rotation});
  SceneObject& object = ObjectOf(scene, kMaskObject);
  object.mesh = mask.mesh;
  object.world_from_object = world_from_mask;
  AddCouch(scene, world_from_mask);
  return scene;
}

// On a sphere around the mask's middle, looking near it.
CameraSpec FreeCamera(const ViewChoice& view, const Vec3d& middle, const Mat3d& world_from_mask,
                      const SceneDraw& draw, const std::string& name) {
  const double polar = RadFromDeg(view.incidence_deg.Draw(draw, name + " incidence"));
  const double azimuth = 2.0 * kPi * draw.Uniform(name + " azimuth");
  const Vec3d direction =
      world_from_mask * Vec3d(std::cos(polar), std::sin(polar) * std::cos(azimuth),
                              std::sin(polar) * std::sin(azimuth));
  const Vec3d eye = middle + view.distance_mm.Draw(draw, name + " distance") * direction;
  const double roll = RadFromDeg(view.roll_deg.Draw(draw, name + " roll"));
  const Vec3d across = std::abs(direction.z()) < 0.9 ? Vec3d::UnitZ() : Vec3d::UnitX();
  const Vec3d up = Eigen::AngleAxisd(roll, direction) * across.cross(direction).normalized();
  const double aim = view.aim_mm.Draw(draw, name + " aim");
  const double aim_angle = 2.0 * kPi * draw.Uniform(name + " aim angle");
  const Vec3d side = up.cross(direction);
  const Vec3d target = middle + aim * (std::cos(aim_angle) * up + std::sin(aim_angle) * side);

  const double half = RadFromDeg(0.5 * view.field_of_view_deg.Draw(draw, name + " field of view"));
  const double vertical_deg = 2.0 * DegFromRad(std::atan(std::tan(half) * kHeight_px / kWidth_px));
  CameraSpec camera;
  camera.model = CameraModel::FromFieldOfView(name, kWidth_px, kHeight_px, 2.0 * DegFromRad(half),
                                              vertical_deg, LookAt(eye, target, up));
  camera.lens.focal_length_mm = camera.model.fx * kPitch_mm;
  camera.filter = DichroicFilter{};
  camera.ring = DiodeRing{};
  return camera;
}

Scene FreeView(const ViewChoice& view, const DatasetMask& mask,
               const RigidTransform& world_from_mask, const SceneDraw& draw) {
  Scene scene;
  AddObject(scene, kMaskObject, mask.mesh, "mask");
  scene.objects.back().world_from_object = world_from_mask;
  AddCouch(scene, world_from_mask);
  scene.ambient.environment_w_m2_sr = kEnvironment_w_m2_sr;
  for (int i = 0; i < view.cameras; ++i) {
    scene.cameras.push_back(FreeCamera(view, world_from_mask * mask.middle,
                                       world_from_mask.rotation, draw,
                                       fmt::format("camera-{}", i + 1)));
  }
  return scene;
}

// `count` of the scene's cameras (0: all), in the scene's order.
std::vector<std::string> ChooseCameras(const Scene& scene, int count, const SceneDraw& draw) {
  std::vector<std::pair<double, size_t>> order;
  for (size_t i = 0; i < scene.cameras.size(); ++i)
    order.emplace_back(draw.Uniform("records " + scene.cameras[i].model.name), i);
  std::sort(order.begin(), order.end());
  if (count > 0) order.resize(std::min(order.size(), static_cast<size_t>(count)));
  std::vector<size_t> chosen;
  for (const auto& entry : order) chosen.push_back(entry.second);
  std::sort(chosen.begin(), chosen.end());
  std::vector<std::string> names;
  for (const size_t i : chosen) names.push_back(scene.cameras[i].model.name);
  return names;
}

}  // namespace

DrawnScene DrawRoom(const ViewChoice& view, const DatasetMask& mask, const SceneDraw& draw) {
  const Vec3d deg = DrawAxes(view.pose.rotation_deg, draw, "rotation");
  const Vec3d shift = DrawAxes(view.pose.translation_mm, draw, "translation");
  const RigidTransform world_from_mask{Turned(deg), shift};
  DrawnScene drawn;
  switch (view.kind) {
    case ViewKind::kCtRoom:
      drawn.scene = CtRoomWith(mask, world_from_mask);
      break;
    case ViewKind::kVault:
      drawn.scene = VaultWith(mask, world_from_mask, deg);
      break;
    case ViewKind::kFree:
      drawn.scene = FreeView(view, mask, world_from_mask, draw);
      break;
  }
  drawn.scene.poses.clear();
  drawn.cameras = ChooseCameras(drawn.scene, view.cameras, draw);
  drawn.nuisances = {{"view", ViewKindName(view.kind)},
                     {"mask", mask.name},
                     {"translation_mm", {shift.x(), shift.y(), shift.z()}},
                     {"rotation_deg", {deg.x(), deg.y(), deg.z()}},
                     {"cameras", drawn.cameras.size()}};
  return drawn;
}

}  // namespace retrolux
