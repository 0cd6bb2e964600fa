// The light of one picture, taken apart: by the ring that it comes from, and by what sent it.
//
// One render keeps the rings apart as light groups. What sent the light is told by two more renders
// of the same scene with parts of its materials taken away; the first reflection is linear in them,
// so that the differences are exact but for the paths' noise, and for light that is reflected more
// than once (a few per cent, between a convex mask and its markers next to nothing):
//
//   all     everything
//   plain   sheeting without its retro-reflective lobe: body and cover alone
//   glints  mirror-like reflection alone: the mask's coat, the sheeting's cover; all bodies black
//
// all - plain is the retro-reflective lobe, plain - glints the bodies (on the mask: the beams'
// overlap), glints the highlights.
#pragma once

#include "renderer/film.h"
#include "renderer/id_pass.h"

namespace retrolux {

// Paths a pixel, by what it shows, and how far they go.
struct HotspotSamples {
  int mask = 4;
  int marker = 16;
  int edge = 32;  // where anything begins or ends (renderer/edge_pixels.h)
  int rest = 1;
  int surfaces = 6;  // that scatter, of a path; 1: the first reflection alone, no indirect light
};

struct HotspotLight {
  double exposure_s = 0.0;
  size_t own = 0;                   // the group of the camera's own ring
  std::vector<std::string> groups;  // rings by the names of their cameras, then "ambient"
  std::vector<FloatPlane> all, plain, glints;  // by group, mean signal, e-
  IdBuffers ids;
  Plane<uint8_t> edges;

  bool IsRing(size_t group) const { return groups[group] != kAmbientGroup; }
};

// Of a camera with a ring. `mask`: the index of the object that the markers lie on.
HotspotLight TraceHotspots(const Scene& scene, const RayScene& rays, const CameraSpec& camera,
                           size_t mask, const HotspotSamples& samples, uint64_t seed);

// The glints of the same scene without its markers, by group: highlights on the bare mask.
std::vector<FloatPlane> TraceBareGlints(const Scene& scene, const RayScene& rays,
                                        const CameraSpec& camera, size_t mask,
                                        const HotspotSamples& samples, uint64_t seed);

// The scene's materials with sheeting made plain, and with mirror-like reflection alone. InputError
// for a type that cannot be taken apart.
Scene WithPlainSheeting(const Scene& scene);
Scene WithGlintsOnly(const Scene& scene);

}  // namespace retrolux
