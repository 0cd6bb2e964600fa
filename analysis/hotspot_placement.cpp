#include "analysis/hotspot_placement.h"

#include <algorithm>
#include <set>

#include "analysis/cross_highlight.h"
#include "analysis/hotspot_picture.h"
#include "analysis/marker_study_task.h"
#include "analysis/signal_noise.h"
#include "core/hash.h"
#include "scenes/scene_json.h"

namespace retrolux {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

HotspotMix WithOne(const std::string& ring) {
  return {"own and " + ring, 1.0, 1.0, false, ring};
}

// The own ring alone, all of them, and the own one with each other one.
std::vector<HotspotMix> MixesOf(const std::vector<std::string>& cameras, size_t own) {
  std::vector<HotspotMix> mixes = {{"own", 1.0, 0.0}, {"both", 1.0, 1.0}};
  for (size_t ring = 0; ring < cameras.size(); ++ring) {
    if (ring != own) mixes.push_back(WithOne(cameras[ring]));
  }
  return mixes;
}

std::string RotationName(const MaskRotation& rotation) {
  return fmt::format("x{:g}_y{:g}_z{:g}", rotation.x_deg, rotation.y_deg, rotation.z_deg);
}

// 1 sigma of a pixel of the bare mask at its mean level in own light; 0 if none is seen.
double MaskNoise_e(const HotspotStage& stage) {
  const HotspotLight& light = stage.light;
  const FloatPlane own = Mixed(light, {"own", 1.0, 0.0});
  double sum = 0.0, count = 0.0;
  for (size_t i = 0; i < own.data.size(); ++i) {
    if (light.ids.object.data[i] != stage.mask + 1 || light.ids.marker.data[i] != 0 ||
        light.edges.data[i] != 0)
      continue;
    sum += static_cast<double>(own.data[i]);
    ++count;
  }
  if (count == 0.0) return 0.0;
  return NoiseSigma_e(stage.camera.sensor, light.exposure_s, sum / count);
}

double Median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

const RingLight* BrightestNeighbour(const HotspotShot& shot) {
  const RingLight* brightest = nullptr;
  for (const RingLight& ring : shot.rings) {
    if (ring.separation_deg > 0.0 &&
        (!brightest || ring.highlight.peak_e > brightest->highlight.peak_e))
      brightest = &ring;
  }
  return brightest;
}

// One camera's picture at one rotation.
struct View {
  size_t rotation = 0, camera = 0;
};

class PlacementStudy {
 public:
  PlacementStudy(const HotspotPlacementOptions& options, const HotspotSetup& setup,
                 const HotspotShotOptions& shot, const fs::path& folder)
      : setup_(setup), shot_(shot), folder_(folder) {
    placement_.options = options;
    const Scene scene = SceneAt(0);
    for (const CameraSpec& camera : scene.cameras) placement_.cameras.push_back(camera.model.name);
  }

  HotspotPlacement Run(TaskManifest& manifest, Progress& progress) {
    Forecast(manifest, progress);
    placement_.rendered =
        WorstRotations(placement_.triples, static_cast<size_t>(placement_.options.rotations));
    Render(manifest, progress);
    SortWorstFirst(placement_.triples);
    return std::move(placement_);
  }

 private:
  const std::vector<MaskRotation>& Rotations() const { return placement_.options.vault.rotations; }
  Scene SceneAt(size_t rotation) const {
    return HotspotVaultScene(placement_.options.vault, Rotations()[rotation], setup_);
  }
  size_t Cameras() const { return placement_.cameras.size(); }

