// Which part of a mask a camera sees, as the set of the mask's surface samples that it sees.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/surface_samples.h"
#include "renderer/id_buffer.h"
#include "scenes/nozzle.h"

namespace retrolux {

// How a part of the mask that faces the camera is found hidden behind another. Facing is decided by
// the surface's normal in all three: at a limb half a pixel is 7 % of what a camera sees of a
// sphere.
enum class VisibilityRule {
  kIdBuffer,  // the id buffer at the sample's projection holds something nearer than the mask's
              // tangent plane there (design of the study; the default)
  kRays,      // a ray from the camera to the sample meets something: no pixels, so no bias
  kTriangles  // thesis algorithm 4.5.4: a triangle counts whole if its corners fall on the CCD,
              // none of them lies behind a nozzle, and its middle is not hidden
};
VisibilityRule VisibilityRuleNamed(const std::string& name);  // "ids", "rays", "triangles"
const char* NameOf(VisibilityRule rule);

// Bit i % 64 of word i / 64 is sample i.
using SampleSet = std::vector<uint64_t>;

// A mask ready to be looked at, in its own frame.
class Mask {
 public:
  // `part_area_mm2`, `sample_seed`: of the samples, see SampleSurface; kTriangles takes one a
  // triangle instead.
  Mask(std::string name, TriangleMesh mesh, VisibilityRule rule, double part_area_mm2,
       uint64_t sample_seed = 1);

  const std::string& Name() const { return name_; }
  const TriangleMesh& Mesh() const { return mesh_; }
  const SurfaceSamples& Samples() const { return samples_; }
  VisibilityRule Rule() const { return rule_; }
  // Of the smallest sphere about the origin that holds the mesh.
  double Radius_mm() const { return radius_mm_; }
  // Names the mesh and how it is sampled.
  const std::string& Hash() const { return hash_; }

  // The samples that face the camera, fall on its picture, and are not hidden by the mask itself.
  SampleSet SeenBy(const CameraModel& camera_from_mask) const;

  // Area (mm2) that faces the camera and falls beside its picture.
  double AreaOutsidePicture(const CameraModel& camera_from_mask) const;

  // Takes out of `seen` what lies behind one of the nozzles.
  void RemoveHidden(SampleSet& seen, const Mat3d& world_from_mask,
                    const std::vector<PlacedNozzle>& nozzles, const Vec3d& camera_centre) const;

  double AreaOf(const SampleSet& set) const;  // mm2

 private:
  // The samples of one word of a set, which lie together: a sphere that holds their triangles.
  struct Patch {
    Vec3d centre;
    double radius_mm = 0.0;
  };
  std::vector<Patch> Patches() const;
  bool HiddenSample(size_t sample, const Mat3d& world_from_mask,
                    const std::vector<TruncatedCone>& solids, const Vec3d& camera_centre) const;
  SampleSet SeenInBuffer(const CameraModel& camera) const;
  SampleSet SeenByRays(const CameraModel& camera) const;
  bool CornersInFrame(const CameraModel& camera, uint32_t triangle) const;

  std::string name_;
  TriangleMesh mesh_;
  VisibilityRule rule_;
  SurfaceSamples samples_;
  RayScene rays_;
  std::vector<Patch> patches_;  // one for each word of a set
  double radius_mm_ = 0.0;
  std::string hash_;
};

inline bool Contains(const SampleSet& set, size_t sample) {
  return ((set[sample / 64] >> (sample % 64)) & 1u) != 0;
}

}  // namespace retrolux
