// Where the cameras of a placement stand (thesis 4.2.4, 4.2.5), in the vault's frame.
#pragma once

#include <vector>

#include "core/camera_model.h"
#include "scenes/scenario.h"

namespace retrolux {

// What the search varies: the azimuth of the cameras beside the beam and the nominal polar angles
// of the rigs (the polar angle that a rig at that height has at distance_mm).
struct Placement {
  double phi_b_deg = 0.0, theta1_deg = 0.0, theta2_deg = 0.0;
  bool operator==(const Placement&) const = default;
};

// Centres of cameras 1 .. count.
std::vector<Vec3d> CameraCentres(const Scenario& scenario, const Placement& placement);

// The camera at `centre`, looking at the isocentre, z upwards in the picture.
CameraModel VaultCamera(const Scenario& scenario, const std::string& name, const Vec3d& centre);

// Why the placement can't be built (a bound of RigSpec that it misses), or "".
std::string NotBuildable(const Scenario& scenario, const Placement& placement);

// The angle at the isocentre between two camera centres.
double SeparationRad(const Vec3d& a, const Vec3d& b);

// The separation of cameras i and j (from 0) after eq. 4.12, with nominal polar angles: what the
// thesis used, also where the rigs' true polar angles differ (equal radii).
double NominalSeparationRad(const Scenario& scenario, const Placement& placement, int i, int j);

// Height of a rig above the isocentre, and the nominal polar angle at a height.
double RigHeight_mm(const Scenario& scenario, double theta_deg);
double ThetaAtHeight_deg(const Scenario& scenario, double height_mm);

}  // namespace retrolux
