// The CT scanner room of the thesis (section 3.2): x up, z to the front, origin at the scan point.
// Camera positions, field of view, oval and poses are the thesis's (table 3.1, sections 3.2
// to 3.4); everything that its lost figures held (gantry, couch, room) is an assumption, listed in
// docs/assumptions.md.
#include "scenes/built_in.h"
#include "scenes/masks.h"
#include "scenes/mesh_shapes.h"
#include "scenes/scene_parts.h"

namespace retrolux {

namespace {

// A conventional CT of about 2003: 700 mm bore, 800 mm deep. The flares are as wide as the front
// cameras need: their lines of sight to the scan point leave a 350 mm bore at z = 277 to 307 mm.
constexpr double kBoreRadius = 350.0;
constexpr double kBoreHalfLength = 120.0;
constexpr double kFrontFlareRadius = 620.0;
constexpr double kBackFlareRadius = 450.0;
constexpr double kGantryHalfDepth = 400.0;
constexpr double kGantryHalfWidth = 1000.0;
constexpr double kGantryTop = 900.0;
constexpr int kGantrySegments = 128;

// Room 5 x 6 x 2.7 m, scan point 1 m above the floor.
constexpr double kFloor = -1000.0;
constexpr double kCeiling = 1700.0;
constexpr double kHalfWidth = 2500.0;
constexpr double kHalfLength = 3000.0;

// Couch board under the oval; it comes from the front and moves with the patient.
constexpr double kCouchTop = -105.0;
constexpr double kCouchThickness = 50.0;
constexpr double kCouchHalfWidth = 210.0;
constexpr double kCouchHeadEnd = -160.0;
constexpr double kCouchLength = 2000.0;

// Four ceiling luminaires of 1200 x 300 mm; 8 W/(m2 sr) is about 2700 cd/m2 at 340 lm/W, as office
// lighting.
constexpr double kLuminaireRadiance = 8.0;

struct CameraPlace {
  const char* name;
  Vec3d eye;
};
const CameraPlace kCameras[] = {
    {"front-middle", {1265, 0, 1109}},   {"front-left", {1265, 600, 1109}},
    {"front-right", {1265, -600, 1109}}, {"back-middle", {680, 0, -1441}},
    {"back-left", {680, 300, -1441}},    {"back-right", {680, -300, -1441}},
};

TriangleMesh GantryBody() {
  const Vec2d lo(kFloor, -kGantryHalfWidth), hi(kGantryTop, kGantryHalfWidth);
  const double depth = 2.0 * kGantryHalfDepth;
  TriangleMesh body =
      PlateWithHoleMesh(lo, hi, kGantryHalfDepth, kFrontFlareRadius, kGantrySegments, true);
  body.Append(
      PlateWithHoleMesh(lo, hi, -kGantryHalfDepth, kBackFlareRadius, kGantrySegments, false));
  const Vec3d width(0, hi.y() - lo.y(), 0), height(hi.x() - lo.x(), 0, 0), z(0, 0, depth);
  const Vec3d corner(lo.x(), lo.y(), -kGantryHalfDepth);
  body.Append(RectangleMesh(corner + height, width, z));  // top
  body.Append(RectangleMesh(corner, height, z));          // side at -y
  body.Append(RectangleMesh(corner + width, z, height));  // side at +y
  return body;
}

void AddRoom(Scene& scene) {
  const Vec3d lo(kFloor, -kHalfWidth, -kHalfLength), hi(kCeiling, kHalfWidth, kHalfLength);
  const Vec3d x(hi.x() - lo.x(), 0, 0), y(0, hi.y() - lo.y(), 0), z(0, 0, hi.z() - lo.z());
  AddObject(scene, "floor", RectangleMesh(lo, y, z), "floor");
  AddObject(scene, "ceiling", RectangleMesh(lo + x, z, y), "white_paint");
  TriangleMesh walls = RectangleMesh(lo, z, x);
  walls.Append(RectangleMesh(lo + y, x, z));
  walls.Append(RectangleMesh(lo, x, y));
  walls.Append(RectangleMesh(lo + z, y, x));
  AddObject(scene, "walls", std::move(walls), "white_paint");
  for (const double lamp_y : {-1200.0, 1200.0}) {
    for (const double lamp_z : {-1800.0, 1800.0}) {
      scene.ambient.panels.push_back(
          {{kCeiling - 5.0, lamp_y - 150.0, lamp_z - 600.0}, {0, 0, 1200}, {0, 300, 0}});
    }
  }
  scene.ambient.radiance_w_m2_sr = kLuminaireRadiance;
}

void AddScanner(Scene& scene) {
  AddObject(scene, "bore",
            BoreMesh({{kBackFlareRadius, -kGantryHalfDepth},
                      {kBoreRadius, -kBoreHalfLength},
                      {kBoreRadius, kBoreHalfLength},
                      {kFrontFlareRadius, kGantryHalfDepth}},
                     kGantrySegments),
            "gantry_plastic");
  AddObject(scene, "gantry", GantryBody(), "gantry_plastic");
  AddObject(scene, "couch",
            BoxMesh({kCouchTop - kCouchThickness, -kCouchHalfWidth, kCouchHeadEnd},
                    {kCouchTop, kCouchHalfWidth, kCouchHeadEnd + kCouchLength}),
            "couch_carbon", true);
}

// The body of a camera behind its lens; the ring of diodes lies in front of it.
SceneObject Housing(const CameraModel& camera) {
  SceneObject housing;
  housing.name = "housing-" + camera.name;
  housing.mesh = BoxMesh({-40, -40, -160}, {40, 40, -10});
  housing.world_from_object = camera.camera_from_world.Inverse();
  housing.material = "black";
  return housing;
}

}  // namespace

Scene CtRoom() {
  Scene scene;
  scene.name = "ct-room";
  AddObject(scene, "mask", MakeMask("oval"), "mask", true);
  AddScanner(scene);
  AddRoom(scene);
  scene.UseMaterial("black");
  for (const CameraPlace& place : kCameras) {
    scene.cameras.push_back(ThesisCamera(place.name, place.eye, Vec3d::UnitX()));
    scene.objects.push_back(Housing(scene.cameras.back().model));
  }
  scene.UseMaterial("retro_bead");
  scene.poses = {{"reference", {0, 0, 0}}, {"start", {0, 0, 140}}, {"end", {0, 0, -140}}};
  return scene;
}

}  // namespace retrolux
