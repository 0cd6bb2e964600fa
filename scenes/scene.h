// The description of a scene: plain structs, filled by scene.json (scene_json.h) or by code
// (built_in.h), read by the renderer. Lengths mm, world frame of core/conventions.h.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/camera_model.h"
#include "core/marker_set.h"
#include "core/transform.h"
#include "materials/filter.h"
#include "materials/material_library.h"
#include "scenes/mesh.h"
#include "scenes/perforation.h"
#include "scenes/up_axis.h"

namespace retrolux {

// A ring of light-emitting diodes around a lens, in the plane through the camera's centre, each LED
// facing forward. Defaults: docs/assumptions.md.
struct DiodeRing {
  int count = 24;
  double radius_mm = 30.0;
  double peak_nm = 880.0;  // at 25 C
  double fwhm_nm = 80.0;
  double half_angle_deg = 20.0;  // where the intensity is half: I = I0 cos^m, m = -ln 2 / ln cos
  double radiant_intensity_w_sr = 0.05;  // I0 of one LED at 25 C, over its whole spectrum
  double led_radius_mm = 2.5;            // radius of the emitting disc
  // Temperature of the junctions; data sheets state the values above at 25 C. The drifts are those
  // of OSRAM's SFH 4555 (data sheet, version 1.4, 2018).
  double junction_temperature_c = 25.0;
  double peak_drift_nm_k = 0.3;
  double intensity_drift_percent_k = -0.5;  // of the intensity at 25 C
  LedShape spectrum_shape = LedShape::kGaussian;

  double LambertExponent() const;
  // Spectrum and I0 of an LED at the temperature of its junction.
  LedType Led() const;
  double Intensity_w_sr() const;
};

// A lens without thickness. E = pi L T cos^4 / (4 N^2) with all in focus (a pinhole whose f-number
// enters the irradiance only), unless `focus_distance_mm` makes it a thin lens.
struct Lens {
  double focal_length_mm = 30.0;
  double f_number = 5.6;
  double transmission = 0.85;  // of the glass, without the filter
  // Along the axis, from the lens to the plane that is in focus; 0: a pinhole.
  double focus_distance_mm = 0.0;
  // Mechanical vignetting: a round stop of the barrel, centred on the axis in front of the lens,
  // cuts oblique light. Radius 0: none.
  double stop_radius_mm = 0.0;
  double stop_distance_mm = 0.0;
  bool diffraction = false;    // Airy disc of the aperture, at the working f-number
  double veiling_glare = 0.0;  // share of the light that is spread evenly over the picture

  double ApertureRadius_mm() const { return 0.5 * focal_length_mm / f_number; }
  // From the lens to the sensor: the focal length, or s f / (s - f) with the focus at s.
  double PrincipalDistance_mm() const;
};

// Options of a sensor: each is an effect of real parts that the linear model leaves out.

// Charge above the full well flows along the column (renderer/sensor_blooming.h).
struct Blooming {
  double drained = 0.0;  // share of it that an anti-blooming drain takes
};

// A column's light leaks into the charge that is moved through it (renderer/sensor_smear.h).
struct Smear {
  double ratio = 1e-5;           // sensitivity of the register relative to that of a photosite
  double line_time_s = 63.6e-6;  // in which the charge moves by one line; here EIA's
};

// Pixels that are not as the others (renderer/sensor_defects.h), 1 in a million being one per 10^6.
struct DefectPixels {
  double hot_per_million = 100.0;
  double hot_dark_current_e_s = 10000.0;  // beyond that of the others, at the same temperatures
  double dead_per_million = 10.0;         // without response to light
};

// How the lines are read: each by itself, or two at a time in two fields
// (renderer/sensor_fields.h).
enum class Scan { kProgressive, kInterlaced };

// The sensor as EMVA 1288 describes one (linear model). Defaults: a half-inch interline CCD of
// about 2003.
struct SensorSpec {
  std::string quantum_efficiency = "materials/data/qe_interline_ccd.csv";
  double full_well_e = 30000.0;
  double read_noise_e = 20.0;      // temporal dark noise of the read-out, 1 sigma
  double dark_current_e_s = 50.0;  // at dark_reference_c
  int adc_bits = 8;
  double offset_dn = 3.0;  // black level, so that dark noise is not cut off at zero
  // Gain in DN per electron. 0: chosen so that a full well (two of them if lines are read in
  // pairs) is the largest number of the ADC.
  double gain_dn_e = 0.0;
  double prnu = 0.01;   // photo-response non-uniformity: 1 sigma of the pixels' relative response
  double dsnu_e = 8.0;  // dark-signal non-uniformity: 1 sigma of the pixels' offset
  // 1 sigma of the way that charge diffuses sideways before a pixel collects it.
  double charge_diffusion_um = 0.0;
  double temperature_c = 25.0;
  double dark_reference_c = 25.0;
  double dark_doubling_k = 8.0;  // the dark current doubles over this difference of temperature
  // Names the part, and with it the pattern of its pixels; empty: the camera's name.
  std::string serial;
  Scan scan = Scan::kProgressive;
  std::optional<Blooming> blooming;
  std::optional<Smear> smear;
  std::optional<DefectPixels> defects;

