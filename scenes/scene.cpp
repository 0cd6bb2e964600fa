#include "scenes/scene.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

namespace retrolux {

double DiodeRing::LambertExponent() const {
  return -std::numbers::ln2 / std::log(std::cos(RadFromDeg(half_angle_deg)));
}

LedType DiodeRing::Led() const {
  return {peak_nm + peak_drift_nm_k * (junction_temperature_c - 25.0), fwhm_nm, spectrum_shape};
}

double DiodeRing::Intensity_w_sr() const {
  return radiant_intensity_w_sr *
         (1.0 + 0.01 * intensity_drift_percent_k * (junction_temperature_c - 25.0));
}

double Lens::PrincipalDistance_mm() const {
  if (focus_distance_mm == 0.0) return focal_length_mm;
  return focus_distance_mm * focal_length_mm / (focus_distance_mm - focal_length_mm);
}

double SensorSpec::DarkCurrentFactor() const {
  return std::exp2((temperature_c - dark_reference_c) / dark_doubling_k);
}

Vec3d LedCentre(const CameraSpec& camera, int index) {
  const double angle = 2.0 * kPi * index / camera.ring->count;
  const Vec3d in_camera(camera.ring->radius_mm * std::cos(angle),
                        camera.ring->radius_mm * std::sin(angle), 0.0);
  return camera.model.camera_from_world.Inverse() * in_camera;
}

std::array<Vec3d, kLedCorners> LedOutline(const CameraSpec& camera, int index) {
  const Mat3d world_from_camera = camera.model.camera_from_world.rotation.transpose();
  const Vec3d centre = LedCentre(camera, index);
  // n/2 r^2 sin(2 pi / n) = pi r_led^2
  const double radius = camera.ring->led_radius_mm *
                        std::sqrt(2.0 * kPi / (kLedCorners * std::sin(2.0 * kPi / kLedCorners)));
  std::array<Vec3d, kLedCorners> corners;
  for (int i = 0; i < kLedCorners; ++i) {
    // The camera's x, y, z (forward) are right-handed: increasing angle is counter-clockwise for
    // who looks back along -z.
    const double angle = 2.0 * kPi * i / kLedCorners;
    corners[static_cast<size_t>(i)] =
        centre + world_from_camera * Vec3d(radius * std::cos(angle), radius * std::sin(angle), 0.0);
  }
  return corners;
}

namespace {

// The element of that name, or an error that lists the names there are.
template <typename T, typename NameOf>
const T& FindNamed(const std::vector<T>& items, const std::string& name, const char* kind,
                   NameOf name_of) {
  std::vector<std::string> names;
  for (const T& item : items) {
    if (name_of(item) == name) return item;
    names.push_back(name_of(item));
  }
  throw InputError(fmt::format("no {} '{}' in the scene; expected one of {}", kind, name,
                               names.empty() ? "(none)" : JoinNames(names)));
}

}  // namespace

const SceneObject& Scene::Object(const std::string& object_name) const {
  return FindNamed(objects, object_name, "object", [](const SceneObject& o) { return o.name; });
}

const CameraSpec& Scene::Camera(const std::string& camera_name) const {
  return FindNamed(cameras, camera_name, "camera",
                   [](const CameraSpec& c) { return c.model.name; });
}

Scene Scene::AtPose(const std::string& pose_name) const {
  return AtPose(FindNamed(poses, pose_name, "pose", [](const Pose& p) { return p.name; }));
}

Scene Scene::AtPose(const Pose& pose) const {
  const Vec3d given = poses.empty() ? Vec3d::Zero() : poses.front().translation;
  Scene moved = *this;
  for (SceneObject& object : moved.objects) {
    if (object.moves_with_pose) object.world_from_object.translation += pose.translation - given;
  }
  moved.poses = {pose};
  return moved;
}

void Scene::UseMaterial(const std::string& material_name) {
  if (!materials.contains(material_name)) materials[material_name] = LibraryMaterial(material_name);
}

namespace {

// Throws if a name appears twice.
class UniqueNames {
 public:
  UniqueNames(const std::filesystem::path& file, const char* kind) : file_(file), kind_(kind) {}
  void Add(const std::string& name) {
    if (name.empty()) throw InputError::At(file_, kind_, "an empty name", "a name");
    if (!seen_.insert(name).second) {
      throw InputError::At(file_, kind_, fmt::format("the name '{}' twice", name), "unique names");
    }
  }

 private:
  const std::filesystem::path& file_;
  const char* kind_;
  std::set<std::string> seen_;
};

// Cameras and poses name output files.
void CheckFileName(const std::string& name, const std::filesystem::path& file, const char* kind) {
  const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '+' || c == '.';
  });
  if (!plain || name.starts_with(".") || name == kAmbientGroup) {
    throw InputError::At(file, kind, fmt::format("the name '{}'", name),
                         "letters, digits, '_', '-', '+' and '.', not first a '.', and not "
                         "'ambient' (it names output files)");
  }
}

void CheckSensor(const SensorSpec& sensor, const std::filesystem::path& file,
                 const std::string& place) {
  const double max_dn = (1 << sensor.adc_bits) - 1;
  if (!(sensor.offset_dn < max_dn)) {
    throw InputError::At(
        file, place,
        fmt::format("offset_dn {} of an ADC that ends at {}", sensor.offset_dn, max_dn),
        "a smaller offset");
  }
}

