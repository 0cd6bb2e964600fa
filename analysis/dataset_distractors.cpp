#include "analysis/dataset_distractors.h"

#include <algorithm>
#include <cmath>

#include "analysis/dataset_cable.h"
#include "scenes/mesh_shapes.h"
#include "scenes/scene_parts.h"

namespace retrolux {

namespace {

using Json = nlohmann::json;

constexpr Range kGlintRoughness{0.05, 0.25, true};
constexpr double kGlintReflectance = 0.87;  // of aluminium near 850 nm
// Where on the couch: beside the mask, seen from above, by its middle.
constexpr Range kBeside_mm{80.0, 190.0, false};
constexpr Range kAlong_mm{-150.0, 150.0, false};
constexpr double kCouchTop_mm = -105.0;
constexpr double kPatchTilt_deg = 3.0;

constexpr Range kPlateBefore_mm{25.0, 80.0, false};
constexpr double kPlateLength_mm = 70.0, kPlateWidth_mm = 45.0;

void UseMaterial(Scene& scene, const std::string& name, const Json& spec) {
  scene.materials[name] = ReadMaterial(name, JsonReader::FromText(spec.dump(), name));
}

Vec3d OnCouch(const SceneDraw& draw, const std::string& name) {
  const double side = draw.Chance(name + " side", 0.5) ? 1.0 : -1.0;
  return {kCouchTop_mm, side * kBeside_mm.Draw(draw, name + " beside"),
          kAlong_mm.Draw(draw, name + " along")};
}

void AddOnCouch(Scene& scene, const std::string& name, TriangleMesh mesh,
                const std::string& material) {
  const RigidTransform world_from_couch = scene.Object(kCouchObject).world_from_object;
  AddObject(scene, name, std::move(mesh), material);
  scene.objects.back().world_from_object = world_from_couch;
}

// A rectangle about `middle`, facing `normal`.
TriangleMesh Patch(const Vec3d& middle, const Vec3d& normal, double width, double length,
                   double turn_rad) {
  const Vec3d across = std::abs(normal.z()) < 0.9 ? Vec3d::UnitZ() : Vec3d::UnitY();
  const Vec3d u0 = across.cross(normal).normalized(), v0 = normal.cross(u0);
  const Vec3d u = std::cos(turn_rad) * u0 + std::sin(turn_rad) * v0;
  const Vec3d v = normal.cross(u);
  return RectangleMesh(middle - 0.5 * (width * u + length * v), width * u, length * v);
}

// Half of them domes, which show any light as a spot; half flat, which show one camera its own
// ring.
void AddGlint(const DistractorRange& range, const SceneDraw& draw, const std::string& name,
              DrawnScene& drawn) {
  Scene& scene = drawn.scene;
  UseMaterial(scene, name,
              {{"type", "conductor"},
               {"reflectance", kGlintReflectance},
               {"roughness", kGlintRoughness.Draw(draw, name + " roughness")}});
  const double size = range.glint_size_mm.Draw(draw, name + " size");
  const Vec3d place = OnCouch(draw, name);
  if (draw.Chance(name + " dome", 0.5)) {
    TriangleMesh dome = EllipsoidMesh({0.25 * size, 0.5 * size, 0.5 * size}, 3);
    for (Vec3f& p : dome.positions) p += place.cast<float>();
    AddOnCouch(scene, name, std::move(dome), name);
    return;
  }
  const auto which = static_cast<size_t>(draw.Uniform(name + " camera") *
                                         static_cast<double>(drawn.cameras.size()));
  const RigidTransform& world_from_couch = scene.Object(kCouchObject).world_from_object;
  const Vec3d eye = world_from_couch.Inverse() * scene.Camera(drawn.cameras[which]).model.Centre();
  const Vec3d middle = place + Vec3d(0.5 * size + 1.0, 0, 0);
  const double tilt = RadFromDeg(kPatchTilt_deg) * draw.Uniform(name + " tilt");
  const Vec3d towards = (eye - middle).normalized();
  const Vec3d about = towards.cross(Vec3d::UnitY()).normalized();
  const double turn = 2.0 * kPi * draw.Uniform(name + " turn");
  AddOnCouch(scene, name,
             Patch(middle, Eigen::AngleAxisd(tilt, about) * towards, size,
                   size * (0.3 + 0.7 * draw.Uniform(name + " shape")), turn),
             name);
}

void AddStrip(const DistractorRange& range, const SceneDraw& draw, Scene& scene) {
  const Vec3d middle = OnCouch(draw, "strip") + Vec3d(1.0, 0, 0);
  AddOnCouch(scene, "strip",
             Patch(middle, Vec3d::UnitX(), range.strip_width_mm.Draw(draw, "strip width"),
                   range.strip_length_mm.Draw(draw, "strip length"),
                   2.0 * kPi * draw.Uniform("strip turn")),
             scene.exposure.marker_material);
}

// At the same distance as the first camera, turned about the mask's middle; it gives light, and no
// picture.
void AddSecondRing(double separation_deg, const SceneDraw& draw, const Vec3d& middle,
                   DrawnScene& drawn) {
  CameraSpec neighbour = drawn.scene.Camera(drawn.cameras.front());
  const Vec3d eye = neighbour.model.Centre() - middle;
  const double turn = 2.0 * kPi * draw.Uniform("second ring around");
  const Vec3d up = -neighbour.model.camera_from_world.rotation.row(1).transpose();
  const Vec3d about = Eigen::AngleAxisd(turn, eye.normalized()) * up;
  const Vec3d moved = Eigen::AngleAxisd(RadFromDeg(separation_deg), about) * eye;
  neighbour.model.name = "neighbour";
  neighbour.model.camera_from_world = LookAt(middle + moved, middle, about);
  drawn.scene.cameras.push_back(neighbour);
  drawn.rings = RingChoice::kAll;
}

// Before one of the markers, as a camera sees it.
void AddPlate(double offset_mm, const SceneDraw& draw, DrawnScene& drawn) {
  Scene& scene = drawn.scene;
  const auto pick = [&](const std::string& name, size_t count) {
    return static_cast<size_t>(draw.Uniform(name) * static_cast<double>(count));
  };
  const MarkerSpec& marker = scene.markers[pick("plate marker", scene.markers.size())];
  const CameraModel& camera =
      scene.Camera(drawn.cameras[pick("plate camera", drawn.cameras.size())]).model;
  const RigidTransform& world_from_mask = scene.Object(kMaskObject).world_from_object;
  const Vec3d centre = world_from_mask * marker.at;
  const Vec3d towards = (camera.Centre() - centre).normalized();
  const Vec3d middle = centre + kPlateBefore_mm.Draw(draw, "plate before") * towards;
  const double angle = 2.0 * kPi * draw.Uniform("plate angle");
  const Vec3d right = camera.camera_from_world.rotation.row(0).transpose();
  const Vec3d edge =
      Eigen::AngleAxisd(angle, towards) * (right - right.dot(towards) * towards).normalized();
  const Vec3d away = towards.cross(edge);
  const char* materials[] = {"gantry_plastic", "black", "aluminium"};
  AddObject(scene, "plate",
            RectangleMesh(middle + offset_mm * away - 0.5 * kPlateLength_mm * edge,
                          kPlateLength_mm * edge, kPlateWidth_mm * away),
            materials[pick("plate material", std::size(materials))]);
}

}  // namespace

void DrawDistractors(const DistractorRange& range, const DatasetMask& mask, const SceneDraw& draw,
                     DrawnScene& drawn) {
  Scene& scene = drawn.scene;
  Json& nuisances = drawn.nuisances;
  const int glints =
      draw.Chance("glints", range.glints) ? range.glint_count.Draw(draw, "glint count") : 0;
  for (int i = 0; i < glints; ++i) AddGlint(range, draw, fmt::format("glint-{}", i + 1), drawn);

  const bool strip = draw.Chance("strip", range.strip);
  if (strip) AddStrip(range, draw, scene);

  const int cables =
      draw.Chance("cables", range.cables) ? range.cable_count.Draw(draw, "cable count") : 0;
  for (int i = 0; i < cables; ++i) {
    const std::string name = fmt::format("cable-{}", i + 1);
    const bool bright = draw.Chance(name + " bright", 0.5);
    UseMaterial(scene, name,
                {{"type", "coated_diffuse"},
                 {"reflectance", bright ? 0.7 : 0.04},
                 {"ior", 1.5},
                 {"roughness", 0.25}});
    const double radius = range.cable_radius_mm.Draw(draw, name + " radius");
    AddObject(scene, name, CableOver(mask, radius, draw, name), name);
    scene.objects.back().world_from_object = scene.Object(kMaskObject).world_from_object;
  }

  const bool second_ring = draw.Chance("second ring", range.second_ring);
  const double separation_deg = range.second_ring_deg.Draw(draw, "second ring separation");
  if (second_ring) {
    const RigidTransform& world_from_mask = scene.Object(kMaskObject).world_from_object;
    AddSecondRing(separation_deg, draw, world_from_mask * mask.middle, drawn);
  }

  const bool plate = draw.Chance("plate", range.plate) && !scene.markers.empty();
  const double offset_mm = range.plate_offset_mm.Draw(draw, "plate offset");
  if (plate) AddPlate(offset_mm, draw, drawn);

  nuisances.update({{"glints", glints},
                    {"strip", strip},
                    {"cables", cables},
                    {"second_ring_deg", second_ring ? Json(separation_deg) : Json()},
                    {"plate_offset_mm", plate ? Json(offset_mm) : Json()}});
}

}  // namespace retrolux
