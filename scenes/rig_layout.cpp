#include "scenes/rig_layout.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace retrolux {

namespace {

double Azimuth(const VaultCameras& cameras, double phi_b_deg, int camera) {
  if (cameras.arrangement == Arrangement::kEven) return RadFromDeg(360.0 * camera / cameras.count);
  const double phi_c_deg = (360.0 - 2.0 * phi_b_deg) / (cameras.count - 1);  // eq. 4.9
  return RadFromDeg(phi_b_deg + camera * phi_c_deg);
}

// Cameras 1, 3, 5, ... (index 0, 2, 4, ...) hang on rig 2.
double Theta(const Placement& placement, int camera) {
  return RadFromDeg(camera % 2 == 0 ? placement.theta2_deg : placement.theta1_deg);
}

Vec3d Direction(double theta, double azimuth) {
  return {std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth),
          std::cos(theta)};
}

}  // namespace

std::vector<Vec3d> CameraCentres(const Scenario& scenario, const Placement& placement) {
  const double distance = scenario.rigs.distance_mm;
  const double radius = distance * std::max(std::sin(RadFromDeg(placement.theta1_deg)),
                                            std::sin(RadFromDeg(placement.theta2_deg)));
  std::vector<Vec3d> centres;
  for (int camera = 0; camera < scenario.cameras.count; ++camera) {
    const double azimuth = Azimuth(scenario.cameras, placement.phi_b_deg, camera);
    const double theta = Theta(placement, camera);
    if (scenario.rigs.layout == RigLayout::kEqualRadius) {
      centres.emplace_back(radius * std::cos(azimuth), radius * std::sin(azimuth),
                           distance * std::cos(theta));
    } else {
      centres.push_back(distance * Direction(theta, azimuth));
    }
  }
  return centres;
}

CameraModel VaultCamera(const Scenario& scenario, const std::string& name, const Vec3d& centre) {
  const VaultCameras& cameras = scenario.cameras;
  // Straight above the isocentre z is no direction in the picture; x is.
  const bool overhead = centre.head<2>().norm() < 1e-6 * centre.norm();
  const Vec3d up = overhead ? Vec3d::UnitX() : Vec3d::UnitZ();
  return CameraModel::FromFieldOfView(name, cameras.width_px, cameras.height_px,
                                      cameras.horizontal_fov_deg, cameras.vertical_fov_deg,
                                      LookAt(centre, Vec3d::Zero(), up));
}

std::string NotBuildable(const Scenario& scenario, const Placement& placement) {
  const RigSpec& rigs = scenario.rigs;
  for (const Vec3d& centre : CameraCentres(scenario, placement)) {
    const double radius = centre.head<2>().norm();
    if (radius < rigs.min_radius_mm - rigs.tolerance_mm) {
      return fmt::format("a rig radius of {:.1f} mm, below {} mm", radius, rigs.min_radius_mm);
    }
    if (centre.z() < rigs.min_height_mm - rigs.tolerance_mm) {
      return fmt::format("a rig {:.1f} mm above the isocentre, below {} mm", centre.z(),
                         rigs.min_height_mm);
    }
    if (centre.norm() > rigs.max_distance_mm + rigs.tolerance_mm) {
      return fmt::format("a camera {:.1f} mm from the isocentre, above {} mm", centre.norm(),
                         rigs.max_distance_mm);
    }
  }
  return "";
}

double SeparationRad(const Vec3d& a, const Vec3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

double NominalSeparationRad(const Scenario& scenario, const Placement& placement, int i, int j) {
  return SeparationRad(
      Direction(Theta(placement, i), Azimuth(scenario.cameras, placement.phi_b_deg, i)),
      Direction(Theta(placement, j), Azimuth(scenario.cameras, placement.phi_b_deg, j)));
}

double RigHeight_mm(const Scenario& scenario, double theta_deg) {
  return scenario.rigs.distance_mm * std::cos(RadFromDeg(theta_deg));
}

double ThetaAtHeight_deg(const Scenario& scenario, double height_mm) {
  return DegFromRad(std::acos(std::clamp(height_mm / scenario.rigs.distance_mm, -1.0, 1.0)));
}

}  // namespace retrolux
