// Markers followed from picture to picture of one camera (the thesis's tracking step, section
// 3.3.1): identification gives a marker its name once; from then on it is the detection nearest to
// where it is expected, named or not, until it is lost. Lost markers come back by identification.
//
// Expected is a constant velocity, estimated by an alpha-beta filter (Kalata, IEEE AES 20(2), 1984;
// beta = alpha^2 / (2 - alpha), Benedict and Bordner, IRE AC-7(4), 1962). The filter makes
// predictions only: what is reported is the detection itself, so that tracking delays nothing.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "classifier/marker_point.h"

namespace retrolux {

struct TrackingOptions {
  MarkerPoint point = MarkerPoint::kCentre;
  // How far from the prediction a marker may be, px: noise, and half of what the largest
  // acceleration does in a frame. Grows by as much with each frame without the marker. Larger
  // follows faster motion, and confuses neighbours.
  double gate_px = 4.0;
  // Of the area of an unnamed pattern over the marker's when it was last seen, or the other way
  // round: what hides a marker is a pattern, too, and just where the marker should be.
  double max_area_ratio = 1.5;
  int max_missed = 5;   // frames without the marker after which it is lost
  double alpha = 0.85;  // trust in a new position, 0 to 1
};

// A marker to be followed: its name, and the number that identifies it.
struct TrackedMarker {
  std::string name;
  int number = 1;  // not 0: nothing identifies a standard marker but its position
};

class MarkerTracker {
 public:
  enum class State { kUnseen, kTracked, kMissed, kLost };

  struct Track {
    TrackedMarker marker;
    State state = State::kUnseen;
    std::optional<size_t> detection;  // of the last picture
    bool identified = false;          // whether that detection carries the name
    int missed = 0;                   // frames since it was seen
    int reacquired = 0;               // how many times it came back after being lost
    Vec2d px = Vec2d::Zero();         // filtered; the prediction while it is missed
    Vec2d px_per_frame = Vec2d::Zero();
    double area_px = 0.0;  // when it was last seen; 0: not known
  };

  // Numbers must differ, and be above 0.
  MarkerTracker(std::vector<TrackedMarker> markers, const TrackingOptions& options);

  // The next picture. Of the detections within a track's gate that carry no other marker's name it
  // gets the only one, if no other track could have it; of several the only one that carries its
  // name. Else it is missed, unless just one detection of the whole picture carries its name.
  const std::vector<Track>& Next(const std::vector<Detection>& detections);
  const std::vector<Track>& Tracks() const { return tracks_; }

 private:
  void Predict();
  void Follow(const std::vector<Detection>& detections);
  void Acquire(const std::vector<Detection>& detections);
  void See(Track& track, const std::vector<Detection>& detections, size_t detection);

  TrackingOptions options_;
  std::vector<Track> tracks_;
};

}  // namespace retrolux
