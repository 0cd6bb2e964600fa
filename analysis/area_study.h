// Visible areas against closed forms: section 4.6 of the thesis (sphere, singles to triplets, the
// far limit, the nozzles, the optimal angle), and what it left out (surfaces that hide one another,
// and how the error falls).
#pragma once

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "analysis/visibility.h"
#include "core/task_manifest.h"

namespace retrolux {

struct AreaStudyOptions {
  int width_px = 640, height_px = 480;
  VisibilityRule rule = VisibilityRule::kIdBuffer;
  int levels = 6;                // of EllipsoidMesh: 81,920 triangles
  double part_area_mm2 = 0.025;  // 5.2 million samples: what two cameras 160 degrees apart share is
                                 // thin, and its boundary is where samples err
  uint64_t seed = 1;             // of the rotation of the meshes and of the samples
  int rotations = 8;             // over which the errors of the convergence are averaged

  int Triangles() const { return 20 << (2 * levels); }
};

// One area, measured and in closed form.
struct AreaRow {
  std::string test, group, name;  // rows of one test and group are equivalent, or one curve
  double x = 0.0;                 // where on that curve
  std::optional<double> psi_deg, rendered_mm2, analytic_mm2, far_mm2;
  bool comparable = true;  // false: the closed form leaves out what hides part of it

  std::string Case() const;                // group and name
  std::optional<double> RelError() const;  // signed
};

// offset + gradient x.
struct LineFit {
  double offset = 0.0, gradient = 0.0;
};
LineFit FitLine(const std::vector<double>& x, const std::vector<double>& y);

// What the study is to reach.
struct AreaTarget {
  std::string name;
  double measured = 0.0, aim = 0.0, tolerance = 0.0;  // met: |measured - aim| < tolerance
  std::string unit;
  bool Met() const { return std::abs(measured - aim) < tolerance; }
};

// The places where nozzles begin and cease to hide something, in degrees of phi_b.
struct BeamThresholds {
  double all_hidden_up_to = 0.0;   // 0: never
  double part_hidden_up_to = 0.0;  // 0: never
};

using AreaRows = std::vector<const AreaRow*>;

struct AreaStudy {
  AreaStudyOptions options;
  std::vector<AreaRow> rows;
  std::vector<AreaTarget> targets;
  LineFit far, beam_far;                                         // areas in r^2 over radians
  BeamThresholds camera_1, camera_2;                             // near
  double gamma_max_mm = 0.0;                                     // of the scenario
  std::vector<double> gammas_mm, optimum_unit_deg, optimum_deg;  // thesis's sphere, ours
  double calibrated_unit_deg = 0.0, calibrated_deg = 0.0, rendered_deg = 0.0;
  TaskReport tasks;

  AreaRows Rows(const std::string& test, const std::string& group = "") const;
};

// Figures over rows that have a closed form.
double LargestError(const std::vector<const AreaRow*>& rows);  // relative, without sign
double RmsError(const std::vector<const AreaRow*>& rows);
double Spread(const std::vector<const AreaRow*>& rows);  // thesis eq. 4.15, as a fraction

// How the error of a shape falls along one axis, for one rule.
struct AreaCurve {
  struct Point {
    double x, rms, largest;  // relative errors, over the rotations
  };
  std::string shape, rule, axis;
  std::vector<Point> points;
  // d log(rms) / d log(x)
  double Slope() const;
};
std::vector<AreaCurve> AreaCurves(const AreaStudy& study);

AreaStudy RunAreaStudy(const AreaStudyOptions& options, const std::filesystem::path& folder,
                       Progress& progress = NoProgress());

// areas.csv and summary.json.
void WriteAreaFiles(const AreaStudy& study, const std::filesystem::path& folder);
nlohmann::json AreaSummary(const AreaStudy& study);
void WriteAreaReport(const AreaStudy& study, const std::filesystem::path& folder,
                     const std::string& command_line);

}  // namespace retrolux
