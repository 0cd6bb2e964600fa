// Which point of a marker's image stands for the marker in space.
#pragma once

#include "classifier/detection.h"

namespace retrolux {

// kCentre: the middle of the shape's area by the fit, where the method knows it, else the centroid:
// on curved masks without the bias that falling light and foreshortening give centroids.
// kLight: the centroid always, as systems have it that know nothing of the marker's shape.
enum class MarkerPoint { kCentre, kLight };

// How uncertain that point is, relative to others. How far a curved surface bends a shape can be
// told from how its corners lie to one another if it has five or more; a triangle, a quadrilateral
// and an ellipse stay what they are, so that a part of the bend goes into the fitted middle: 0.10
// to 0.17 px instead of 0.02 to 0.03 on a radius of 100 mm (docs/stereo.md).
inline double RelativeSigma(int straight_edges, MarkerPoint point) {
  constexpr int kTellsBend = 5;
  constexpr double kBendHidden = 5.0;
  return point == MarkerPoint::kCentre && straight_edges < kTellsBend ? kBendHidden : 1.0;
}

inline Vec2d PointOf(const Detection& detection, MarkerPoint point) {
  return point == MarkerPoint::kCentre ? detection.centre_px.value_or(detection.centroid_px)
                                       : detection.centroid_px;
}

}  // namespace retrolux
