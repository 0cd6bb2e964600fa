// The masks of a dataset, ready to have markers put on them.
#pragma once

#include <vector>

#include "analysis/dataset_config.h"
#include "scenes/mesh.h"

namespace retrolux {

// A mask in its own frame: mm, looking along +x.
struct DatasetMask {
  struct Edge {
    Vec3d from, to;
  };
  std::string name;  // as the config calls it
  std::string hash;  // of its geometry
  TriangleMesh mesh;
  Vec3d middle = Vec3d::Zero();        // of its bounding box
  std::vector<double> area_up_to_mm2;  // of triangles 0 .. i
  std::vector<Edge> rim;               // none if it is closed
  std::vector<double> rim_up_to_mm;

  // Uniform over the surface.
  Vec3d PointAt(double u_triangle, double u, double v) const;
  // Uniform along the rim, which there must be.
  Vec3d RimPointAt(double u) const;
};

// InputError for a file that can't be read.
DatasetMask MakeDatasetMask(const MaskChoice& choice, const std::filesystem::path& config_file);

}  // namespace retrolux
