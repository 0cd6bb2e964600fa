#include "analysis/stereo_study.h"

#include <cmath>

namespace retrolux {

namespace {

using nlohmann::json;

std::vector<StereoShotSpec> ShotsOf(const StereoStudyOptions& options) {
  std::vector<StereoShotSpec> shots;
  for (const StereoTarget target : options.targets) {
    for (const double psi_deg : options.angles_deg) {
      const int placements =
          psi_deg == options.budget_deg ? options.budget_placements : options.placements;
      for (int i = 0; i < placements; ++i) shots.push_back({target, psi_deg, i});
    }
  }
  return shots;
}

Task TaskOf(const StereoShotSpec& shot) {
  return {
      fmt::format("{} at {:g} deg, placement {}", NameOf(shot.target), shot.psi_deg,
                  shot.placement),
      {{"target", NameOf(shot.target)}, {"psi_deg", shot.psi_deg}, {"placement", shot.placement}}};
}

std::array<CameraModel, 2> CamerasAt(double psi_deg, double distance_mm) {
  const std::array<CameraSpec, 2> pair = StereoPair(psi_deg, distance_mm);
  return {pair[0].model, pair[1].model};
}

double MeanIncidence(const std::vector<StereoShot>& shots) {
  double sum = 0.0, count = 0.0;
  for (const StereoShot& shot : shots) {
    for (const MarkerInPair& marker : shot.markers) {
      for (const MarkerInView& view : marker.views) {
        sum += view.incidence_deg;
        ++count;
      }
    }
  }
  return sum / count;
}

void AddRows(StereoTarget target, double psi_deg, const std::vector<StereoShot>& shots,
             StereoStudy& study) {
  const auto cameras = CamerasAt(psi_deg, study.options.shot.distance_mm);
  int misnamed = 0;
  for (const StereoShot& shot : shots) misnamed += shot.misnamed;
  for (const MarkerPoint point : {MarkerPoint::kCentre, MarkerPoint::kLight}) {
    study.rows.push_back({target, psi_deg, point, MeanIncidence(shots), misnamed,
                          SpatialErrorOf(cameras, shots, point),
                          PoseErrorsOf(cameras, shots, point)});
  }
  if (psi_deg != study.options.budget_deg) return;
  const auto add = [&](std::optional<int> number) {
    study.budgets.push_back({target, number, ErrorBudget(cameras, shots, number)});
  };
  add(std::nullopt);
  for (const MarkerInPair& marker : shots.front().markers) add(marker.known.number);
}

// What issue and design ask for: six markers, 45 degrees, 1600 mm, default noise.
void SetGoals(StereoStudy& study) {
  for (const StereoTarget target : study.options.targets) {
    for (const MarkerPoint point : {MarkerPoint::kCentre, MarkerPoint::kLight}) {
      const StereoRow* row = study.Row(target, point, study.options.budget_deg);
      if (!row || row->error.found == 0) continue;
      const std::string what = fmt::format(
          "{}, {}", NameOf(target), point == MarkerPoint::kCentre ? "fitted middle" : "centroid");
      study.goals.push_back({what + ": marker, rms", row->error.rms, 0.1, "mm"});
      if (row->pose.poses == 0) continue;
      study.goals.push_back(
          {what + ": pose, shift at the origin, rms", row->pose.translation_rms_mm, 0.1, "mm"});
      study.goals.push_back({what + ": pose, turn, rms", row->pose.rotation_rms_deg, 0.05, "deg"});
    }
  }
}

}  // namespace

Vec3d RaySigma_mm(double e_mm, double psi_deg) {
  const double half = 0.5 * RadFromDeg(psi_deg);
  return e_mm / std::sqrt(2.0) * Vec3d(1.0 / std::sin(half), 1.0 / std::cos(half), 1.0);
}

std::vector<const StereoRow*> StereoStudy::Rows(StereoTarget target, MarkerPoint point) const {
  std::vector<const StereoRow*> chosen;
  for (const StereoRow& row : rows) {
    if (row.target == target && row.point == point) chosen.push_back(&row);
  }
  return chosen;
}

const StereoRow* StereoStudy::Row(StereoTarget target, MarkerPoint point, double psi_deg) const {
  for (const StereoRow* row : Rows(target, point)) {
    if (row->psi_deg == psi_deg) return row;
  }
  return nullptr;
}

StereoStudy RunStereoStudy(const StereoStudyOptions& options, const std::filesystem::path& folder,
                           Progress& progress) {
  StereoStudy study;
  study.options = options;
  study.mm_per_px = options.shot.distance_mm / CamerasAt(45.0, options.shot.distance_mm)[0].fx;
  TaskManifest manifest(folder, "stereo",
                        {{"seed", options.shot.seed},
                         {"spp", options.shot.samples_per_pixel},
                         {"exposures", options.shot.exposures},
                         {"distance_mm", options.shot.distance_mm},
                         {"material", options.shot.material}});
  const std::vector<StereoShotSpec> specs = ShotsOf(options);
  std::vector<Task> tasks;
  for (const StereoShotSpec& spec : specs) tasks.push_back(TaskOf(spec));
  const std::vector<json> results = manifest.Run(
      "pairs of pictures", tasks,
      [&](size_t task) { return ShootStereo(specs[task], options.shot).ToJson(); }, progress);
  study.tasks = manifest.Report();
  for (size_t begin = 0; begin < specs.size();) {
    std::vector<StereoShot> shots;
    size_t end = begin;
    while (end < specs.size() && specs[end].target == specs[begin].target &&
           specs[end].psi_deg == specs[begin].psi_deg)
      shots.push_back(StereoShot::FromJson(results[end++]));
    AddRows(specs[begin].target, specs[begin].psi_deg, shots, study);
    begin = end;
  }
  SetGoals(study);
  return study;
}

}  // namespace retrolux
