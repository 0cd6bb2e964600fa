// A cable that lies over a mask.
#pragma once

#include "analysis/dataset_mask.h"

namespace retrolux {

// A round tube in the mask's frame, from one side of it to the other, its way drawn by numbers that
// begin with `name`.
TriangleMesh CableOver(const DatasetMask& mask, double radius_mm, const SceneDraw& draw,
                       const std::string& name);

}  // namespace retrolux