void CheckRotation(const Mat3d& r, const std::filesystem::path& file, const std::string& place) {
  if (!((r * r.transpose() - Mat3d::Identity()).norm() < 1e-6) || r.determinant() < 0.0) {
    throw InputError::At(file, place,
                         "a matrix that is no rotation (is 'up' along the line of sight?)",
                         "a rigid transform");
  }
}

void CheckObject(const Scene& scene, const SceneObject& object, const std::filesystem::path& file) {
  const std::string place = fmt::format("object '{}'", object.name);
  if (!scene.materials.contains(object.material)) {
    throw InputError::At(file, place, fmt::format("material '{}'", object.material),
                         "a material of the scene");
  }
  const size_t vertices = object.mesh.positions.size();
  for (const auto& triangle : object.mesh.triangles) {
    for (const uint32_t v : triangle) {
      if (v >= vertices)
        throw InputError::At(file, place, fmt::format("vertex {} of {}", v, vertices),
                             "vertices that exist");
    }
  }
  for (const Vec3f& p : object.mesh.positions) {
    if (!p.allFinite())
      throw InputError::At(file, place, "a vertex that is not a number", "finite coordinates");
  }
  if (object.mesh.triangles.empty() || !(object.mesh.Area() > 0.0)) {
    throw InputError::At(
        file, place,
        fmt::format("a mesh of {} triangles without area", object.mesh.triangles.size()),
        "a surface");
  }
  if (scene.materials.at(object.material).texture && object.mesh.uvs.empty()) {
    throw InputError::At(
        file, place, fmt::format("the textured material '{}'", object.material),
        "a mesh with texture coordinates (glTF's TEXCOORD_0), or a material without texture");
  }
  CheckRotation(object.world_from_object.rotation, file, place);
}

void CheckSpectra(const Scene& scene, const std::filesystem::path& file) {
  std::set<LedType> leds;
  for (const CameraSpec& camera : scene.cameras) {
    if (camera.ring) leds.insert(camera.ring->Led());
  }
  const size_t spectra = leds.size() + 1;  // and the room's
  if (spectra > static_cast<size_t>(kMaxSpectra)) {
    throw InputError::At(file, "cameras",
                         fmt::format("{} kinds of light (LED types and the room)", spectra),
                         fmt::format("at most {}", kMaxSpectra));
  }
}

}  // namespace

// Along the border, where a distortion that turns back does so first.
void CheckPictureGetsLight(const CameraModel& model, const std::filesystem::path& file) {
  constexpr int kSteps = 64;
  for (int i = 0; i <= kSteps; ++i) {
    const double u = static_cast<double>(i) / kSteps * model.width - 0.5;
    const double v = static_cast<double>(i) / kSteps * model.height - 0.5;
    for (const Vec2d& px : {Vec2d(u, -0.5), Vec2d(u, model.height - 0.5), Vec2d(-0.5, v),
                            Vec2d(model.width - 0.5, v)}) {
      if (model.PlanePoint(px)) continue;
      throw InputError::At(
          file, fmt::format("camera '{}'", model.name),
          fmt::format("a distortion that brings no light to pixel ({:.1f}, {:.1f})", px.x(),
                      px.y()),
          "coefficients k1, k2, p1, p2, k3 with which radii grow up to the corners of the picture");
    }
  }
}

void CheckScene(const Scene& scene, const std::filesystem::path& file) {
  UniqueNames objects(file, "objects"), cameras(file, "cameras"), markers(file, "markers"),
      poses(file, "poses");
  for (const SceneObject& object : scene.objects) {
    objects.Add(object.name);
    CheckObject(scene, object, file);
  }
  if (scene.cameras.empty()) throw InputError::At(file, "cameras", "none", "at least one camera");
  for (const CameraSpec& camera : scene.cameras) {
    cameras.Add(camera.model.name);
    CheckFileName(camera.model.name, file, "cameras");
    CheckPictureGetsLight(camera.model, file);
    CheckSensor(camera.sensor, file, fmt::format("camera '{}'", camera.model.name));
    CheckRotation(camera.model.camera_from_world.rotation, file,
                  fmt::format("camera '{}'", camera.model.name));
  }
  if (scene.exposure.time_s <= 0.0 && !scene.materials.contains(scene.exposure.marker_material)) {
    throw InputError::At(file, "exposure",
                         fmt::format("marker_material '{}'", scene.exposure.marker_material),
                         "a material of the scene");
  }
  for (const Pose& pose : scene.poses) {
    poses.Add(pose.name);
    CheckFileName(pose.name, file, "poses");
  }
  for (const MarkerSpec& marker : scene.markers) {
    markers.Add(marker.name);
    const std::string place = fmt::format("marker '{}'", marker.name);
    try {
      scene.Object(marker.object);
      scene.marker_set->ByNumber(marker.number);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}: {}", file.string(), place, error.what()));
    }
    if (!scene.materials.contains(marker.material)) {
      throw InputError::At(file, place, fmt::format("material '{}'", marker.material),
                           "a material of the scene");
    }
  }
  CheckSpectra(scene, file);
}

}  // namespace retrolux
