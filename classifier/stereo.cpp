#include "classifier/stereo.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace retrolux {

namespace {

class Reconstruction {
 public:
  Reconstruction(const std::vector<CameraView>& views, const Constellation& constellation,
                 const StereoOptions& options)
      : views_(views), constellation_(constellation), options_(options) {
    options_.position.point = options.point;
    for (size_t k = 0; k < constellation.size(); ++k)
      result_.markers.push_back({constellation[k].name, constellation[k].number, k, {}, {}, ""});
    for (const CameraView& view : views) free_.emplace_back(view.detections.size(), true);
  }

  StereoResult Run() {
    NameByShape();
    TriangulateAll();
    RegisterMask();
    if (result_.pose) {
      NameTheRest();
      TriangulateAll();
      RegisterMask();
    }
    return std::move(result_);
  }

 private:
  void NameByShape();
  void TriangulateAll();
  void RegisterMask();
  void NameTheRest();
  StereoMarker* MarkerOfNumber(int number);
  void Assign(StereoMarker& marker, size_t view, size_t detection, bool by_position);

  const std::vector<CameraView>& views_;
  const Constellation& constellation_;
  StereoOptions options_;
  StereoResult result_;
  std::vector<std::vector<bool>> free_;  // by view and detection
};

// The one marker of that number, new if the constellation has none; null if it has several.
StereoMarker* Reconstruction::MarkerOfNumber(int number) {
  StereoMarker* only = nullptr;
  for (StereoMarker& marker : result_.markers) {
    if (marker.number != number) continue;
    if (only) return nullptr;
    only = &marker;
  }
  if (only) return only;
  result_.markers.push_back({fmt::format("marker-{}", number), number, std::nullopt, {}, {}, ""});
  return &result_.markers.back();
}

void Reconstruction::Assign(StereoMarker& marker, size_t view, size_t detection, bool by_position) {
  marker.sightings.push_back({view, detection, by_position});
  free_[view][detection] = false;
}

void Reconstruction::NameByShape() {
  std::map<int, std::vector<std::pair<size_t, size_t>>> once;  // number -> view, detection
  for (size_t v = 0; v < views_.size(); ++v) {
    std::map<int, std::vector<size_t>> of_number;
    for (size_t d = 0; d < views_[v].detections.size(); ++d) {
      if (const auto& number = views_[v].detections[d].marker) of_number[*number].push_back(d);
    }
    for (const auto& [number, detections] : of_number) {
      if (number != 0 && detections.size() == 1) once[number].emplace_back(v, detections.front());
    }
  }
  for (const auto& [number, sightings] : once) {
    StereoMarker* marker = MarkerOfNumber(number);
    if (!marker) continue;
    for (const auto& [view, detection] : sightings) Assign(*marker, view, detection, false);
  }
}

void Reconstruction::TriangulateAll() {
  for (StereoMarker& marker : result_.markers) {
    marker.point.reset();
    if (marker.sightings.size() < 2) {
      marker.refusal = marker.sightings.empty() ? "not seen" : "seen by one camera";
      continue;
    }
    std::vector<Sighting> sightings;
    for (const StereoSighting& s : marker.sightings) {
      const CameraView& view = views_[s.view];
      const Detection& detection = view.detections[s.detection];
      sightings.push_back(
          {&view.camera, PointOf(detection, options_.point),
           options_.sigma_px * RelativeSigma(detection.straight_edges, options_.point)});
    }
    Triangulation triangulation = Triangulate(sightings, options_.triangulation);
    marker.point = std::move(triangulation.point);
    marker.refusal = std::move(triangulation.refusal);
    for (size_t i = 0; i < marker.sightings.size(); ++i) {
      marker.sightings[i].used = marker.point && marker.point->used[i];
      if (marker.point) marker.sightings[i].residual_px = marker.point->residuals_px[i];
    }
  }
}

void Reconstruction::RegisterMask() {
  std::vector<PointPair> pairs;
  result_.pose_markers.clear();
  for (size_t m = 0; m < result_.markers.size(); ++m) {
    const StereoMarker& marker = result_.markers[m];
    if (!marker.known || !marker.point) continue;
    pairs.push_back({constellation_[*marker.known].at, marker.point->position,
                     1.0 / marker.point->covariance.trace()});
    result_.pose_markers.push_back(m);
  }
  PoseEstimate estimate = EstimatePose(pairs, options_.max_residual_mm);
  result_.pose = std::move(estimate.pose);
  result_.pose_refusal = std::move(estimate.refusal);
}

void Reconstruction::NameTheRest() {
  // Of few markers the FRE may be small by chance: no better than their noise lets expect.
  double variance_mm2 = 0.0;
  for (const size_t m : result_.pose_markers) {
    variance_mm2 += result_.markers[m].point->covariance.trace() /
                    static_cast<double>(result_.pose_markers.size());
  }
  const double fle_mm = std::max(result_.pose->fle_mm, std::sqrt(variance_mm2));
  const auto sigma_mm = [&](const Vec3d& x_in_mask) {
    return ExpectedTre_mm(result_.pose->pairs, fle_mm, x_in_mask);
  };
  for (size_t v = 0; v < views_.size(); ++v) {
    std::vector<bool> wanted(constellation_.size(), true);
    for (size_t k = 0; k < constellation_.size(); ++k) {
      for (const StereoSighting& s : result_.markers[k].sightings)
        wanted[k] = wanted[k] && s.view != v;
    }
    const PositionNames names =
        NameByPosition(views_[v].camera, views_[v].detections, free_[v], constellation_, wanted,
                       result_.pose->world_from_mask, sigma_mm, options_.position);
    for (const PositionName& name : names.named)
      Assign(result_.markers[name.marker], v, name.detection, true);
    for (const size_t k : names.ambiguous)
      result_.ambiguous.emplace_back(v, constellation_[k].name);
  }
}

}  // namespace

StereoResult Reconstruct(const std::vector<CameraView>& views, const Constellation& constellation,
                         const StereoOptions& options) {
  if (views.size() < 2) {
    throw InputError(fmt::format("{} cameras; expected at least two to reconstruct", views.size()));
  }
  return Reconstruction(views, constellation, options).Run();
}

}  // namespace retrolux
