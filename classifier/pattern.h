// Bright patterns: what the method looks at.
#pragma once

#include <vector>

#include "classifier/edge_bands.h"
#include "classifier/edges.h"
#include "classifier/gradient.h"

namespace retrolux {

struct Pattern {
  // Where the picture is half way between the pattern and its surroundings, counter-clockwise for
  // who looks at the picture, at equal steps.
  Polygon outline;
  double step_px = 0.0;
  double area_px = 0.0;
  double contrast = 0.0;      // height above the surroundings, DN (median over the outline)
  double noise = 0.0;         // of a pixel there, DN
  double blur_px = 0.0;       // width of its edges beyond that of a picture in focus
  double hole_area_px = 0.0;  // of dark holes inside
  LevelPlane level;           // half way between the pattern and its surroundings, DN
  bool torn = false;          // the outline is not that of the level, which may be open there
};

// The patterns that lie wholly in the picture and are large, high and sharp enough for the options:
// one for each band of edges that stays off the picture's border.
std::vector<Pattern> FindPatterns(const GradientField& field, const EdgeBands& bands,
                                  const EdgesOptions& options);

// The same, but every closed outline that a band follows is one, so that markers whose edges run
// into one another, into the rim of the mask or an edge that leaves the picture are found, too.
std::vector<Pattern> FindEveryPattern(const GradientField& field, const EdgeBands& bands,
                                      const EdgesOptions& options);

// What FindEveryPattern misses because the light falls by a factor over it, so that its outline is
// open half way up: closed outlines of `relief` = 0 (MeasureRelief). Where the light falls less
// they are those of FindEveryPattern again.
std::vector<Pattern> FindTornPatterns(const GradientField& field, const EdgeBands& bands,
                                      const FloatPlane& relief, const EdgesOptions& options);

}  // namespace retrolux
