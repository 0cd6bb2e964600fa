// One camera's picture in the light of its own ring and of its neighbours': rendered once, mixed,
// exposed many times, identified.
#pragma once

#include <map>

#include "analysis/hotspot_figures.h"

namespace retrolux {

struct HotspotShotOptions {
  uint64_t seed = 1;
  uint64_t noise_seed = 1;
  HotspotSamples samples;
  int exposures = 8;           // of each mix, each with its own noise; the same for all mixes
  std::vector<double> powers;  // of the neighbours, beside 1 (HotspotMixes)
};

// Everything that the mixes of one picture share.
struct HotspotStage {
  Scene scene;
  RayScene rays;
  const CameraSpec& camera;
  size_t mask;  // the object that the markers lie on
  HotspotLight light;
  std::vector<FloatPlane> bare_glints;
  std::vector<HotspotMarker> markers;

  HotspotStage(Scene of, size_t camera_index, const HotspotSamples& samples, uint64_t seed);
  HotspotStage(const HotspotStage&) = delete;
  HotspotStage& operator=(const HotspotStage&) = delete;
};

// How far a marker is found from where it is found without the neighbours, px.
struct PlaceShift {
  // In a picture without noise (a sensor with ten thousand times the full well), -1: not found in
  // both.
  double centroid_px = -1.0;
  double corners_px = -1.0;  // rms over the corners
  // In pictures with noise: mean shift of the centroid over the exposures in which both found it.
  int pairs = 0;
  std::array<double, 2> mean_px = {0.0, 0.0};
  // 1 sigma of u and v over the exposures without the neighbours.
  double centroid_noise_px = 0.0, corner_noise_px = 0.0;
};

// What a method finds of one mix. Markers: the identifiable ones, as HotspotShot has them.
struct MixDetections {
  std::vector<std::vector<int>> found;  // by marker and exposure, 1: named rightly
  std::vector<int> wrong_names;         // by exposure: another name, or one where no marker is
  std::vector<int> strays;              // by exposure: patterns without a name off every marker
  std::vector<PlaceShift> shifts;       // by marker
};

struct MixResult {
  std::string mix;
  HotspotLevels levels;
  std::map<std::string, MixDetections> methods;  // "edges", "robust"
};

// Where two cameras' highlights triangulate to, mm behind the surface at the cross highlight, along
// the bisector of the two directions.
struct HighlightDepths {
  bool known = false;  // both cameras see both highlights
  double cross_mm = 0.0, own_mm = 0.0;
  double apart_mm = 0.0;  // own and cross highlight of the first camera, on the surface
};

struct HotspotShot {
  std::vector<int> markers;  // numbers of the identifiable ones that are wholly seen
  std::vector<RingLight> rings;
  std::vector<MixResult> mixes;
  HighlightDepths depths;
  // The paths' scatter of the bare mask over the sensor's noise, rms over its pixels.
  double render_noise = 0.0;
};

// `mixes` hold the reference of each of them (ReferenceOf). `picture` names the noise.
HotspotShot ShootHotspots(const HotspotStage& stage, const std::vector<HotspotMix>& mixes,
                          const HotspotShotOptions& options, const std::string& picture);

// Of the highlights that `stage`'s camera and `other` see in each other's and in their own light.
HighlightDepths DepthsOfHighlights(const HotspotStage& stage, const CameraSpec& other,
                                   const HotspotSamples& samples, uint64_t seed);

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PlaceShift, centroid_px, corners_px, pairs, mean_px,
                                   centroid_noise_px, corner_noise_px)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MixDetections, found, wrong_names, strays, shifts)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MixResult, mix, levels, methods)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(HighlightDepths, known, cross_mm, own_mm, apart_mm)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(HotspotShot, markers, rings, mixes, depths, render_noise)

}  // namespace retrolux
