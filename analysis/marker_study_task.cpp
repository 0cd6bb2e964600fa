#include "analysis/marker_study_task.h"

#include <algorithm>
#include <chrono>
#include <mutex>

#include "core/atomic_file.h"
#include "core/hash.h"
#include "core/image_file.h"
#include "renderer/render_files.h"
#include "renderer/sensor.h"

namespace retrolux {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

using Clock = std::chrono::steady_clock;

double Since(Clock::time_point& last) {
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - last).count();
  last = now;
  return seconds;
}

// Light that went over another surface first is a few per cent of the signal here: half the paths
// for it do.
constexpr float kRoulette = 0.5f;

// A pattern belongs to the marker if its centroid lies this close to the marker's outline, px.
constexpr double kMatchMargin_px = 2.0;

const Detection* DetectionAt(const std::vector<Detection>& detections, const Polygon& outline_px) {
  if (outline_px.size() < 3) return nullptr;
  const Polygon hull = ConvexHull(outline_px);
  const Vec2d centre = Centroid(hull);
  const Detection* nearest = nullptr;
  for (const Detection& detection : detections) {
    const Vec2d inwards = (centre - detection.centroid_px).normalized() * kMatchMargin_px;
    const bool near =
        Contains(hull, detection.centroid_px) || Contains(hull, detection.centroid_px + inwards);
    if (!near) continue;
    if (!nearest ||
        (detection.centroid_px - centre).norm() < (nearest->centroid_px - centre).norm())
      nearest = &detection;
  }
  return nearest;
}

// Nothing if a picture has to be made to know.
std::optional<Outcome> OutcomeByGeometry(const MarkerView& view) {
  if (view.visible_fraction > 0.0) return std::nullopt;
  if (view.in_frame_fraction <= 0.0) return Outcome::kOutsidePicture;
  if (view.facing_fraction <= 0.0) return Outcome::kFacingAway;
  return Outcome::kHidden;
}

Outcome OutcomeOfPicture(int marker, const MarkerView& view, const Detection* found,
                         double min_area_px) {
  if (found && found->marker == marker) return Outcome::kHit;
  if (!view.in_frame) return Outcome::kOutsidePicture;
  if (view.visible_fraction < 0.5) return Outcome::kHidden;
  if (!found && std::abs(SignedArea(view.outline_px)) * view.visible_fraction < min_area_px)
    return Outcome::kTooSmall;
  return found ? Outcome::kWrongNumber : Outcome::kNotDetected;
}

std::string PictureName(const MarkerStudy& study, const PictureResult& result) {
  return fmt::format("marker{}_{}_{}_r{:02}_c{:02}{}", result.marker,
                     study.poses[static_cast<size_t>(result.pose)].name,
                     study.cameras[static_cast<size_t>(result.camera)], result.position.row,
                     result.position.col, result.position.mirrored ? "m" : "");
}

std::string PictureFile(const MarkerStudy& study, const PictureResult& result) {
  return fmt::format("pictures/{}.png", PictureName(study, result));
}

std::string FileHash(const fs::path& file) {
  return HexHash(HashBytes(ReadTextFile(file)));
}

// The room with the patient in place, and one camera in it.
class PosedCamera {
 public:
  PosedCamera(const Scene& room, const MarkerStudy& study, int pose, int camera,
              const fs::path& folder)
      : study_(study),
        pose_(pose),
        index_(camera),
        folder_(folder),
        scene_(room.AtPose(study.poses[static_cast<size_t>(pose)])),
        rays_(scene_),
        camera_(scene_, rays_, scene_.cameras[static_cast<size_t>(camera)], RingChoice::kAll,
                Tracing(), NoProgress()),
        sensor_(camera_.Camera()) {}

  // The picture of a marker at a position: made, decided and, if the options say so, kept.
  PictureResult Picture(int marker, const GridPosition& position) {
    Clock::time_point clock = Clock::now();
    MarkerStudy::Times times;
    int64_t retraced = 0;
    const PlacedMarker placed = Place(marker, position);
    const MarkerSurface surface = SampleMarkerSurface(rays_, placed);
    PictureResult result{marker, pose_, index_,           position, surface.centre,
                         0.0,    0.0,   Outcome::kHidden, {},       false};
    const MarkerView view = ViewMarker(surface, rays_, camera_.Camera().model);
    result.incidence_deg = view.incidence_deg;
    result.visible_fraction = view.visible_fraction;
    const std::optional<Outcome> decided = OutcomeByGeometry(view);
    times.geometry += Since(clock);
    if (decided) {
      result.outcome = *decided;
    } else {
      const FloatPlane signal = camera_.Signal(placed, surface, &retraced);
      times.trace += Since(clock);
      const DigitalImage picture = Expose(signal, result);
      times.sensor += Since(clock);
      Identify(picture, view, result);
      times.identify += Since(clock);
      if (ToBeKept(result)) Write(picture, result);
      times.write += Since(clock);
    }
    Account(times, retraced);
    return result;
  }

