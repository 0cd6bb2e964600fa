// Do markers work together? All markers of a layout rendered at once, in every pose and for every
// camera, named in the noisy pictures, and counted: how many does some pair of cameras name?
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "analysis/marker_layout.h"
#include "core/task_manifest.h"

namespace retrolux {

struct LayoutStudyOptions {
  std::string mask = "oval";  // or "face": takes the place of the scene's object "mask"
  std::vector<Pose> poses;    // that are rendered
  std::string method = "robust";
  std::string material = "retro_bead";
  int samples_per_pixel = 8;
  uint64_t seed = 1;             // of light transport, noise and search
  LayoutOptions layout;          // relative_sigma follows from the marker set
  double search_step_mm = 20.0;  // the search looks at every such step of the poses
};

// One marker in one picture.
struct LayoutSighting {
  int marker = 0;
  double incidence_deg = 0.0, visible_fraction = 0.0;
  std::optional<int> named;  // as what it was named; nothing: not at all
};

// What one pair of cameras has in one pose.
struct LayoutPair {
  size_t pose = 0, a = 0, b = 0;
  double separation_deg = 0.0;
  std::vector<int> common;       // numbers that both named rightly
  double expected_tre_mm = 0.0;  // PairTre_mm; 0 for fewer than three
  // Of the pose that the stereo reconstruction gives from the two pictures; nothing: it gave none.
  std::optional<double> position_error_mm, rotation_error_deg;
};

struct LayoutStudy {
  LayoutStudyOptions options;
  std::string scene;
  std::vector<std::string> cameras;
  std::vector<MarkerSpec> markers;
  MarkerLayout found;                                               // what the search promised
  std::vector<std::vector<std::vector<LayoutSighting>>> sightings;  // [pose][camera][marker]
  std::vector<LayoutPair> pairs;  // of all poses, those that are far enough apart
  int misnamed = 0;               // names on other markers, or where none is
  TaskReport tasks;

  // Of a pose: the pair with the smallest expected TRE among those with the most common names.
  const LayoutPair& Best(size_t pose) const;
  // Names that the best pair has beyond three, in the worst pose: negative if it has not three.
  int Margin() const;
};

// The scene with the mask of the options and without markers, as it is searched and rendered.
// InputError if it has no object "mask" that moves with the pose.
Scene LayoutScene(Scene scene, const LayoutStudyOptions& options);

// Renders into `folder`/tasks and /pictures (of the poses with the largest and smallest z, and the
// one nearest to z = 0); an interrupted study goes on. The scene must have an object "mask" that
// moves with the pose. InputError.
LayoutStudy RunLayoutStudy(const Scene& scene, const LayoutStudyOptions& options,
                           const std::filesystem::path& folder, Progress& progress);

// layout.json, sightings.csv, pairs.csv, report.html.
// `room`: the scene of the study.
nlohmann::json LayoutSummary(const LayoutStudy& study);
void WriteLayoutFiles(const LayoutStudy& study, const std::filesystem::path& folder);
void WriteLayoutReport(const LayoutStudy& study, const Scene& room,
                       const std::filesystem::path& folder, const std::string& command_line);

}  // namespace retrolux
