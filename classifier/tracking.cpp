#include "classifier/tracking.h"

#include <algorithm>

#include "core/error.h"

namespace retrolux {

namespace {

using State = MarkerTracker::State;

// The only candidate; of several the only one that carries the name.
std::optional<size_t> Choice(const std::vector<size_t>& candidates,
                             const std::vector<Detection>& detections) {
  if (candidates.size() == 1) return candidates.front();
  std::vector<size_t> named;
  for (const size_t d : candidates) {
    if (detections[d].marker) named.push_back(d);
  }
  if (named.size() == 1) return named.front();
  return std::nullopt;
}

// Whether a pattern may be the marker, whose name it carries or whose size it has.
bool MayBe(const Detection& detection, const MarkerTracker::Track& track, double max_ratio) {
  if (detection.marker) return *detection.marker == track.marker.number;
  if (detection.area_px <= 0.0 || track.area_px <= 0.0) return true;
  const double ratio = detection.area_px / track.area_px;
  return ratio < max_ratio && ratio > 1.0 / max_ratio;
}

bool IsFollowed(const MarkerTracker::Track& track) {
  return track.state == State::kTracked || track.state == State::kMissed;
}

}  // namespace

MarkerTracker::MarkerTracker(std::vector<TrackedMarker> markers, const TrackingOptions& options)
    : options_(options) {
  for (TrackedMarker& marker : markers) {
    const bool again = std::any_of(tracks_.begin(), tracks_.end(), [&](const Track& track) {
      return track.marker.number == marker.number;
    });
    RETROLUX_CHECK(marker.number > 0 && !again, "marker '{}', number {}", marker.name,
                   marker.number);
    tracks_.emplace_back().marker = std::move(marker);
  }
}

const std::vector<MarkerTracker::Track>& MarkerTracker::Next(
    const std::vector<Detection>& detections) {
  Predict();
  Follow(detections);
  Acquire(detections);
  return tracks_;
}

void MarkerTracker::Predict() {
  for (Track& track : tracks_) {
    track.detection.reset();
    track.identified = false;
    if (!IsFollowed(track)) continue;
    track.px += track.px_per_frame;
    ++track.missed;
  }
}

void MarkerTracker::Follow(const std::vector<Detection>& detections) {
  std::vector<int> wanted(detections.size());
  std::vector<std::vector<size_t>> candidates(tracks_.size());
  for (size_t t = 0; t < tracks_.size(); ++t) {
    const Track& track = tracks_[t];
    if (!IsFollowed(track)) continue;
    for (size_t d = 0; d < detections.size(); ++d) {
      if (!MayBe(detections[d], track, options_.max_area_ratio)) continue;
      const double off_px = (PointOf(detections[d], options_.point) - track.px).norm();
      if (off_px > options_.gate_px * track.missed) continue;
      candidates[t].push_back(d);
      ++wanted[d];
    }
  }
  for (size_t t = 0; t < tracks_.size(); ++t) {
    Track& track = tracks_[t];
    if (!IsFollowed(track)) continue;
    const std::optional<size_t> choice = Choice(candidates[t], detections);
    if (choice && (detections[*choice].marker || wanted[*choice] == 1)) {
      See(track, detections, *choice);
    } else {
      track.state = track.missed > options_.max_missed ? State::kLost : State::kMissed;
    }
  }
}

// Markers that are not followed, or not found where they were expected, by their name.
void MarkerTracker::Acquire(const std::vector<Detection>& detections) {
  for (Track& track : tracks_) {
    if (track.detection) continue;
    std::vector<size_t> named;
    for (size_t d = 0; d < detections.size(); ++d) {
      if (detections[d].marker == track.marker.number) named.push_back(d);
    }
    if (named.size() != 1) continue;
    if (track.state == State::kLost) ++track.reacquired;
    track.px = PointOf(detections[named.front()], options_.point);
    track.px_per_frame.setZero();
    See(track, detections, named.front());
  }
}

void MarkerTracker::See(Track& track, const std::vector<Detection>& detections, size_t detection) {
  const double beta = options_.alpha * options_.alpha / (2.0 - options_.alpha);
  const Vec2d off = PointOf(detections[detection], options_.point) - track.px;
  track.px += options_.alpha * off;
  track.px_per_frame += beta / std::max(track.missed, 1) * off;
  track.detection = detection;
  track.area_px = detections[detection].area_px;
  track.identified = detections[detection].marker.has_value();
  track.missed = 0;
  track.state = State::kTracked;
}

}  // namespace retrolux
