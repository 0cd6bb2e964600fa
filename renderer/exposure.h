// How long to expose, derived and not tuned.
#pragma once

#include "renderer/camera_response.h"

namespace retrolux {

// Radiance over irradiance of a flat marker that faces the camera from `distance_mm` on its axis,
// in the light of the camera's own ring, in W/(m2 sr): sum over the LEDs of f cos I / d^2 with the
// material's BSDF.
double FrontalMarkerRadiance(const CameraSpec& camera, const Bsdf& material, double distance_mm);

// The scene's exposure time for that camera: as given, or such that the frontal marker of Exposure
// sits at its fraction of full scale. InputError if it has to be derived and the camera has no
// ring.
double ExposureSeconds(const Scene& scene, const CameraSpec& camera);

}  // namespace retrolux
