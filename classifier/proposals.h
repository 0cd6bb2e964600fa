// Which markers a closed outline may show, and how they would lie: proposals for the fit.
#pragma once

#include "classifier/outline_map.h"

namespace retrolux {

struct Proposal {
  size_t model = 0;     // index in the models
  OutlineMap map;       // affine
  double rms_px = 0.0;  // distance of the outline's points from the mapped marker
};

// For each model the turns of it that fit best, at most `turns`, from the best proposal of all to
// the worst. The outline's area is stretched to the covariance 1, as the model's is; what is left
// is a turn, by the radii in all directions; then the affine map is refined by least squares of the
// distances between the outline's points and the model's nearest edges.
// `outline`: counter-clockwise for who looks at the picture.
std::vector<Proposal> ProposeMarkers(const Polygon& outline, const std::vector<ShapeModel>& models,
                                     int turns);

// The same refinement from any first guess.
Proposal RefineProposal(const Polygon& outline, const std::vector<ShapeModel>& models, size_t model,
                        const OutlineMap& guess);

}  // namespace retrolux
