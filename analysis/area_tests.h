// The tests of the study of visible areas (area_study.h), each a list of rows.
#pragma once

#include <memory>
#include <vector>

#include "analysis/area_study.h"
#include "analysis/reconstruction_error.h"
#include "core/camera_model.h"
#include "scenes/scenario.h"

namespace retrolux {

inline constexpr double kAreaSphereRadius_mm = 100.0;
inline constexpr double kAreaFar = 100.0;  // times the distance, with a lens as much longer

// The thesis's sphere and cameras. Not for several threads at once: it makes its masks when they
// are asked for.
class AreaBench {
 public:
  explicit AreaBench(const AreaStudyOptions& options);

  const AreaStudyOptions& Options() const { return options_; }
  const Scenario& Room() const { return room_; }
  double Distance_mm() const { return room_.rigs.distance_mm; }

  const Mask& Fine();    // the sphere, options.part_area_mm2
  const Mask& Coarse();  // 16 times that, for curves of many points
  const Mat3d& Rotation() const { return world_from_mask_; }

  // At the camera's distance (or kAreaFar times that), looking at the origin.
  CameraModel Camera(const Vec3d& direction, bool far = false) const;

  // What each camera (in the world) sees of a mask that is turned.
  static std::vector<SampleSet> Seen(const Mask& mask, const Mat3d& world_from_mask,
                                     const std::vector<CameraModel>& cameras);
  std::vector<SampleSet> SeenOfSphere(const Mask& mask,
                                      const std::vector<CameraModel>& cameras) const {
    return Seen(mask, world_from_mask_, cameras);
  }

 private:
  AreaStudyOptions options_;
  Scenario room_;
  Mat3d world_from_mask_;
  std::unique_ptr<Mask> fine_, coarse_;
};

SampleSet InBoth(const SampleSet& a, const SampleSet& b);

// Nine cameras every 40 degrees around the equator: one, two and three of them.
std::vector<AreaRow> MeasureSingles(AreaBench& bench);
std::vector<AreaRow> MeasurePairs(AreaBench& bench, int steps);  // of 40 degrees
std::vector<AreaRow> MeasureTriplets(AreaBench& bench);
// Three cameras of two rigs: not in one plane.
std::vector<AreaRow> MeasureRigTriplets(AreaBench& bench);
std::vector<AreaRow> MeasureFarPairs(AreaBench& bench);
// Cameras 1 and 2 over phi_b with the nozzles between, far or at the scenario's distance.
std::vector<AreaRow> MeasureBeam(AreaBench& bench, bool far);
std::vector<AreaRow> MeasurePairsOverPsi(AreaBench& bench);
std::vector<AreaRow> MeasureDiscs(AreaBench& bench);
std::vector<AreaRow> MeasureEllipsoids(AreaBench& bench);

// How the error falls.
enum class AreaAxis { kResolution, kSamples, kTriangles };
struct AreaSetting {
  bool disc = false;  // half hidden; else the sphere
  VisibilityRule rule = VisibilityRule::kIdBuffer;
  AreaAxis axis = AreaAxis::kResolution;
  int value = 0;  // pixels across; samples along a triangle's edge; levels of the mesh
};
const char* NameOf(AreaAxis axis);
std::vector<AreaSetting> AreaSettings(const AreaStudyOptions& options);
std::vector<AreaRow> MeasureSetting(AreaBench& bench, const AreaSetting& setting);

}  // namespace retrolux
