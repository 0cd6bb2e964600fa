// Pairs of cameras that look at markers whose places are known, rendered, exposed many times and
// identified: what the study of the stereo error measures on.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "classifier/constellation.h"
#include "renderer/film.h"

namespace retrolux {

// What carries the six identifiable markers and a standard one. Panel: flat and black, so that
// nothing but the angle matters. Oval: the CT study's mask, curved, with a coat that shines.
enum class StereoTarget { kPanel, kOval };
const char* NameOf(StereoTarget target);

struct StereoShotSpec {
  StereoTarget target = StereoTarget::kPanel;
  double psi_deg = 45.0;  // separation of the cameras
  int placement = 0;      // which random place and turn of the target
};

struct StereoShotOptions {
  uint64_t seed = 1;  // of placements, light transport and noise
  int samples_per_pixel = 16;
  int exposures = 8;  // pictures of each film, each with its own noise
  double distance_mm = 1600.0;
  std::string material = "retro_bead";
};

// The thesis's cameras "left" and "right", `distance_mm` from the origin in the plane z = 0, the
// bisector of their axes along +x.
std::array<CameraSpec, 2> StereoPair(double psi_deg, double distance_mm);

// The target with its markers, moved by up to 20 mm along each axis and turned by up to 10 degrees
// about each (the panel first by any angle about its normal).
Scene StereoScene(const StereoShotSpec& spec, const StereoShotOptions& options);

// The noiseless picture of a camera in the light of all rings, traced where there is something to
// be seen (sparse_film.h), four times the samples at the edges of markers. `placed`: the scene's.
Film RenderSparsely(const Scene& scene, const RayScene& rays,
                    const std::vector<PlacedMarker>& placed, const CameraSpec& camera,
                    double exposure_s, int samples_per_pixel, uint64_t seed);

// Where a marker was found in one picture, px.
struct FoundMarker {
  Vec2d light = Vec2d::Zero();   // the detection's centroid
  Vec2d centre = Vec2d::Zero();  // the middle of the shape by the fit
};

// A marker in one camera's pictures: what is true of them all, and what was found in each exposure.
struct MarkerInView {
  double incidence_deg = 0.0;
  Vec2d projected_px = Vec2d::Zero();             // the middle of its shape, on the surface
  std::optional<Vec2d> outline_px;                // centre of the area of the projected outline
  std::optional<Vec2d> radiometric_px;            // of the light in the noiseless picture
  std::vector<std::optional<FoundMarker>> found;  // by exposure
};

struct MarkerInPair {
  KnownMarker known;         // in the target's frame
  Vec3d at = Vec3d::Zero();  // world: the middle of its shape, on the surface
  std::array<MarkerInView, 2> views;
};

struct StereoShot {
  RigidTransform world_from_target;
  std::vector<MarkerInPair> markers;
  int misnamed = 0;  // detections with the name of a marker that is elsewhere

  nlohmann::json ToJson() const;
  static StereoShot FromJson(const nlohmann::json& json);
};

StereoShot ShootStereo(const StereoShotSpec& spec, const StereoShotOptions& options);

}  // namespace retrolux
