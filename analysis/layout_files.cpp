#include <nlohmann/json.hpp>

#include "analysis/layout_study.h"
#include "core/atomic_file.h"
#include "core/csv.h"

namespace retrolux {

namespace {

using Json = nlohmann::json;

std::string OrEmpty(const std::optional<double>& value) {
  return value ? fmt::format("{:.5f}", *value) : "";
}

void WriteSightings(const LayoutStudy& study, const std::filesystem::path& file) {
  CsvWriter csv({"pose", "camera", "marker", "incidence_deg", "visible_fraction", "named"});
  for (size_t p = 0; p < study.sightings.size(); ++p) {
    for (size_t c = 0; c < study.cameras.size(); ++c) {
      for (const LayoutSighting& s : study.sightings[p][c]) {
        csv.Row({study.options.poses[p].name, study.cameras[c], std::to_string(s.marker),
                 fmt::format("{:.3f}", s.incidence_deg), fmt::format("{:.4f}", s.visible_fraction),
                 s.named ? std::to_string(*s.named) : ""});
      }
    }
  }
  csv.Write(file);
}

void WritePairs(const LayoutStudy& study, const std::filesystem::path& file) {
  CsvWriter csv({"pose", "camera_a", "camera_b", "separation_deg", "common", "markers", "best",
                 "expected_tre_mm", "position_error_mm", "rotation_error_deg"});
  for (const LayoutPair& pair : study.pairs) {
    csv.Row({study.options.poses[pair.pose].name, study.cameras[pair.a], study.cameras[pair.b],
             fmt::format("{:.3f}", pair.separation_deg), std::to_string(pair.common.size()),
             fmt::format("{}", fmt::join(pair.common, " ")),
             &study.Best(pair.pose) == &pair ? "1" : "0",
             pair.common.size() < 3 ? "" : fmt::format("{:.5f}", pair.expected_tre_mm),
             OrEmpty(pair.position_error_mm), OrEmpty(pair.rotation_error_deg)});
  }
  csv.Write(file);
}

}  // namespace

Json LayoutSummary(const LayoutStudy& study) {
  Json markers = Json::array();
  for (const MarkerSpec& m : study.markers) {
    markers.push_back({{"name", m.name},
                       {"number", m.number},
                       {"at_mm", {m.at.x(), m.at.y(), m.at.z()}},
                       {"roll_deg", m.roll_deg}});
  }
  Json poses = Json::array();
  for (size_t p = 0; p < study.options.poses.size(); ++p) {
    const LayoutPair& best = study.Best(p);
    const auto enough = std::count_if(
        study.pairs.begin(), study.pairs.end(),
        [&](const LayoutPair& pair) { return pair.pose == p && pair.common.size() >= 3; });
    const auto or_null = [](const std::optional<double>& v) { return v ? Json(*v) : Json(); };
    poses.push_back({{"pose", study.options.poses[p].name},
                     {"z_mm", study.options.poses[p].translation.z()},
                     {"pair", {study.cameras[best.a], study.cameras[best.b]}},
                     {"separation_deg", best.separation_deg},
                     {"common", best.common},
                     {"pairs_with_three", enough},
                     {"position_error_mm", or_null(best.position_error_mm)},
                     {"rotation_error_deg", or_null(best.rotation_error_deg)}});
  }
  return {
      {"schema", "retrolux/layout-study-1"},
      {"version", RETROLUX_VERSION},
      {"units", "mm, deg"},
      {"pixel_origin", "center"},
      {"scene", study.scene},
      {"mask", study.options.mask},
      {"method", study.options.method},
      {"material", study.options.material},
      {"spp", study.options.samples_per_pixel},
      {"seed", study.options.seed},
      {"max_incidence_deg", study.options.layout.sight.max_incidence_deg},
      {"max_fall", study.options.layout.sight.max_fall},
      {"min_separation_deg", study.options.layout.min_separation_deg},
      {"markers", markers},
      {"promised",
       {{"least_common", study.found.least_common}, {"worst_tre_mm", study.found.worst_tre_mm}}},
      {"margin", study.Margin()},
      {"misnamed", study.misnamed},
      {"poses", poses}};
}

void WriteLayoutFiles(const LayoutStudy& study, const std::filesystem::path& folder) {
  WriteSightings(study, folder / "sightings.csv");
  WritePairs(study, folder / "pairs.csv");
  WriteTextFile(folder / "layout.json", LayoutSummary(study).dump(2) + "\n");
}

}  // namespace retrolux
