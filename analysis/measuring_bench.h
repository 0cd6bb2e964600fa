// A small optical bench for checks and tests: one camera, one single-diode lamp and a flat patch at
// the origin.
#pragma once

#include "renderer/path_tracer.h"
#include "scenes/built_in.h"

namespace retrolux {

// The patch is a square of 200 mm side with normal +x, of the material that `material_json`
// describes; camera and lamp look at its centre. The lamp is a single LED of radius 0.2 mm at the
// pupil of a camera of its own.
struct MeasuringBench {
  std::string material_json = R"({"type": "diffuse", "reflectance": 1.0})";
  Vec3d camera_position = Vec3d(2000, 0, 0);
  Vec3d lamp_position = Vec3d(2000, 100, 0);
  Vec3d lamp_target = Vec3d::Zero();  // where its axis points
  double lamp_half_angle_deg = 20.0;
  double lamp_intensity_w_sr = 0.05;

  // Mean band radiance of the patch's centre towards the camera, W/(m2 sr), and its standard error.
  struct Radiance {
    double mean, standard_error;
  };
  Radiance Measure(int samples, uint64_t seed) const;
};

}  // namespace retrolux
