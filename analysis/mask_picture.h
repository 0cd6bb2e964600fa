// Pictures of a mask for people, by our own id pass: how many cameras see each of its triangles,
// and what a camera of the vault has before it.
#pragma once

#include <array>
#include <span>

#include "analysis/report.h"
#include "analysis/visibility.h"

namespace retrolux {

struct RgbPicture {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;  // row by row, top first

  RgbPicture(int width_px, int height_px, const std::array<uint8_t, 3>& fill);
  std::array<uint8_t, 3> At(int x, int y) const;
  void Set(int x, int y, const std::array<uint8_t, 3>& colour);
  std::string Png() const;
};

// For each of `triangles` triangles in how many of the sets the larger part of its area is.
std::vector<int> CamerasPerTriangle(const SurfaceSamples& samples, size_t triangles,
                                    std::span<const SampleSet> sets);

// A camera (from the mask's frame) that has the whole mesh in its picture, and where it stands.
struct Viewpoint {
  std::string name;
  CameraModel camera;
};

// In front of the mesh (where most of its surface faces; +x if it is closed) and to both sides.
std::vector<Viewpoint> ViewpointsOf(const TriangleMesh& mesh, int width_px, int height_px);

class MaskPainter {
 public:
  explicit MaskPainter(const TriangleMesh& mesh);  // must outlive it

  // Triangle i in the colour of category counts[i], lit from the camera so that the shape can be
  // read; the inner side of an open mesh plain grey.
  RgbPicture Counts(const std::vector<int>& counts, const std::vector<OvalCategory>& colours,
                    const CameraModel& camera_from_mask) const;

  // What `camera` (world) sees of the turned mask, each triangle in a colour of its own, and of the
  // nozzles, hatched. The inner side of the mask plain grey.
  RgbPicture Ids(const CameraModel& camera, const Mat3d& world_from_mask,
                 const std::vector<PlacedNozzle>& nozzles) const;

 private:
  // Of a triangle's normal to the line of sight; below 0: its inner side is seen.
  double Facing(uint32_t triangle, const Vec3d& camera_centre) const;

  const TriangleMesh& mesh_;
  Scene scene_;  // what rays_ is made of
  RayScene rays_;
};

}  // namespace retrolux