  // One task for each rotation, all cameras and rings.
  void Forecast(TaskManifest& manifest, Progress& progress) {
    std::vector<Task> tasks;
    for (size_t r = 0; r < Rotations().size(); ++r)
      tasks.push_back(
          {"forecast " + RotationName(Rotations()[r]), {{"forecast_of", SceneHash(SceneAt(r))}}});
    const std::vector<Json> results = manifest.Run(
        "forecast", tasks, [&](size_t task) { return ForecastTask(task); }, progress);
    const Scene scene = SceneAt(0);
    for (size_t rotation = 0; rotation < results.size(); ++rotation) {
      for (size_t camera = 0; camera < Cameras(); ++camera) {
        for (size_t ring = 0; ring < Cameras(); ++ring) {
          if (ring == camera) continue;
          placement_.triples.push_back(
              {camera,
               ring,
               rotation,
               Separation_deg(scene.cameras[camera].model, scene.cameras[ring].model),
               results[rotation].at(camera).at(ring).get<HighlightForecast>(),
               {},
               {}});
        }
      }
    }
  }

  Json ForecastTask(size_t rotation) const {
    const Scene scene = SceneAt(rotation);
    const RayScene rays(scene);
    Json by_camera = Json::array();
    for (const CameraSpec& camera : scene.cameras)
      by_camera.push_back(ForecastHighlights(scene, rays, camera, MaskIndex(scene)));
    return by_camera;
  }

  void Render(TaskManifest& manifest, Progress& progress) {
    std::vector<View> views;
    std::vector<Task> tasks;
    for (const size_t rotation : placement_.rendered) {
      const std::string scene = SceneHash(SceneAt(rotation));
      for (size_t camera = 0; camera < Cameras(); ++camera) {
        views.push_back({rotation, camera});
        tasks.push_back({NameOf(views.back()),
                         {{"room", scene},
                          {"camera", placement_.cameras[camera]},
                          {"indirect", placement_.options.indirect}}});
      }
    }
    TaskLoop loop;
    loop.parallel = false;
    loop.unit = "pictures";
    loop.usable = [&](const Json& result) { return KeptPicturesAreThere(result, folder_); };
    const std::vector<Json> results = manifest.Run(
        "placement", tasks, [&](size_t task) { return ViewTask(views[task]); }, progress, loop);
    Collect(views, results);
  }

  std::string NameOf(const View& view) const {
    return fmt::format("placement_{}_{}", RotationName(Rotations()[view.rotation]),
                       placement_.cameras[view.camera]);
  }

  HotspotSamples Samples() const {
    HotspotSamples samples = shot_.samples;
    if (!placement_.options.indirect) samples.surfaces = 1;
    return samples;
  }

  Json ViewTask(const View& view) const {
    const std::string name = NameOf(view);
    const HotspotStage stage(SceneAt(view.rotation), view.camera, Samples(),
                             CombineKeys(shot_.seed, HashBytes(name)));
    const HotspotShot shot =
        ShootHotspots(stage, MixesOf(placement_.cameras, view.camera), shot_, name);
    const double noise_e = MaskNoise_e(stage);
    const RingLight* brightest = BrightestNeighbour(shot);
    const bool keep =
        brightest && HotspotChange{brightest->highlight.peak_e, noise_e, {}}.Changed();
    return {{"shot", shot},
            {"mask_noise_e", noise_e},
            {"kept_of", keep ? brightest->name : ""},
            {"kept", keep ? KeepHotspotPictures(stage, WithOne(brightest->name), name,
                                                shot_.noise_seed, folder_)
                          : Json::array()}};
  }

  void Collect(const std::vector<View>& views, const std::vector<Json>& results) {
    std::vector<std::vector<HotspotShot>> by_camera(Cameras());
    std::vector<double> noises, own_highlights;
    for (size_t v = 0; v < views.size(); ++v) {
      const HotspotShot shot = results[v].at("shot").get<HotspotShot>();
      placement_.render_noise = std::max(placement_.render_noise, shot.render_noise);
      const double noise_e = results[v].at("mask_noise_e").get<double>();
      if (noise_e > 0.0) noises.push_back(noise_e);
      for (const RingLight& ring : shot.rings) {
        if (ring.separation_deg == 0.0) own_highlights.push_back(ring.highlight.peak_e);
      }
      AddChanges(views[v], shot, results[v]);
      // Without a marker there is nothing that means over markers could be made of.
      if (!shot.markers.empty()) by_camera[views[v].camera].push_back(shot);
    }
    placement_.mask_noise_e = Median(std::move(noises));
    placement_.own_highlight_e = Median(std::move(own_highlights));
    for (size_t camera = 0; camera < Cameras(); ++camera) {
      if (by_camera[camera].empty()) continue;
      placement_.views.push_back(
          {placement_.cameras[camera],
           RowOf(0.0, std::move(by_camera[camera]), MixesOf(placement_.cameras, camera)),
           {}});
    }
    placement_.all = {"both", 1.0, 1.0};
  }

