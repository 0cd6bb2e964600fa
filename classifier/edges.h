// Identification method `edges`, after section 3.3.1 of the thesis: finds the bright patterns of a
// grey picture, their corners and straight edges, and compares them with the marker set by the
// number of straight edges. Where to read on, in the order of the work:
//   gradient.h     noise of the picture, its slope
//   pattern.h      bands of steep slope -> closed contours at half height -> patterns
//   polygon_fit.h  the number of straight edges of a contour
//   ellipse_fit.h  round patterns
//   shape_match.h  the counted corners against the outline of the marker with that count
#pragma once

#include <filesystem>
#include <vector>

#include "classifier/detection.h"
#include "core/marker_set.h"
#include "core/plane.h"

namespace retrolux {

struct EdgesOptions {
  // Smallest area inside the contour that is looked at, px2. Smaller finds markers further away,
  // and lets blurred blobs pass for triangles: in 7000 random views no wrong name was larger
  // than 64.
  double min_area_px = 70.0;
  // Slope at which a pixel counts as an edge, in standard deviations of the slope's noise. Lower
  // finds dimmer patterns, and connects neighbours by noise. At 5 a megapixel of noise has about 4
  // such pixels.
  double min_slope_sigma = 5.0;
  // Smallest height of a pattern above its surroundings, in standard deviations of a pixel's noise.
  double min_contrast_sigma = 5.0;
  // Largest width of the edges (height over slope) beyond that of a picture in focus, px. Larger
  // accepts defocused pictures, and the glow of lamps.
  double max_blur_px = 1.3;
  // An edge is straight if the rms distance of its contour from a line is at most
  //   straightness_px + 0.8 px * noise / contrast + bend * length.
  // straightness_px is what sampling on pixels leaves over, px. bend allows for a curved surface:
  // 15 mm on a radius of 71 mm, seen at 60 degrees, has 0.007. Larger bridges true corners, smaller
  // breaks noisy or bent edges.
  double straightness_px = 0.06;
  double bend = 0.01;
  // With one edge fewer the worst edge must miss its line by at least this factor more. Larger
  // gives fewer wrong names and fewer names. On a disc more than 3 edges never gain more than 1.8.
  double min_gain = 2.0;
  // Shortest edge, px, and smallest change of direction at a corner, degrees. They keep rounded
  // corners from counting as edges.
  double min_edge_px = 2.5;
  double min_turn_deg = 15.0;
  // Largest rms distance between the corners and the affinely mapped outline of the marker: a part
  // in px (noise) and a part of the marker's size in the picture (perspective, curved surface),
  // added in squares. Infinity for the first leaves the bare count.
  double max_shape_error_px = 0.5;
  double max_shape_error = 0.02;
  // The most oblique view that gets a name, degrees. Larger lets strips pass for markers.
  double max_tilt_deg = 80.0;

  // InputError that names the first parameter out of its range.
  void Check() const;
};

// The bright patterns that lie wholly in the picture, from top to bottom, named if they match a
// marker. Sees nothing but the picture; any size and depth. The same result on any number of
// threads; may be called from several threads at once.
//
// confidence = the smallest margin over all limits that the pattern had to keep: 1 - value / limit
// for an upper limit, 1 - limit / value for a lower one. 0 is a name that just passed, 1 cannot be
// reached. It orders names by how clear they are; it is not a probability.
//
// `debug`: if not null, pictures of each stage are written into that folder (01_picture.png, ...).
std::vector<Detection> IdentifyByEdges(const DigitalImage& image, const MarkerSet& markers,
                                       const EdgesOptions& options,
                                       const std::filesystem::path* debug = nullptr);

}  // namespace retrolux
