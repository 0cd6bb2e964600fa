#include "scenes/scenario.h"

#include <cmath>

#include "core/error.h"

namespace retrolux {

std::vector<double> Steps::Values() const {
  // Values are multiples of the step, not sums: the tenth is as exact as the first.
  constexpr double kSlack = 1e-6;
  const int last = static_cast<int>(std::floor((to - from) / step + kSlack));
  std::vector<double> values;
  for (int i = 0; i <= last; ++i) values.push_back(from + i * step);
  return values;
}

const MaskSpec& Scenario::Mask(const std::string& mask_name) const {
  const auto found = masks.find(mask_name);
  if (found != masks.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [known, spec] : masks) names.push_back(known);
  throw InputError::At(file, "/masks", fmt::format("no mask '{}'", mask_name),
                       fmt::format("one of {}", JoinNames(names)));
}

namespace {

void AppendCombinations(int count, int size, int first, std::vector<int>& chosen,
                        std::vector<std::vector<int>>& all) {
  if (static_cast<int>(chosen.size()) == size) {
    all.push_back(chosen);
    return;
  }
  for (int camera = first; camera < count; ++camera) {
    chosen.push_back(camera);
    AppendCombinations(count, size, camera + 1, chosen, all);
    chosen.pop_back();
  }
}

}  // namespace

std::vector<std::vector<int>> CameraCombinations(const Scenario& scenario) {
  std::vector<std::vector<int>> all;
  std::vector<int> chosen;
  AppendCombinations(scenario.cameras.count, scenario.combinations.size, 0, chosen, all);
  for (std::vector<int> extra : scenario.combinations.extra) {
    for (int& camera : extra) --camera;
    all.push_back(extra);
  }
  return all;
}

namespace {

Mat3d RotationAbout(char axis, const MaskRotation& rotation) {
  const auto about = [](double deg, const Vec3d& direction) -> Mat3d {
    return Eigen::AngleAxisd(RadFromDeg(deg), direction).toRotationMatrix();
  };
  if (axis == 'x') return about(rotation.x_deg, Vec3d::UnitX());
  if (axis == 'y') return about(-rotation.y_deg, Vec3d::UnitY());
  return about(rotation.z_deg, Vec3d::UnitZ());
}

bool Allowed(const std::vector<RotationLimit>& limits, double y_deg, double z_deg) {
  for (const RotationLimit& limit : limits) {
    if (y_deg >= limit.y_at_least_deg && z_deg < limit.z_at_least_deg) return false;
  }
  return true;
}

}  // namespace

std::vector<MaskRotation> MaskRotations(const MaskSpec& mask) {
  std::vector<MaskRotation> rotations;
  for (const double y : mask.y_deg) {
    for (const double x : mask.x_deg) {
      for (const double z : mask.z_deg) {
        if (!Allowed(mask.limits, y, z)) continue;
        MaskRotation rotation = {x, y, z, Mat3d::Identity()};
        for (const char axis : mask.order)
          rotation.world_from_mask = rotation.world_from_mask * RotationAbout(axis, rotation);
        rotations.push_back(rotation);
      }
    }
  }
  return rotations;
}

}  // namespace retrolux