  void AddChanges(const View& view, const HotspotShot& shot, const Json& result) {
    const double mask_noise_e = result.at("mask_noise_e").get<double>();
    const HotspotRow row = RowOf(0.0, {shot}, MixesOf(placement_.cameras, view.camera));
    const HotspotLevels& own = row.Mix("own").mean;
    for (PlacementTriple& triple : placement_.triples) {
      if (triple.camera != view.camera || triple.rotation != view.rotation) continue;
      const std::string& name = placement_.cameras[triple.ring];
      const auto ring = std::find_if(shot.rings.begin(), shot.rings.end(),
                                     [&](const RingLight& light) { return light.name == name; });
      triple.change = {*ring,
                       {ring->highlight.peak_e, mask_noise_e, {}},
                       {ring->lobe_e, own.marker_noise_e, {}},
                       {ring->beam_e, own.background_noise_e, {}},
                       row.Mix(WithOne(name).name).methods,
                       shot_.exposures};
      if (result.at("kept_of") == name) triple.pictures = KeptHotspotPictures(result);
    }
  }

  static size_t MaskIndex(const Scene& scene) {
    return static_cast<size_t>(&scene.Object("mask") - scene.objects.data());
  }

  const HotspotSetup& setup_;
  const HotspotShotOptions& shot_;
  const fs::path& folder_;
  HotspotPlacement placement_;
};

}  // namespace

double NeighbourChange::Sigmas() const {
  return std::max({highlight.Sigmas(), tail.Sigmas(), beam.Sigmas()});
}

const char* NeighbourChange::Largest() const {
  if (highlight.Sigmas() == Sigmas()) return "highlight";
  return tail.Sigmas() == Sigmas() ? "retro tail" : "beam";
}

std::vector<size_t> WorstRotations(const std::vector<PlacementTriple>& triples, size_t most) {
  std::vector<PlacementTriple> sorted = triples;
  SortWorstFirst(sorted);
  std::set<std::pair<size_t, size_t>> pairs;
  std::set<size_t> chosen;
  for (const bool new_pairs_only : {true, false}) {
    for (const PlacementTriple& triple : sorted) {
      if (chosen.size() == most) break;
      const bool is_new = pairs.insert(std::minmax(triple.camera, triple.ring)).second;
      if (is_new || !new_pairs_only) chosen.insert(triple.rotation);
    }
  }
  return {chosen.begin(), chosen.end()};
}

void SortWorstFirst(std::vector<PlacementTriple>& triples) {
  const auto key = [](const PlacementTriple& triple) {
    return std::make_pair(triple.change.has_value(),
                          triple.change ? triple.change->Sigmas() : triple.forecast.peak_e);
  };
  std::stable_sort(
      triples.begin(), triples.end(),
      [&](const PlacementTriple& a, const PlacementTriple& b) { return key(a) > key(b); });
}

HotspotPlacement RunHotspotPlacement(const HotspotPlacementOptions& options,
                                     const HotspotSetup& setup, const HotspotShotOptions& shot,
                                     TaskManifest& manifest, const fs::path& folder,
                                     Progress& progress) {
  return PlacementStudy(options, setup, shot, folder).Run(manifest, progress);
}

}  // namespace retrolux
