#include "analysis/layout_study.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "analysis/layout_pose.h"
#include "classifier/marker_point.h"
#include "core/atomic_file.h"
#include "scenes/masks.h"
#include "scenes/scene_json.h"

namespace retrolux {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

constexpr const char* kMask = "mask";

// Of the poses, those a search step apart, and the last.
std::vector<Pose> SearchPoses(const LayoutStudyOptions& options) {
  std::vector<Pose> chosen;
  for (const Pose& pose : options.poses) {
    const bool far = chosen.empty() || (pose.translation - chosen.back().translation).norm() >=
                                           options.search_step_mm - 1e-6;
    if (far || &pose == &options.poses.back()) chosen.push_back(pose);
  }
  return chosen;
}

std::vector<MarkerShape> IdentifiableShapes(const MarkerSet& set) {
  std::vector<MarkerShape> shapes;
  for (const MarkerShape& shape : set.shapes) {
    if (shape.number != 0) shapes.push_back(shape);
  }
  return shapes;
}

std::vector<MarkerSpec> Markers(const std::vector<MarkerPlace>& places, const MarkerLayout& layout,
                                const LayoutStudyOptions& options, const MarkerSet& set) {
  const std::vector<MarkerShape> shapes = IdentifiableShapes(set);
  std::vector<MarkerSpec> markers;
  for (size_t i = 0; i < layout.places.size(); ++i) {
    const int number = shapes[i].number;
    MarkerSpec marker{fmt::format("marker-{}", number), number, kMask, places[layout.places[i]].at};
    marker.material = options.material;
    markers.push_back(std::move(marker));
  }
  return markers;
}

MarkerLayout Search(const Scene& scene, const LayoutStudyOptions& options,
                    const std::vector<MarkerPlace>& places, Progress& progress) {
  const SightTable table =
      SeePlaces(scene, SearchPoses(options), places, *scene.materials.at(options.material).bsdf,
                options.layout.sight, progress);
  return FindLayout(scene, table, places, options.layout, progress);
}

bool IsKept(const LayoutStudyOptions& options, size_t pose) {
  const auto height = [&](const Pose& p) { return p.translation.z(); };
  const auto [lo, hi] =
      std::minmax_element(options.poses.begin(), options.poses.end(),
                          [&](const Pose& a, const Pose& b) { return height(a) < height(b); });
  const auto middle = std::min_element(
      options.poses.begin(), options.poses.end(),
      [&](const Pose& a, const Pose& b) { return std::abs(height(a)) < std::abs(height(b)); });
  const Pose* p = &options.poses[pose];
  return p == &*lo || p == &*hi || p == &*middle;
}

Json Inputs(const Scene& scene, const LayoutStudyOptions& options) {
  const LayoutOptions& l = options.layout;
  return {{"scene", SceneHash(scene)},
          {"method", options.method},
          {"spp", options.samples_per_pixel},
          {"seed", options.seed},
          {"min_separation_deg", l.min_separation_deg},
          {"point_sigma_px", l.point_sigma_px}};
}

}  // namespace

Scene LayoutScene(Scene scene, const LayoutStudyOptions& options) {
  SceneObject* mask = nullptr;
  for (SceneObject& object : scene.objects) {
    if (object.name == kMask && object.moves_with_pose) mask = &object;
  }
  if (!mask) {
    throw InputError(
        fmt::format("scene '{}': no object '{}' that moves with the pose", scene.name, kMask));
  }
  mask->mesh = MakeMask(options.mask);
  mask->perforation.reset();
  scene.markers.clear();
  scene.UseMaterial(options.material);
  scene.exposure.marker_material = options.material;
  return scene;
}

const LayoutPair& LayoutStudy::Best(size_t pose) const {
  const LayoutPair* best = nullptr;
  for (const LayoutPair& pair : pairs) {
    if (pair.pose != pose) continue;
    const bool better =
        !best || pair.common.size() > best->common.size() ||
        (pair.common.size() == best->common.size() && pair.expected_tre_mm < best->expected_tre_mm);
    if (better) best = &pair;
  }
  RETROLUX_CHECK(best != nullptr, "no pair of cameras is far enough apart");
  return *best;
}

int LayoutStudy::Margin() const {
  auto least = static_cast<int>(markers.size());
  for (size_t pose = 0; pose < options.poses.size(); ++pose)
    least = std::min(least, static_cast<int>(Best(pose).common.size()));
  return least - 3;
}

LayoutStudy RunLayoutStudy(const Scene& scene, const LayoutStudyOptions& options,
                           const fs::path& folder, Progress& progress) {
  Scene room = LayoutScene(scene, options);
  EnsureWritableFolder(folder / "pictures");
  LayoutStudy study;
  study.options = options;
  study.scene = scene.name;
  for (const CameraSpec& camera : room.cameras) study.cameras.push_back(camera.model.name);
  LayoutOptions& layout = study.options.layout;
  layout.relative_sigma.clear();
  for (const MarkerShape& shape : IdentifiableShapes(*room.marker_set))
    layout.relative_sigma.push_back(RelativeSigma(shape.straight_edges, MarkerPoint::kCentre));
  const std::vector<MarkerPlace> places = CandidatePlaces(room, layout.candidate_mm2, layout.seed);
  study.found = Search(room, study.options, places, progress);
  room.markers = study.markers = Markers(places, study.found, options, *room.marker_set);

  std::vector<Task> tasks;
  for (const Pose& pose : options.poses) {
    const Vec3d& t = pose.translation;
    tasks.push_back(
        {"pose " + pose.name, {{"pose", pose.name}, {"translation_mm", {t.x(), t.y(), t.z()}}}});
  }
  TaskLoop loop;
  loop.parallel = false;
  TaskManifest manifest(folder, "layout", Inputs(room, options));
  const std::vector<Json> done = manifest.Run(
      "poses", tasks,
      [&](size_t task) {
        const Pose& pose = options.poses[task];
        return RunLayoutPose(room.AtPose(pose), options, pose.name,
                             IsKept(options, task) ? folder / "pictures" : fs::path());
      },
      progress, loop);
  study.tasks = manifest.Report();
  for (size_t pose = 0; pose < done.size(); ++pose) CollectLayoutPose(done[pose], pose, study);
  return study;
}

}  // namespace retrolux
