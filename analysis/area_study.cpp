#include "analysis/area_study.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "analysis/area_tests.h"
#include "analysis/cap_area.h"

namespace retrolux {

namespace {

using nlohmann::json;

constexpr double kRadius = kAreaSphereRadius_mm;

// --- rows as the results of tasks ---

json ToJson(const std::optional<double>& value) {
  return value ? json(*value) : json();
}

std::optional<double> OptionalOf(const json& value) {
  return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

json ToJson(const std::vector<AreaRow>& rows) {
  json all = json::array();
  for (const AreaRow& row : rows) {
    all.push_back({row.test, row.group, row.name, row.x, ToJson(row.psi_deg),
                   ToJson(row.rendered_mm2), ToJson(row.analytic_mm2), ToJson(row.far_mm2),
                   row.comparable});
  }
  return all;
}

void AppendRows(const json& all, std::vector<AreaRow>& rows) {
  for (const json& row : all) {
    rows.push_back({row[0], row[1], row[2], row[3], OptionalOf(row[4]), OptionalOf(row[5]),
                    OptionalOf(row[6]), OptionalOf(row[7]), row[8]});
  }
}

// --- tasks ---

struct AreaTask {
  Task task;
  std::function<std::vector<AreaRow>(AreaBench&)> work;
};

std::vector<AreaTask> SphereTasks() {
  std::vector<AreaTask> tasks;
  const auto add = [&](const std::string& name, auto work) {
    tasks.push_back({{name, {{"test", name}}}, work});
  };
  add("single cameras", MeasureSingles);
  for (int steps = 1; steps <= 4; ++steps) {
    add(fmt::format("pairs at {} deg", 40 * steps),
        [steps](AreaBench& bench) { return MeasurePairs(bench, steps); });
  }
  add("triplets in a plane", MeasureTriplets);
  add("triplets of two rigs", MeasureRigTriplets);
  add("far pairs", MeasureFarPairs);
  add("nozzles", [](AreaBench& bench) { return MeasureBeam(bench, false); });
  add("nozzles, far", [](AreaBench& bench) { return MeasureBeam(bench, true); });
  add("pairs over psi", MeasurePairsOverPsi);
  return tasks;
}

std::vector<AreaTask> ShapeTasks() {
  return {{{"discs", {{"test", "discs"}}}, MeasureDiscs},
          {{"ellipsoids", {{"test", "ellipsoids"}}}, MeasureEllipsoids}};
}

std::vector<AreaTask> ConvergenceTasks(const AreaStudyOptions& options) {
  std::vector<AreaTask> tasks;
  for (const AreaSetting& setting : AreaSettings(options)) {
    const char* shape = setting.disc ? "disc" : "sphere";
    tasks.push_back({{fmt::format("{}, {}, {} {}", shape, NameOf(setting.rule),
                                  NameOf(setting.axis), setting.value),
                      {{"test", "convergence"},
                       {"shape", shape},
                       {"rule", NameOf(setting.rule)},
                       {"axis", NameOf(setting.axis)},
                       {"value", setting.value}}},
                     [setting](AreaBench& bench) { return MeasureSetting(bench, setting); }});
  }
  return tasks;
}

void RunTasks(const std::string& stage, const std::vector<AreaTask>& tasks, TaskManifest& manifest,
              AreaBench& bench, Progress& progress, std::vector<AreaRow>& rows) {
  std::vector<Task> named;
  for (const AreaTask& task : tasks) named.push_back(task.task);
  // One after the other: each uses all threads, and the bench makes its masks for one of them.
  TaskLoop loop;
  loop.parallel = false;
  const std::vector<json> results = manifest.Run(
      stage, named, [&](size_t task) { return ToJson(tasks[task].work(bench)); }, progress, loop);
  for (const json& result : results) AppendRows(result, rows);
}

// --- what follows from the rows ---

LineFit FitAreas(const std::vector<const AreaRow*>& rows, double from_deg) {
  std::vector<double> x, y;
  for (const AreaRow* row : rows) {
    if (row->x <= from_deg) continue;
    x.push_back(RadFromDeg(row->x));
    y.push_back(*row->rendered_mm2 / (kRadius * kRadius));
  }
  return FitLine(x, y);
}

BeamThresholds ThresholdsOf(const std::vector<const AreaRow*>& rows) {
  BeamThresholds thresholds;
  for (const AreaRow* row : rows) {
    if (*row->rendered_mm2 == 0.0) thresholds.all_hidden_up_to = row->x;
    if (!row->comparable) thresholds.part_hidden_up_to = row->x;
  }
  return thresholds;
}

// The best angle as measured: of the closed form times the line through measured over closed form.
// The greatest of the measured costs itself would move by degrees with the samples' noise.
double MeasuredOptimum(const AreaRows& rows, const ReconstructionError& error, double half_angle) {
  constexpr double kFrom = 40.0, kTo = 70.0, kStep = 0.01;  // degrees
  std::vector<double> psi, ratio;
  for (const AreaRow* row : rows) {
    if (row->x < kFrom || row->x > kTo) continue;
    psi.push_back(RadFromDeg(row->x));
    ratio.push_back(*row->rendered_mm2 / *row->analytic_mm2);
  }
  const LineFit fit = FitLine(psi, ratio);
  double best = 0.0, most = 0.0;
  for (double deg = kFrom; deg <= kTo; deg += kStep) {
    const double rad = RadFromDeg(deg);
    const double cost = error.Weight(rad) * TwoCapArea(1.0, half_angle, half_angle, rad) *
                        (fit.offset + fit.gradient * rad);
    if (cost > most) {
      most = cost;
      best = deg;
    }
  }
  return best;
}

// The thesis's figure 4.23: rows of the weighted area over the angle.
void AddCosts(const ReconstructionError& error, AreaStudy& study) {
  std::vector<AreaRow> weighted;
  for (const AreaRow* row : study.Rows("pair_over_psi")) {
    const double weight = error.Weight(RadFromDeg(row->x));
    weighted.push_back(*row);
    AreaRow& added = weighted.back();
    added.test = "optimal_angle";
    added.rendered_mm2 = weight * *row->rendered_mm2;
    added.analytic_mm2 = weight * *row->analytic_mm2;
    added.far_mm2 = weight * *row->far_mm2;
  }
  study.rows.insert(study.rows.end(), weighted.begin(), weighted.end());
}

void FindOptima(const AreaBench& bench, AreaStudy& study) {
  const double distance = bench.Distance_mm();
  const double unit = std::acos(1.0 / distance), ours = std::acos(kRadius / distance);
  const auto optimum = [&](double gamma, double half_angle) {
    return DegFromRad(SphereOptimalAngle({bench.Room().error_points, gamma}, half_angle));
  };
  for (int i = 0; i <= 20; ++i) {
    const double gamma = 5.9 + 0.05 * i;
    study.gammas_mm.push_back(gamma);
    study.optimum_unit_deg.push_back(optimum(gamma, unit));
    study.optimum_deg.push_back(optimum(gamma, ours));
  }
  study.gamma_max_mm = bench.Room().gamma_max_mm;
  study.calibrated_unit_deg = optimum(study.gamma_max_mm, unit);
  study.calibrated_deg = optimum(study.gamma_max_mm, ours);
  const ReconstructionError error(bench.Room().error_points, study.gamma_max_mm);
  study.rendered_deg = MeasuredOptimum(study.Rows("pair_over_psi"), error, ours);
  AddCosts(error, study);
}

// --- targets ---

class Targets {
 public:
  explicit Targets(AreaStudy& study) : study_(study) {}

  void Set() {
    Error("single cameras", study_.Rows("single"), 0.1);
    for (const int psi : {40, 80, 120, 160}) {
      const std::string group = fmt::format("{} deg", psi);
      Error("pairs at " + group, study_.Rows("pair", group), psi == 160 ? 1.0 : 0.2);
    }
    for (const char* group : kTripletGroups) {
      Error(fmt::format("triplets {}", group), study_.Rows("triplet", group), 0.2);
      SpreadOf(fmt::format("cost of triplets {}", group), study_.Rows("triplet_cost", group));
    }
    Fit("far pairs", study_.far, 2.0 * kPi, 0.01, -2.0, 0.005);
    // As the thesis prints it: one digit after the point.
    Fit("nozzles, far, phi_b over 60 deg", study_.beam_far, 1.5 * kPi, 0.05, 0.5, 0.05);
    Add("optimal angle of the thesis's sphere", study_.calibrated_unit_deg, 56.0, 0.05, "deg");
    Add("optimal angle measured, beside that in closed form", study_.rendered_deg,
        study_.calibrated_deg, 0.2, "deg");
  }

 private:
  static constexpr const char* kTripletGroups[] = {"in a plane, 40 deg", "rigs 2-1-2", "rigs 1-2-1",
                                                   "rigs, two neighbours on one"};

  void Add(const std::string& name, double measured, double aim, double tolerance,
           const char* unit) {
    study_.targets.push_back({name, measured, aim, tolerance, unit});
  }
  void Error(const std::string& name, const std::vector<const AreaRow*>& rows, double percent) {
    Add(name + ", largest error", 100.0 * LargestError(rows), 0.0, percent, "%");
    SpreadOf(name, rows);
  }
  void SpreadOf(const std::string& name, const std::vector<const AreaRow*>& rows) {
    Add(name + ", spread", 100.0 * Spread(rows), 0.0, 0.05, "%");
  }
  void Fit(const std::string& name, const LineFit& fit, double offset, double offset_tolerance,
           double gradient, double gradient_tolerance) {
    Add(name + ", offset", fit.offset, offset, offset_tolerance, "r2");
    Add(name + ", gradient", fit.gradient, gradient, gradient_tolerance, "r2/rad");
  }

  AreaStudy& study_;
};

json OptionsJson(const AreaStudyOptions& options) {
  return {{"size", {options.width_px, options.height_px}},
          {"visibility", NameOf(options.rule)},
          {"levels", options.levels},
          {"part_area_mm2", options.part_area_mm2},
          {"rotations", options.rotations},
          {"seed", options.seed}};
}

}  // namespace

std::string AreaRow::Case() const {
  return group.empty() ? name : fmt::format("{}, {}", group, name);
}

std::optional<double> AreaRow::RelError() const {
  if (!comparable || !rendered_mm2 || !analytic_mm2 || !(*analytic_mm2 > 0.0)) return std::nullopt;
  return *rendered_mm2 / *analytic_mm2 - 1.0;
}

LineFit FitLine(const std::vector<double>& x, const std::vector<double>& y) {
  double mean_x = 0.0, mean_y = 0.0, xx = 0.0, xy = 0.0;
  const auto count = static_cast<double>(x.size());
  for (size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / count;
    mean_y += y[i] / count;
  }
  for (size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  return {mean_y - xy / xx * mean_x, xy / xx};
}

AreaRows AreaStudy::Rows(const std::string& test, const std::string& group) const {
  std::vector<const AreaRow*> found;
  for (const AreaRow& row : rows) {
    if (row.test == test && (group.empty() || row.group == group)) found.push_back(&row);
  }
  return found;
}

double LargestError(const std::vector<const AreaRow*>& rows) {
  double largest = 0.0;
  for (const AreaRow* row : rows)
    largest = std::max(largest, std::abs(row->RelError().value_or(0.0)));
  return largest;
}

double RmsError(const std::vector<const AreaRow*>& rows) {
  double sum = 0.0;
  int count = 0;
  for (const AreaRow* row : rows) {
    if (!row->RelError()) continue;
    sum += *row->RelError() * *row->RelError();
    ++count;
  }
  return count == 0 ? 0.0 : std::sqrt(sum / count);
}

double Spread(const std::vector<const AreaRow*>& rows) {
  if (rows.size() < 2) return 0.0;
  double mean = 0.0, squares = 0.0;
  for (const AreaRow* row : rows) mean += *row->rendered_mm2 / static_cast<double>(rows.size());
  for (const AreaRow* row : rows) {
    const double residual = *row->rendered_mm2 / mean - 1.0;
    squares += residual * residual;
  }
  return std::sqrt(squares / static_cast<double>(rows.size() - 1));
}

double AreaCurve::Slope() const {
  std::vector<double> x, y;
  for (const Point& point : points) {
    if (!(point.rms > 0.0)) continue;
    x.push_back(std::log(point.x));
    y.push_back(std::log(point.rms));
  }
  return x.size() < 2 ? 0.0 : FitLine(x, y).gradient;
}

std::vector<AreaCurve> AreaCurves(const AreaStudy& study) {
  std::map<std::string, std::map<double, std::vector<const AreaRow*>>> by_group;
  std::vector<std::string> groups;  // in the order of the rows
  for (const AreaRow* row : study.Rows("convergence")) {
    if (!by_group.contains(row->group)) groups.push_back(row->group);
    by_group[row->group][row->x].push_back(row);
  }
  std::vector<AreaCurve> curves;
  for (const std::string& group : groups) {
    const size_t first = group.find(", "), second = group.find(", ", first + 2);
    AreaCurve curve{group.substr(0, first),
                    group.substr(first + 2, second - first - 2),
                    group.substr(second + 2),
                    {}};
    for (const auto& [x, rows] : by_group[group])
      curve.points.push_back({x, RmsError(rows), LargestError(rows)});
    curves.push_back(std::move(curve));
  }
  return curves;
}

AreaStudy RunAreaStudy(const AreaStudyOptions& options, const std::filesystem::path& folder,
                       Progress& progress) {
  AreaStudy study;
  study.options = options;
  AreaBench bench(options);
  TaskManifest manifest(folder, "areas", OptionsJson(options));
  RunTasks("sphere", SphereTasks(), manifest, bench, progress, study.rows);
  RunTasks("other shapes", ShapeTasks(), manifest, bench, progress, study.rows);
  RunTasks("convergence", ConvergenceTasks(options), manifest, bench, progress, study.rows);
  study.tasks = manifest.Report();
  study.far = FitAreas(study.Rows("far_pair"), -1.0);
  study.beam_far = FitAreas(study.Rows("beam_far", "both"), 60.0);
  study.camera_1 = ThresholdsOf(study.Rows("beam", "camera 1"));
  study.camera_2 = ThresholdsOf(study.Rows("beam", "camera 2"));
  FindOptima(bench, study);
  Targets(study).Set();
  return study;
}

}  // namespace retrolux
