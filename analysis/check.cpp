#include "analysis/check.h"

#include <cmath>

namespace retrolux {

bool Check::Pass() const {
  return std::abs(measured - expected) <= tolerance;
}

const std::vector<CheckGroup>& CheckGroups() {
  static const std::vector<CheckGroup> groups = {
      {"white furnace", CheckWhiteFurnace,
       "conservation of energy; nothing of the BSDFs enters the expected value"},
      {"diode irradiance", CheckDiodeIrradiance,
       "the intensity's definition and the inverse square law written out in the check"},
      {"ring irradiance", CheckRingIrradiance,
       "a sum over the LEDs written out in the check; measured through a rendered wall"},
      {"cos^4", CheckCosFourth, "the field of view and the place in the picture"},
      {"light groups", CheckLightGroups, "renders of each ring alone, with other random numbers"},
      {"retro-reflection", CheckRetroReflection,
       "the closed form of the lobes written out in the check; sampling, geometry and lamp are the "
       "renderer's"},
      {"sheeting", CheckSheetings,
       "transport, geometry, sampling and lamp against the published tables that the BSDFs hold; "
       "values left out against the interpolation; reciprocity"},
      {"filter", CheckFilter, "the shift formula and the band written out in the check"},
      {"filter gain", CheckFilterGain,
       "spectrum, filter and quadrature written out in the check; measured on rendered pixels; the "
       "tables of emission and quantum efficiency are shared"},
      {"LED and filter", CheckLedMismatch,
       "error functions, or spectrum, filter and quadrature written out in the check"},
      {"exposure", CheckExposure,
       "the level that was asked for; the derived time comes from quadrature, the level from "
       "paths"},
      {"projection", CheckProjection, "OpenCV's projectPoints"},
      {"blur", CheckBlur, "the thin-lens formula; measured on a rendered spot"},
      {"centroids", CheckCentroids, "the projection of a circle in closed form"},
      {"calibration", CheckCalibration, "OpenCV's corner finder and calibration"},
      {"form factor", CheckFormFactor, "a published configuration factor"},
      {"visible caps", CheckVisibleCaps, "spherical geometry; measured on id buffers of a mesh"},
      {"photon transfer", CheckPhotonTransfer,
       "the sensor's description; measured from pictures alone"},
  };
  return groups;
}

}  // namespace retrolux