  // mu_I(T) = mu_I(T_ref) 2^((T - T_ref) / T_d), as a factor on all dark currents.
  double DarkCurrentFactor() const;
  // Lines whose charge makes one row of the picture.
  int LinesPerRow() const { return scan == Scan::kInterlaced ? 2 : 1; }
};

struct CameraSpec {
  CameraModel model;
  Lens lens;
  std::optional<DichroicFilter> filter;
  SensorSpec sensor;
  std::optional<DiodeRing> ring;
};

// Centre of LED `index` of a camera's ring in the world; LED 0 lies on the camera's +x axis.
Vec3d LedCentre(const CameraSpec& camera, int index);

// Corners of its emitting surface: a regular polygon with the area of the LED's disc, so that it is
// made of triangles of equal area; counter-clockwise seen from in front of the camera.
inline constexpr int kLedCorners = 12;
std::array<Vec3d, kLedCorners> LedOutline(const CameraSpec& camera, int index);

// A rectangle that emits evenly into its half-space, along edge_u x edge_v.
struct LightPanel {
  Vec3d corner, edge_u, edge_v;
};

// The light of the room, and the name of its light group.
inline constexpr const char* kAmbientGroup = "ambient";
struct AmbientLight {
  std::string spectrum = "materials/data/fluorescent.csv";  // relative emission over wavelength
  double radiance_w_m2_sr = 0.0;                            // of the panels, 400 to 1100 nm
  std::vector<LightPanel> panels;
  double environment_w_m2_sr = 0.0;  // from where no object is, the same spectrum
};

struct SceneObject {
  std::string name;
  TriangleMesh mesh;  // object frame
  RigidTransform world_from_object;
  std::string material;  // name in Scene::materials
  bool moves_with_pose = false;
  std::optional<Perforation> perforation = std::nullopt;
};

// A marker on the surface of an object.
struct MarkerSpec {
  std::string name;
  int number = 1;            // shape in the marker set
  std::string object;        // whose surface it lies on
  Vec3d at = Vec3d::Zero();  // object frame; the nearest point of the surface is taken
  double roll_deg = 0.0;     // about the outward normal, see marker_placement.h
  std::string material = "retro_bead";
  bool dark = false;  // a dark shape on a bright square instead of a bright shape
};

// A position of the patient: all objects that move with the pose are shifted by it.
struct Pose {
  std::string name;
  Vec3d translation = Vec3d::Zero();  // world
};

struct Exposure {
  // 0: derived, so that a frontal marker of `marker_material` at `distance_mm` in the light of the
  // camera's own ring sits at `fraction` of full scale (renderer/exposure.h).
  double time_s = 0.0;
  double fraction = 0.7;
  double distance_mm = 1600.0;
  std::string marker_material = "retro_bead";
};

struct Scene {
  std::string name;
  UpAxis up_axis = UpAxis::kX;  // how the world stands in a glTF viewer
  std::map<std::string, Material> materials;
  std::vector<SceneObject> objects;
  std::vector<CameraSpec> cameras;
  std::vector<MarkerSpec> markers;
  // What the numbers of the markers mean; never null.
  std::shared_ptr<const MarkerSet> marker_set = {std::shared_ptr<void>(), &DefaultMarkerSet()};
  AmbientLight ambient;
  std::vector<Pose> poses;  // the first is the one that the objects are given in
  Exposure exposure;

  // InputError that lists the known names.
  const SceneObject& Object(const std::string& object_name) const;
  const CameraSpec& Camera(const std::string& camera_name) const;
  // The scene with its moving objects at another of its poses. The result has that pose only.
  Scene AtPose(const std::string& pose_name) const;
  Scene AtPose(const Pose& pose) const;
  // A material of the scene, taken from the library at its first use.
  void UseMaterial(const std::string& material_name);
};

// What the parts of a scene must fulfil beyond their types: names that exist and are unique, meshes
// with an area, cameras with pixels, at most kMaxSpectra kinds of light. InputError that begins
// with `file`.
void CheckScene(const Scene& scene, const std::filesystem::path& file);

}  // namespace retrolux
