#include <fmt/format.h>

#include "analysis/motion_study.h"
#include "core/atomic_file.h"
#include "core/csv.h"

namespace retrolux {

namespace {

using nlohmann::json;

std::string Number(double value) {
  return fmt::format("{:.5f}", value);
}

void AddVector(const std::optional<Vec3d>& v, std::vector<std::string>& cells) {
  for (Eigen::Index i = 0; i < 3; ++i) cells.push_back(v ? Number((*v)[i]) : "");
  cells.push_back(v ? Number(v->norm()) : "");
}

std::vector<std::string> Columns(size_t markers) {
  std::vector<std::string> columns = {
      "frame",    "time_s",         "true_x_mm",  "true_y_mm",  "true_z_mm",
      "true_mm",  "found_x_mm",     "found_y_mm", "found_z_mm", "found_mm",
      "error_mm", "turn_error_deg", "alarm",      "markers",    "followed_without_name"};
  for (const char* camera : {"left", "right"}) {
    for (size_t n = 1; n <= markers; ++n) columns.push_back(fmt::format("{}_marker_{}", camera, n));
  }
  return columns;
}

json Maybe(double value) {
  return value < 0.0 ? json(nullptr) : json(value);
}

}  // namespace

json MotionSummary(const MotionStudy& study) {
  const MotionStudyOptions& options = study.options;
  json outcomes = json::array();
  for (const HiddenOutcome& outcome : study.outcomes) {
    outcomes.push_back({{"marker", outcome.hidden.number},
                        {"first_frame", outcome.hidden.first},
                        {"last_frame", outcome.hidden.last},
                        {"lost", outcome.lost},
                        {"back_after_frames", Maybe(outcome.back_after_frames)},
                        {"by_name", outcome.by_name}});
  }
  const bool alarm = study.alarm_s >= 0.0 && study.crossing_s >= 0.0;
  return {{"schema", "retrolux/motion-study-1"},
          {"version", RETROLUX_VERSION},
          {"units", "mm, deg, s"},
          {"pixel_origin", "center"},
          {"seed", options.shot.seed},
          {"spp", options.shot.samples_per_pixel},
          {"frames", options.frames},
          {"frames_per_s", options.frames_per_s},
          {"psi_deg", options.psi_deg},
          {"limit_mm", options.limit_mm},
          {"rms_error_mm", study.rms_error_mm},
          {"max_error_mm", study.max_error_mm},
          {"bias_mm", study.bias_mm},
          {"crossing_s", Maybe(study.crossing_s)},
          {"alarm_s", Maybe(study.alarm_s)},
          {"latency_ms", alarm ? json(1e3 * (study.alarm_s - study.crossing_s)) : json(nullptr)},
          {"false_alarm_frames", study.false_alarms},
          {"missed_alarm_frames", study.missed_alarms},
          {"hidden", outcomes}};
}

void WriteMotionFiles(const MotionStudy& study, const std::filesystem::path& folder) {
  CsvWriter table(Columns(study.frames.front().states[0].size()));
  for (size_t f = 0; f < study.frames.size(); ++f) {
    const MotionFrame& frame = study.frames[f];
    std::vector<std::string> cells = {std::to_string(f), Number(frame.time_s)};
    AddVector(frame.true_mm, cells);
    AddVector(frame.found_mm, cells);
    cells.push_back(frame.found_mm ? Number((*frame.found_mm - frame.true_mm).norm()) : "");
    cells.push_back(frame.found_mm ? Number(frame.turn_error_deg) : "");
    cells.push_back(frame.alarm ? "1" : "0");
    cells.push_back(std::to_string(frame.markers));
    cells.push_back(std::to_string(frame.followed_without_name));
    for (const auto& states : frame.states) {
      for (const MarkerTracker::State state : states) cells.emplace_back(NameOf(state));
    }
    table.Row(cells);
  }
  table.Write(folder / "motion.csv");
  WriteTextFile(folder / "summary.json", MotionSummary(study).dump(2) + "\n");
}

}  // namespace retrolux
