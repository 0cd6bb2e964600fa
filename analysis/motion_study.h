// A patient watched by two cameras: markers followed from frame to frame, the mask's displacement
// over time, an alarm where it passes a limit, and a marker that is hidden and comes back.
#pragma once

#include <filesystem>

#include "analysis/motion_profile.h"
#include "analysis/stereo_bench.h"
#include "classifier/stereo.h"
#include "classifier/tracking.h"
#include "core/task_manifest.h"

namespace retrolux {

// Frames in which a plate stands before a marker in the left camera's view.
struct HiddenFrames {
  int number = 0;  // of the marker
  int first = 0, last = 0;
};

struct MotionStudyOptions {
  int frames = 64;
  double frames_per_s = 12.5;
  double psi_deg = 40.0;  // separation of the cameras
  double limit_mm = 1.0;  // of the displacement at the mask's origin
  MotionProfile profile;
  // Shorter and longer than TrackingOptions::max_missed.
  std::vector<HiddenFrames> hidden = {{5, 8, 11}, {3, 20, 32}};
  StereoShotOptions shot = {.samples_per_pixel = 6, .exposures = 1};
  TrackingOptions tracking;
};

struct MotionFrame {
  double time_s = 0.0;
  Vec3d true_mm = Vec3d::Zero();  // displacement of the origin
  std::optional<Vec3d> found_mm;  // nothing: no pose
  double turn_error_deg = 0.0;    // of the pose
  bool alarm = false;             // |found| above the limit
  int markers = 0;                // that the pose rests on
  // By camera and marker (by number, from 1).
  std::array<std::vector<MarkerTracker::State>, 2> states;
  int followed_without_name = 0;  // sightings that tracking kept and identification had not named
};

// What became of a marker that was hidden.
struct HiddenOutcome {
  HiddenFrames hidden;
  bool lost = false;           // not only missed
  int back_after_frames = -1;  // from the first frame in which it was free again; -1: never
  bool by_name = false;        // re-acquired by identification
};

struct MotionStudy {
  MotionStudyOptions options;
  std::vector<MotionFrame> frames;
  double crossing_s = -1.0;  // of the true displacement; negative: never
  double alarm_s = -1.0;     // time of the frame that raises the alarm
  int false_alarms = 0;      // frames with an alarm while the truth is below the limit
  int missed_alarms = 0;     // the other way round
  double rms_error_mm = 0.0, max_error_mm = 0.0, bias_mm = 0.0;
  double identify_ms = 0.0;  // mean for a picture, time of one core
  std::vector<HiddenOutcome> outcomes;
  std::vector<std::string> pictures;  // kept, below the folder
  TaskReport tasks;
};

MotionStudy RunMotionStudy(const MotionStudyOptions& options, const std::filesystem::path& folder,
                           Progress& progress);

// motion.csv, summary.json.
nlohmann::json MotionSummary(const MotionStudy& study);
void WriteMotionFiles(const MotionStudy& study, const std::filesystem::path& folder);
void WriteMotionReport(const MotionStudy& study, const std::filesystem::path& folder,
                       const std::string& command_line);

const char* NameOf(MarkerTracker::State state);

}  // namespace retrolux
