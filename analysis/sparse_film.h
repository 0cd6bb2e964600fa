// A picture traced where there is something to be seen, and interpolated where there is not: for
// sets of many pictures, in which most pixels show smooth matt surfaces.
//
// Traced are all pixels of markers, of glossy or textured or perforated objects, and at the edges
// of anything (renderer/edge_pixels.h), as wide as the lens blurs them. Of the rest a grid is
// traced, and a cell of it interpolated (bilinear) if it shows one object only and its corners
// differ by no more than the sensor's noise and the paths' scatter hide; else it is quartered, down
// to 2 px, between which pixels that are no edge take the mean of their like neighbours. Pixels
// of the grid are averaged with neighbours that are the same to within the scatter. What else is
// traced has the values of a full picture. What a cell can hide between its corners, such as the
// shadow of a thin cable in the light of another camera's ring, may be missed.
#pragma once

#include "renderer/film.h"
#include "renderer/id_pass.h"

namespace retrolux {

struct SparseSamples {
  int pixel = 8;    // paths a pixel
  int node = 16;    // of the grid, each of which stands for many pixels
  int marker = 32;  // on markers and at their edges
};

struct SparseFilm {
  Film film;
  int64_t traced_pixels = 0;
  int64_t paths = 0;
};

inline constexpr int kSparseCell_px = 8;

// `ids` of the same camera; `camera`, `scene`: those of the tracer.
SparseFilm RenderSparseFilm(const PathTracer& tracer, const Scene& scene, const CameraSpec& camera,
                            const IdBuffers& ids, double exposure_s, const SparseSamples& samples,
                            std::vector<std::string> group_names);

}  // namespace retrolux
