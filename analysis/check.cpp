#include "analysis/check.h"

#include <cmath>

namespace retrolux {

bool Check::Pass() const {
  return std::abs(measured - expected) <= tolerance;
}

const std::vector<CheckGroup>& CheckGroups() {
  static const std::vector<CheckGroup> groups = {
      {"white furnace", CheckWhiteFurnace},
      {"diode irradiance", CheckDiodeIrradiance},
      {"retro-reflection", CheckRetroReflection},
      {"filter", CheckFilter},
      {"exposure", CheckExposure},
      {"projection", CheckProjection},
      {"photon transfer", CheckPhotonTransfer},
  };
  return groups;
}

}  // namespace retrolux
