// A treatment nozzle where it stands while a patient is treated: its snout as close to the mask as
// it may come (thesis algorithm 2.3.2).
#pragma once

#include <span>

#include "core/truncated_cone.h"
#include "scenes/mesh.h"
#include "scenes/scenario.h"

namespace retrolux {

struct PlacedNozzle {
  TruncatedCone snout;
  TruncatedCone cylinder;
  double tip_distance_mm = 0.0;  // of the snout's tip from the isocentre
  bool too_close = false;        // even with the snout fully contracted the gap is not kept
};

// The unit vector from the isocentre to the nozzle of a beam.
Vec3d BeamDirection(const Beam& beam);

// The snout moves along the beam until the nearest of `mask_points` (world) that lie before it is
// gap_mm away along the beam, and not nearer to the isocentre than min_tip_distance_mm.
PlacedNozzle PlaceNozzle(const NozzleSpec& spec, const Beam& beam,
                         std::span<const Vec3d> mask_points);

// Whether a nozzle stands between the two points.
inline bool Hides(const PlacedNozzle& nozzle, const Vec3d& a, const Vec3d& b) {
  return SegmentHits(nozzle.snout, a, b) || SegmentHits(nozzle.cylinder, a, b);
}

// The solid as a mesh of `segments` facets around, to be drawn.
TriangleMesh TruncatedConeMesh(const TruncatedCone& cone, int segments);

}  // namespace retrolux
