// What a treatment vault and its search for camera placements are made of: a scenario file
// (schema scenes/schema/scenario-1.schema.json) gives every number. Angles are degrees here, as in
// the file; rig_layout.h and nozzle.h turn them into geometry.
//
// World frame: z up, x along the horizontal beam with its nozzle on the +x side, origin at the
// isocentre.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/conventions.h"

namespace retrolux {

// from, from + step, ... up to and with `to`.
struct Steps {
  double from = 0.0, to = 0.0, step = 1.0;
  std::vector<double> Values() const;
};

// A treatment beam along the x axis (elevation 0) or above it in the xz-plane.
struct Beam {
  std::string name;
  double elevation_deg = 0.0;
};

// A nozzle of cylinder and telescopic snout (a cone), along a beam's axis; distances are from the
// isocentre. The snout slides into the cylinder, which stays where it is.
struct NozzleSpec {
  double tip_radius_mm = 0.0;
  double snout_back_radius_mm = 0.0;
  double snout_length_mm = 0.0;
  double min_tip_distance_mm = 0.0;  // of the snout fully extended
  double gap_mm = 0.0;               // kept between mask and snout
  double cylinder_radius_mm = 0.0;
  double cylinder_front_mm = 0.0;
  double cylinder_length_mm = 0.0;
};

// How the heights of the two rigs give the places of the cameras (thesis 4.2.4).
enum class RigLayout {
  kConstantDistance,  // every camera at distance_mm
  kEqualRadius,       // both rigs as wide as the wider one: the other's cameras stand further away
};

struct RigSpec {
  RigLayout layout = RigLayout::kConstantDistance;
  double distance_mm = 0.0;
  double max_distance_mm = 0.0;
  double min_radius_mm = 0.0;  // the portal x-ray system passes inside
  double min_height_mm = 0.0;  // above the isocentre: personnel pass below
  double tolerance_mm = 0.0;   // by which the three bounds above may be missed
  bool same_height = false;    // one rig for all cameras
};

// Azimuths of the cameras; odd ones hang on rig 2, even ones on rig 1 (thesis 4.2.5).
enum class Arrangement {
  kBesideBeam,  // camera k at phi_b + (k - 1) (360 - 2 phi_b) / (count - 1)
  kEven,        // camera k at (k - 1) 360 / count
};

struct VaultCameras {
  int count = 0;
  Arrangement arrangement = Arrangement::kBesideBeam;
  int width_px = 0, height_px = 0;
  double horizontal_fov_deg = 0.0, vertical_fov_deg = 0.0;
};

// The orientations that a mask is searched over: every combination of the three angles, but for
// those that the chair or the couch can't take.
struct RotationLimit {
  double y_at_least_deg = 0.0;  // where the backrest lies this flat or flatter ...
  double z_at_least_deg = 0.0;  // ... the chair turns from here on only
};
struct MaskSpec {
  std::string mesh;         // a name of masks.h, or a file beside the scenario
  std::string unit = "mm";  // of a file other than glTF
  double scale = 1.0;
  double relief = 0.75;       // of the procedural face
  std::string order = "zyx";  // of the rotations, left to right; positive y leans back
  std::vector<double> x_deg, y_deg, z_deg;
  std::vector<RotationLimit> limits;
};

struct CombinationSpec {
  int size = 3;                         // every combination of so many cameras
  std::vector<std::vector<int>> extra;  // and these; cameras count from 1
  double min_separation_deg = 0.0;      // between any two, true angle
};

struct ErrorPoint {
  double angle_deg = 0.0;
  double error_mm = 0.0;
};

struct SearchSpec {
  Steps phi_b_deg, theta_deg;  // phase 1
  double refined_phi_b_step_deg = 0.0, refined_theta_step_deg = 0.0;
  int refined_optima = 0;       // how many local optima phase 2 looks around
  double snap_phi_b_deg = 0.0;  // what a workshop can build
  double snap_height_mm = 0.0;
};

// What is uncertain: a change of the scenario under which the search is repeated.
struct Variation {
  std::string name;
  nlohmann::json change;  // merged over the scenario (RFC 7396)
};

// A row of the thesis's table 4.9, to print beside ours.
struct ThesisSolution {
  std::string name;
  double phi_b_deg = 0.0, theta1_deg = 0.0, theta2_deg = 0.0;
  double cost = 0.0, area_pct = 0.0, area_cm2 = 0.0, angle_deg = 0.0, error_mm = 0.0;
  std::string remark;  // what a reader must know of the printed row; may be empty
};

struct Scenario {
  std::string name;
  std::string description;
  double isocentre_height_mm = 0.0;
  std::vector<Beam> beams;
  NozzleSpec nozzle;
  RigSpec rigs;
  VaultCameras cameras;
  std::map<std::string, MaskSpec> masks;
  CombinationSpec combinations;
  std::vector<ErrorPoint> error_points;  // eq. 4.6
  double gamma_max_mm = 0.0;             // eq. 4.7
  SearchSpec search;
  std::vector<Variation> variations;
  std::vector<ThesisSolution> thesis;

  std::filesystem::path file;
  nlohmann::json document;  // as read, the base merged in: what a task is named by

  // InputError that lists the masks.
  const MaskSpec& Mask(const std::string& mask_name) const;
  // This scenario with a change merged over it.
  Scenario With(const Variation& variation) const;
};

// A built-in scenario by name (1a, 1b, 2, 3a, 3b, 4, 5), or the file at a path. A file may name
// another one as its "base" and give only what differs (a JSON merge patch, RFC 7396). InputError
// for whatever does not describe a search.
Scenario LoadScenario(const std::string& name_or_path);
std::vector<std::string> BuiltInScenarioNames();

// The combinations of cameras that are compared, each ascending and from 0.
std::vector<std::vector<int>> CameraCombinations(const Scenario& scenario);

// One orientation of a mask.
struct MaskRotation {
  double x_deg = 0.0, y_deg = 0.0, z_deg = 0.0;
  Mat3d world_from_mask = Mat3d::Identity();
};
// R = Rz(z) Ry(-y) Rx(x) for the order "zyx"; only what the limits allow.
std::vector<MaskRotation> MaskRotations(const MaskSpec& mask);

}  // namespace retrolux