  // What the study's method and `edges` say of a picture.
  void Identify(const DigitalImage& picture, const MarkerView& view, PictureResult& result) const {
    const MarkerStudyOptions& options = study_.options;
    const std::vector<Detection> by_edges =
        IdentifyByEdges(picture, DefaultMarkerSet(), options.edges);
    const Detection* edges = DetectionAt(by_edges, view.outline_px);
    result.edges_hit = edges && edges->marker == result.marker;
    const bool robust = options.method == kRobustMethod;
    const std::vector<Detection> by_robust =
        robust ? IdentifyRobustly(picture, DefaultMarkerSet(), options.robust)
               : std::vector<Detection>();
    const Detection* here = robust ? DetectionAt(by_robust, view.outline_px) : edges;
    if (here) result.detected = here->marker;
    result.outcome = OutcomeOfPicture(
        result.marker, view, here, robust ? options.robust.min_area_px : options.edges.min_area_px);
  }

  // Whether --keep all or misses asks for it.
  bool ToBeKept(const PictureResult& result) const {
    if (result.visible_fraction <= 0.0) return false;  // was never made
    return study_.options.keep == Keep::kAll ||
           (study_.options.keep == Keep::kMisses && result.outcome != Outcome::kHit);
  }

  // Makes a picture again, bit for bit, from what names it.
  void WriteAgain(const PictureResult& result) const {
    const PlacedMarker placed = Place(result.marker, result.position);
    Write(Expose(camera_.Signal(placed, SampleMarkerSurface(rays_, placed)), result), result);
  }

  // Of all pictures so far.
  const MarkerStudy::Times& Times() const { return times_; }
  int64_t RetracedPixels() const { return retraced_pixels_; }

 private:
  TraceOptions Tracing() const {
    TraceOptions trace;
    trace.samples_per_pixel = study_.options.samples_per_pixel;
    trace.own_ray_share = kStrongGroups;
    trace.roulette = kRoulette;
    trace.seed =
        CombineKeys(study_.options.seed, HashBytes(study_.poses[static_cast<size_t>(pose_)].name));
    return trace;
  }

  PlacedMarker Place(int marker, const GridPosition& position) const {
    MarkerSpec spec{"marker", marker, "mask", marker_grid::Point(position)};
    spec.material = study_.options.material;
    return PlaceMarker(scene_, spec, 1);
  }

  DigitalImage Expose(const FloatPlane& signal, const PictureResult& result) const {
    return sensor_.Expose(signal, camera_.ExposureSeconds(),
                          NoiseKey(study_.options.noise_seed, PictureName(study_, result)));
  }

  void Write(const DigitalImage& picture, const PictureResult& result) const {
    WritePng(folder_ / PictureFile(study_, result), picture);
  }

  void Account(const MarkerStudy::Times& times, int64_t retraced) {
    const std::lock_guard lock(mutex_);
    times_ += times;
    retraced_pixels_ += retraced;
  }

  const MarkerStudy& study_;
  int pose_, index_;
  fs::path folder_;
  Scene scene_;
  RayScene rays_;
  ComposedCamera camera_;
  Sensor sensor_;
  std::mutex mutex_;
  MarkerStudy::Times times_;
  int64_t retraced_pixels_ = 0;
};

using Kept = MarkerStudyTaskResult::Kept;

// The pictures that show where hits begin and end.
std::vector<Kept> Samples(const std::vector<PictureResult>& pictures) {
  const PictureResult* frontal = nullptr;
  const PictureResult* oblique = nullptr;
  const PictureResult* rim = nullptr;
  const PictureResult* last_hit = nullptr;
  const PictureResult* first_miss = nullptr;
  const auto closer = [](const PictureResult& a, const PictureResult* b, double deg) {
    return !b || std::abs(a.incidence_deg - deg) < std::abs(b->incidence_deg - deg);
  };
  for (const PictureResult& r : pictures) {
    if (r.position.mirrored || r.visible_fraction < 0.999) continue;
    if (closer(r, frontal, 0.0)) frontal = &r;
    if (closer(r, oblique, 45.0)) oblique = &r;
    if (closer(r, rim, 80.0)) rim = &r;
    if (r.outcome == Outcome::kHit && closer(r, last_hit, 90.0)) last_hit = &r;
    if (r.outcome != Outcome::kHit && closer(r, first_miss, 0.0)) first_miss = &r;
  }
  const std::pair<const PictureResult*, const char*> chosen[] = {{frontal, "frontal"},
                                                                 {oblique, "oblique"},
                                                                 {rim, "rim"},
                                                                 {last_hit, "last hit"},
                                                                 {first_miss, "first miss"}};
  std::vector<Kept> samples;
  for (const auto& [picture, kind] : chosen) {
    if (picture) samples.push_back({static_cast<size_t>(picture - pictures.data()), kind, "", ""});
  }
  return samples;
}

