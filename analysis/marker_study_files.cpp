#include "analysis/marker_coverage.h"
#include "analysis/marker_study_gain.h"
#include "core/atomic_file.h"
#include "core/csv.h"

namespace retrolux {

namespace {

std::string Detected(const PictureResult& result) {
  if (!result.detected) return "";
  return *result.detected == 0 ? "standard" : std::to_string(*result.detected);
}

void WriteHits(const MarkerStudy& study, const std::filesystem::path& file) {
  CsvWriter csv({"marker", "pose", "camera", "row", "col", "x_mm", "y_mm", "z_mm", "incidence_deg",
                 "visible_fraction", "hit", "detected", "reason", "edges_hit"});
  for (const PictureResult& r : study.results) {
    const bool hit = r.outcome == Outcome::kHit;
    csv.Row({std::to_string(r.marker), study.poses[static_cast<size_t>(r.pose)].name,
             study.cameras[static_cast<size_t>(r.camera)], std::to_string(r.position.row),
             std::to_string(r.position.col), fmt::format("{:.3f}", r.position_in_world.x()),
             fmt::format("{:.3f}", r.position_in_world.y()),
             fmt::format("{:.3f}", r.position_in_world.z()), fmt::format("{:.3f}", r.incidence_deg),
             fmt::format("{:.4f}", r.visible_fraction), hit ? "1" : "0", Detected(r),
             hit ? "" : OutcomeName(r.outcome), r.edges_hit ? "1" : "0"});
  }
  csv.Write(file);
}

void WriteCoverage(const MarkerStudy& study, const StudyCoverage& coverage,
                   const std::filesystem::path& file) {
  CsvWriter csv({"marker", "pose", "row", "col", "cameras_hit", "satisfies"});
  for (const int marker : study.options.markers) {
    for (int p = 0; p < static_cast<int>(study.poses.size()); ++p) {
      for (const PictureResult& r : study.results) {
        if (r.marker != marker || r.pose != p || r.camera != 0) continue;
        const int hits = coverage.CamerasHit(marker, p, r.position.row, r.position.col);
        csv.Row({std::to_string(marker), study.poses[static_cast<size_t>(p)].name,
                 std::to_string(r.position.row), std::to_string(r.position.col),
                 std::to_string(hits), hits >= 2 ? "1" : "0"});
      }
    }
  }
  csv.Write(file);
}

// The largest incidence angle of a hit, by camera.
nlohmann::json LastHits(const MarkerStudy& study) {
  nlohmann::json limits = nlohmann::json::object();
  for (size_t c = 0; c < study.cameras.size(); ++c) {
    double last = 0.0;
    int hits = 0;
    for (const PictureResult& r : study.results) {
      if (r.camera != static_cast<int>(c) || r.outcome != Outcome::kHit) continue;
      last = std::max(last, r.incidence_deg);
      ++hits;
    }
    limits[study.cameras[c]] = {{"hits", hits}, {"largest_incidence_deg", last}};
  }
  return limits;
}

}  // namespace

nlohmann::json StudySummary(const MarkerStudy& study, const StudyCoverage& coverage) {
  nlohmann::json sets = nlohmann::json::array();
  for (const CellSet& set : coverage.Sets()) {
    sets.push_back({{"marker", set.marker},
                    {"pose", set.pose.empty() ? nlohmann::json(nullptr) : nlohmann::json(set.pose)},
                    {"set", set.name},
                    {"area_mm2", set.area_mm2},
                    {"area_pct", set.percent}});
  }
  nlohmann::json reasons = nlohmann::json::object();
  for (int i = 0; i < kOutcomes; ++i) {
    const auto outcome = static_cast<Outcome>(i);
    reasons[OutcomeName(outcome)] =
        std::count_if(study.results.begin(), study.results.end(),
                      [&](const PictureResult& r) { return r.outcome == outcome; });
  }
  nlohmann::json kept = nlohmann::json::array();
  for (const KeptPicture& picture : study.kept) {
    const PictureResult& r = picture.result;
    kept.push_back({{"file", picture.file},
                    {"kind", picture.kind},
                    {"marker", r.marker},
                    {"pose", study.poses[static_cast<size_t>(r.pose)].name},
                    {"camera", study.cameras[static_cast<size_t>(r.camera)]},
                    {"incidence_deg", r.incidence_deg},
                    {"outcome", OutcomeName(r.outcome)}});
  }
  const SymmetryCheck symmetry = CheckSymmetry(study);
  const std::optional<MethodGain> gain = GainOverEdges(study, coverage);
  return {{"schema", "retrolux/marker-study-1"},
          {"version", RETROLUX_VERSION},
          {"units", "mm, deg"},
          {"pixel_origin", "center"},
          {"face_half_mm2", marker_grid::FaceHalfArea_mm2()},
          {"positions", study.results.size() / (study.cameras.size() * study.poses.size() *
                                                study.options.markers.size())},
          {"pictures", study.results.size()},
          {"pictures_rendered", study.composed},
          {"stride", study.options.stride},
          {"spp", study.options.samples_per_pixel},
          {"seed", study.options.seed},
          {"noise_seed", study.options.noise_seed},
          {"method", study.options.method},
          {"gain_over_edges", gain ? ToJson(*gain) : nlohmann::json(nullptr)},
          {"material", study.options.material},
          {"sets", sets},
          {"outcomes", reasons},
          {"cameras", LastHits(study)},
          {"kept", kept},
          {"symmetry", {{"pictures", symmetry.pictures}, {"agree", symmetry.agree}}}};
}

void WriteStudyFiles(const MarkerStudy& study, const StudyCoverage& coverage,
                     const std::filesystem::path& folder) {
  WriteHits(study, folder / "hits.csv");
  WriteCoverage(study, coverage, folder / "coverage.csv");
  WriteTextFile(folder / "summary.json", StudySummary(study, coverage).dump(2) + "\n");
}

}  // namespace retrolux
