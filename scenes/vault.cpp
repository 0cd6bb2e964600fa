// The room around cameras, mask and nozzles is an assumption; nothing of it is in the thesis.
#include "scenes/vault.h"

#include <algorithm>

#include "scenes/built_in.h"
#include "scenes/mask_mesh.h"
#include "scenes/mesh_shapes.h"
#include "scenes/nozzle.h"
#include "scenes/scene_parts.h"

namespace retrolux {

namespace {

constexpr int kNozzleSegments = 128;

// Walls at least this far from the isocentre on the sides without a nozzle.
constexpr double kHalfWidth_mm = 3000.0;
// What a camera and its support need between the lens and a wall or the ceiling.
constexpr double kBehindCamera_mm = 450.0;

// As in the CT room: four ceiling luminaires of 1200 x 300 mm.
constexpr double kLuminaireRadiance_w_m2_sr = 8.0;

struct RoomBox {
  Vec3d lo, hi;
};

// The beam lines come through the wall at +x and the ceiling, as near as the cameras let them.
RoomBox RoomAround(const Scenario& scenario, const std::vector<Vec3d>& cameras) {
  double radius = 0.0, height = 0.0;
  for (const Vec3d& centre : cameras) {
    radius = std::max(radius, centre.head<2>().norm());
    height = std::max(height, centre.z());
  }
  const double front = radius + kBehindCamera_mm;
  const double half = std::max(kHalfWidth_mm, front);
  return {{-half, -half, -scenario.isocentre_height_mm}, {front, half, height + kBehindCamera_mm}};
}

void AddRoom(Scene& scene, const RoomBox& room) {
  const Vec3d size = room.hi - room.lo;
  const Vec3d x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
  AddObject(scene, "floor", RectangleMesh(room.lo, x, y), "floor");
  AddObject(scene, "ceiling", RectangleMesh(room.lo + z, y, x), "white_paint");
  TriangleMesh walls = RectangleMesh(room.lo, y, z);
  walls.Append(RectangleMesh(room.lo + x, z, y));
  walls.Append(RectangleMesh(room.lo, z, x));
  walls.Append(RectangleMesh(room.lo + y, x, z));
  AddObject(scene, "walls", std::move(walls), "white_paint");
  for (const double lamp_x : {-2000.0, 0.0}) {
    for (const double lamp_y : {-1500.0, 1500.0}) {
      scene.ambient.panels.push_back(
          {{lamp_x - 600.0, lamp_y - 150.0, room.hi.z() - 5.0}, {0, 300, 0}, {1200, 0, 0}});
    }
  }
  scene.ambient.radiance_w_m2_sr = kLuminaireRadiance_w_m2_sr;
}

void AddMask(Scene& scene, TriangleMesh mesh, const MaskRotation& rotation) {
  AddObject(scene, "mask", std::move(mesh), "mask");
  scene.objects.back().world_from_object = {rotation.world_from_mask, Vec3d::Zero()};
}

std::vector<Vec3d> PointsInWorld(const TriangleMesh& mesh, const MaskRotation& rotation) {
  std::vector<Vec3d> points;
  for (const Vec3f& position : mesh.positions)
    points.push_back(rotation.world_from_mask * position.cast<double>());
  return points;
}

void AddNozzles(Scene& scene, const Scenario& scenario, const std::vector<Vec3d>& mask_points) {
  for (const Beam& beam : scenario.beams) {
    const PlacedNozzle nozzle = PlaceNozzle(scenario.nozzle, beam, mask_points);
    AddObject(scene, "snout-" + beam.name, TruncatedConeMesh(nozzle.snout, kNozzleSegments),
              "gantry_plastic");
    AddObject(scene, "nozzle-" + beam.name, TruncatedConeMesh(nozzle.cylinder, kNozzleSegments),
              "gantry_plastic");
  }
}

void AddCameras(Scene& scene, const Scenario& scenario, const std::vector<Vec3d>& centres) {
  for (size_t i = 0; i < centres.size(); ++i) {
    CameraSpec camera;
    camera.model = VaultCamera(scenario, fmt::format("camera-{}", i + 1), centres[i]);
    camera.filter = DichroicFilter{};
    camera.ring = DiodeRing{};
    scene.cameras.push_back(camera);
  }
}

}  // namespace

Scene VaultScene(const Scenario& scenario, const Placement& placement, const std::string& mask_name,
                 const MaskRotation& rotation) {
  Scene scene;
  scene.name = "vault";
  scene.up_axis = UpAxis::kZ;
  TriangleMesh mesh = MaskMesh(scenario.Mask(mask_name), scenario.file);
  const std::vector<Vec3d> mask_points = PointsInWorld(mesh, rotation);
  const std::vector<Vec3d> centres = CameraCentres(scenario, placement);
  AddMask(scene, std::move(mesh), rotation);
  AddNozzles(scene, scenario, mask_points);
  AddRoom(scene, RoomAround(scenario, centres));
  AddCameras(scene, scenario, centres);
  scene.UseMaterial("retro_bead");  // what the exposure is set for
  scene.exposure.distance_mm = scenario.rigs.distance_mm;
  return scene;
}

// What the thesis chose to build (section 4.10), its patient upright towards the horizontal beam,
// with the markers of the scene `face`.
Scene VaultRoom() {
  Scene scene = VaultScene(LoadScenario("1a"), {60.0, 31.67, 70.52}, "face", {});
  scene.markers = FaceScene().markers;
  return scene;
}

}  // namespace retrolux
