// The marker study of the thesis (chapter 3): at which positions on the oval is a marker
// identified, by which of the room's cameras, in which pose of the patient.
#pragma once

#include <functional>

#include "analysis/composed_picture.h"
#include "analysis/marker_grid.h"
#include "classifier/edges.h"
#include "classifier/robust.h"
#include "core/task_manifest.h"

namespace retrolux {

// Why a marker was not identified; kHit: it was. Decided in this order:
enum class Outcome {
  kHit,
  kOutsidePicture,  // no part of it in the frame; or cut by the frame and not identified
  kFacingAway,      // no part of it faces the camera
  kHidden,          // no ray sees it; or less than half of it is seen and it was not identified
  kTooSmall,        // its visible area in the picture is below what the method looks at
  kNotDetected,     // the method found no pattern there
  kWrongNumber,     // it found one, and gave it another number or none
};
inline constexpr int kOutcomes = 7;
// "hit", "outside_picture", ... as in hits.csv.
const char* OutcomeName(Outcome outcome);

// One picture: one marker, one pose, one camera, one position.
struct PictureResult {
  int marker = 0;
  int pose = 0;    // index in MarkerStudy::poses
  int camera = 0;  // index in MarkerStudy::cameras
  GridPosition position;
  Vec3d position_in_world = Vec3d::Zero();
  double incidence_deg = 0.0;
  double visible_fraction = 0.0;
  Outcome outcome = Outcome::kNotDetected;
  std::optional<int> detected;  // the number that the method gave to the pattern there
  bool edges_hit = false;       // whether method `edges` identifies it in this picture
};

inline constexpr const char* kEdgesMethod = "edges";
inline constexpr const char* kRobustMethod = "robust";

enum class Keep { kAll, kMisses, kSamples };

struct MarkerStudyOptions {
  std::vector<int> markers = {2, 3};
  std::vector<Pose> poses;
  std::string material = "retro_bead";  // of the markers, in the scene or the library
  int stride = 1;  // only every stride-th row and column; 1 is the study, more is a quick look
  int samples_per_pixel = 32;
  uint64_t seed = 1;
  uint64_t noise_seed = 1;
  Keep keep = Keep::kSamples;
  std::string method = kEdgesMethod;  // or kRobustMethod; `edges` sees every picture beside it
  EdgesOptions edges;
  RobustOptions robust;
  int mirrored_checks = 24;  // positions of the other half that are rendered to check the symmetry
};

// A picture worth keeping, with its place in the study.
struct KeptPicture {
  PictureResult result;
  std::string file;  // relative to the study's folder
  std::string
      kind;  // "frontal", "oblique", "rim", "last hit", "first miss", "" for --keep all|misses
};

struct MarkerStudy {
  MarkerStudyOptions options;
  std::vector<Pose> poses;
  std::vector<std::string> cameras;
  std::vector<Vec3d> camera_centres;
  std::vector<PictureResult> results;   // of the half y >= 0
  std::vector<PictureResult> mirrored;  // of the mirrored positions that were checked
  std::vector<KeptPicture> kept;
  TaskReport tasks;  // what was done before this run, and what by it
  // What took how long in this run, s: wall time of the backgrounds and of the pictures, and the
  // time of all threads in the parts of a picture.
  struct Times {
    double background = 0.0, pictures = 0.0;
    double geometry = 0.0, trace = 0.0, sensor = 0.0, identify = 0.0, write = 0.0;
    Times& operator+=(const Times& other);
  } times;
  int64_t composed = 0;           // pictures that were made (the rest no ray sees)
  int64_t mirrored_composed = 0;  // of the mirrored positions
  int64_t retraced_pixels = 0;
};

// Poses at every `step_mm` from the first to the last pose along z, for `--poses scan`.
std::vector<Pose> ScanPoses(const Scene& scene, double step_mm);

// One task of a TaskManifest in `folder` for each camera in each pose (marker_study_task.h): what
// an earlier run with the same options has done there is not done again. Kept pictures go to
// folder/pictures. The scene must have an object "mask" and cameras whose names begin with "front"
// or "back" and come in -left and -right pairs; InputError if not.
MarkerStudy RunMarkerStudy(const Scene& scene, const MarkerStudyOptions& options,
                           const std::filesystem::path& folder, Progress& progress);

}  // namespace retrolux