Outcome OutcomeByName(const std::string& name) {
  for (int i = 0; i < kOutcomes; ++i) {
    if (name == OutcomeName(static_cast<Outcome>(i))) return static_cast<Outcome>(i);
  }
  throw InputError(fmt::format("the outcome '{}' of a task; expected one of hits.csv", name));
}

// What stands in a row of a result, in this order.
const Json& Columns() {
  static const Json columns = {"marker",   "row",           "col",
                               "mirrored", "x_mm",          "y_mm",
                               "z_mm",     "incidence_deg", "visible_fraction",
                               "outcome",  "detected",      "edges_hit"};
  return columns;
}

Json RowOf(const PictureResult& r) {
  return {r.marker,
          r.position.row,
          r.position.col,
          r.position.mirrored,
          r.position_in_world.x(),
          r.position_in_world.y(),
          r.position_in_world.z(),
          r.incidence_deg,
          r.visible_fraction,
          OutcomeName(r.outcome),
          r.detected ? Json(*r.detected) : Json(),
          r.edges_hit};
}

PictureResult PictureOf(const Json& row, int pose, int camera) {
  PictureResult r;
  r.marker = row.at(0).get<int>();
  r.pose = pose;
  r.camera = camera;
  r.position = {row.at(1).get<int>(), row.at(2).get<int>(), row.at(3).get<bool>()};
  r.position_in_world = {row.at(4).get<double>(), row.at(5).get<double>(), row.at(6).get<double>()};
  r.incidence_deg = row.at(7).get<double>();
  r.visible_fraction = row.at(8).get<double>();
  r.outcome = OutcomeByName(row.at(9).get<std::string>());
  if (!row.at(10).is_null()) r.detected = row.at(10).get<int>();
  r.edges_hit = row.at(11).get<bool>();
  return r;
}

}  // namespace

Json MarkerStudyTaskResult::ToJson() const {
  Json rows = Json::array();
  for (const PictureResult& picture : pictures) rows.push_back(RowOf(picture));
  Json list = Json::array();
  for (const Kept& k : kept) {
    list.push_back({{"picture", k.picture}, {"kind", k.kind}, {"file", k.file}, {"hash", k.hash}});
  }
  return {{"columns", Columns()},
          {"pictures", rows},
          {"kept", list},
          {"retraced_pixels", retraced_pixels}};
}

MarkerStudyTaskResult MarkerStudyTaskResult::FromJson(const Json& json, int pose, int camera) {
  MarkerStudyTaskResult result;
  for (const Json& row : json.at("pictures"))
    result.pictures.push_back(PictureOf(row, pose, camera));
  for (const Json& k : json.at("kept")) {
    result.kept.push_back({k.at("picture").get<size_t>(), k.at("kind").get<std::string>(),
                           k.at("file").get<std::string>(), k.at("hash").get<std::string>()});
  }
  result.retraced_pixels = json.at("retraced_pixels").get<int64_t>();
  return result;
}

bool KeptPicturesAreThere(const Json& result, const fs::path& folder) {
  return std::all_of(result.at("kept").begin(), result.at("kept").end(), [&](const Json& kept) {
    const fs::path file = folder / kept.at("file").get<std::string>();
    return fs::is_regular_file(file) && FileHash(file) == kept.at("hash").get<std::string>();
  });
}

MarkerStudyTaskResult RunMarkerStudyTask(const Scene& room, const MarkerStudy& study, int pose,
                                         int camera, const std::vector<GridPosition>& positions,
                                         const fs::path& folder, Progress& progress,
                                         MarkerStudy::Times& times) {
  Clock::time_point clock = Clock::now();
  PosedCamera posed(room, study, pose, camera, folder);
  times.background += Since(clock);

  const std::vector<int>& markers = study.options.markers;
  MarkerStudyTaskResult result;
  result.pictures.resize(markers.size() * positions.size());
  ParallelFor(static_cast<int64_t>(result.pictures.size()), [&](int64_t index) {
    const auto i = static_cast<size_t>(index);
    result.pictures[i] =
        posed.Picture(markers[i / positions.size()], positions[i % positions.size()]);
    progress.Advance(1);
  });
  for (size_t i = 0; i < result.pictures.size(); ++i) {
    if (posed.ToBeKept(result.pictures[i])) result.kept.push_back({i, "", "", ""});
  }
  if (study.options.keep == Keep::kSamples) {
    result.kept = Samples(result.pictures);
    for (const Kept& kept : result.kept) posed.WriteAgain(result.pictures[kept.picture]);
  }
  for (Kept& kept : result.kept) {
    kept.file = PictureFile(study, result.pictures[kept.picture]);
    kept.hash = FileHash(folder / kept.file);
  }
  result.retraced_pixels = posed.RetracedPixels();
  times.pictures += Since(clock);
  times += posed.Times();
  return result;
}

}  // namespace retrolux
