#include "analysis/hotspot_study.h"

#include <algorithm>

#include "analysis/hotspot_picture.h"
#include "analysis/hotspot_room.h"
#include "analysis/marker_study_task.h"
#include "core/atomic_file.h"
#include "core/hash.h"
#include "renderer/render_files.h"
#include "scenes/scene_json.h"

namespace retrolux {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

// One task: a picture of a series, or a camera of the room.
struct ShotSpec {
  const HotspotSeries* series = nullptr;  // null: the room
  double psi_deg = 0.0;
  int placement = 0;
  size_t camera = 0;
};

std::string NameOf(const ShotSpec& spec, const HotspotStudyOptions& options) {
  if (!spec.series) return "room_" + options.room->cameras[spec.camera].model.name;
  return fmt::format("{}_{:g}_{}", spec.series->name, spec.psi_deg, spec.placement);
}

Json DefinitionOf(const ShotSpec& spec, const HotspotStudyOptions& options) {
  if (!spec.series) {
    return {{"room", SceneHash(*options.room)},
            {"camera", options.room->cameras[spec.camera].model.name}};
  }
  return {{"setup", spec.series->setup.ToJson()},
          {"series", spec.series->name},
          {"psi_deg", spec.psi_deg},
          {"placement", spec.placement}};
}

Json InputsOf(const HotspotStudyOptions& options) {
  const HotspotSamples& samples = options.shot.samples;
  return {{"seed", options.shot.seed},
          {"noise_seed", options.shot.noise_seed},
          {"spp", {samples.mask, samples.marker, samples.edge, samples.rest}},
          {"exposures", options.shot.exposures},
          {"powers", options.shot.powers}};
}

// Indirect light makes a room noisier than a mask alone.
HotspotSamples RoomSamples(HotspotSamples samples) {
  samples.mask *= 16;
  return samples;
}

Json RunTask(const ShotSpec& spec, const HotspotStudyOptions& options, const fs::path& folder) {
  const std::string name = NameOf(spec, options);
  const bool room = spec.series == nullptr;
  const HotspotSamples samples = room ? RoomSamples(options.shot.samples) : options.shot.samples;
  // Placements differ in their paths, too, so that their scatter holds the render's noise.
  const uint64_t seed =
      CombineKeys(options.shot.seed, HashBytes(fmt::format("placement {}", spec.placement)));
  const HotspotStage stage(
      room ? *options.room
           : HotspotScene(spec.series->setup, spec.psi_deg, spec.placement, options.shot.seed),
      spec.camera, samples, seed);
  HotspotShot shot = ShootHotspots(stage, HotspotMixes(options.shot.powers), options.shot, name);
  if (!room) shot.depths = DepthsOfHighlights(stage, stage.scene.cameras[1], samples, seed);
  const bool keep = room || spec.placement == 0;
  return {{"shot", shot},
          {"kept", keep ? KeepHotspotPictures(stage, {"both", 1.0, 1.0}, name,
                                              options.shot.noise_seed, folder)
                        : Json::array()}};
}

std::vector<HotspotSeries> SeriesOf(const HotspotStudyOptions& options) {
  std::vector<HotspotSeries> series = {{"default", "as set up", options.setup, {}, {}}};
  for (const std::string& name : options.variations) {
    const auto& all = HotspotVariations();
    const auto found = std::find_if(all.begin(), all.end(), [&](const HotspotVariation& variation) {
      return variation.name == name;
    });
    if (found == all.end()) {
      std::vector<std::string> names;
      for (const HotspotVariation& variation : all) names.emplace_back(variation.name);
      throw InputError(
          fmt::format("variation: found '{}'; expected one of {}", name, JoinNames(names)));
    }
    HotspotSetup setup = options.setup;
    found->change(setup);
    series.push_back({found->name, found->description, setup, {}, {}});
  }
  for (const HotspotSeries& one : series) one.setup.Check();
  return series;
}

const std::vector<double>& AnglesOf(const HotspotSeries& series,
                                    const HotspotStudyOptions& options) {
  return series.name == "default" ? options.angles_deg : options.variation_angles_deg;
}

std::vector<ShotSpec> SpecsOf(const std::vector<HotspotSeries>& series,
                              const HotspotStudyOptions& options) {
  std::vector<ShotSpec> specs;
  for (size_t c = 0; options.room && c < options.room->cameras.size(); ++c)
    specs.push_back({nullptr, 0.0, 0, c});
  for (const HotspotSeries& one : series) {
    for (const double psi_deg : AnglesOf(one, options)) {
      for (int placement = 0; placement < options.placements; ++placement)
        specs.push_back({&one, psi_deg, placement, 0});
    }
  }
  return specs;
}

void Check(const HotspotStudyOptions& options) {
  for (const auto* angles : {&options.angles_deg, &options.variation_angles_deg}) {
    for (size_t i = 0; i < angles->size(); ++i) {
      if ((*angles)[i] < 1.0 || (*angles)[i] > 170.0 || (i > 0 && (*angles)[i] <= (*angles)[i - 1]))
        throw InputError(fmt::format(
            "angles: found {}; expected ascending separations of 1 to 170 degrees", (*angles)[i]));
    }
  }
}

}  // namespace

const HotspotMix& HotspotStudy::Mix(const std::string& name) const {
  const auto found = std::find_if(mixes.begin(), mixes.end(),
                                  [&](const HotspotMix& mix) { return mix.name == name; });
  RETROLUX_CHECK(found != mixes.end(), "no mix {}", name);
  return *found;
}

HotspotStudy RunHotspotStudy(const HotspotStudyOptions& chosen, const fs::path& folder,
                             Progress& progress) {
  HotspotStudy study;
  study.options = chosen;
  HotspotStudyOptions& options = study.options;
  Check(options);
  if (options.room) options.room = HotspotRoom(*options.room);
  study.mixes = HotspotMixes(options.shot.powers);
  study.series = SeriesOf(options);
  EnsureWritableFolder(folder / "pictures");
  const std::vector<ShotSpec> specs = SpecsOf(study.series, options);
  std::vector<Task> tasks;
  for (const ShotSpec& spec : specs)
    tasks.push_back({NameOf(spec, options), DefinitionOf(spec, options)});
  TaskManifest manifest(folder, "hotspot", InputsOf(options));
  TaskLoop loop;
  loop.parallel = false;
  loop.usable = [&](const Json& result) { return KeptPicturesAreThere(result, folder); };
  const std::vector<Json> results = manifest.Run(
      "pictures", tasks, [&](size_t task) { return RunTask(specs[task], options, folder); },
      progress, loop);
  if (options.placement) {
    study.placement = RunHotspotPlacement(*options.placement, options.setup, options.shot, manifest,
                                          folder, progress);
  }
  study.tasks = manifest.Report();
  size_t next = 0;
  for (; next < specs.size() && !specs[next].series; ++next) {
    study.room.push_back({options.room->cameras[specs[next].camera].model.name,
                          RowOf(0.0, {results[next].at("shot").get<HotspotShot>()}, study.mixes),
                          KeptHotspotPictures(results[next])});
  }
  for (HotspotSeries& series : study.series) {
    for (const double psi_deg : AnglesOf(series, options)) {
      series.pictures.push_back(KeptHotspotPictures(results[next]));
      std::vector<HotspotShot> shots;
      for (int placement = 0; placement < options.placements; ++placement)
        shots.push_back(results[next++].at("shot").get<HotspotShot>());
      series.rows.push_back(RowOf(psi_deg, std::move(shots), study.mixes));
    }
  }
  return study;
}

}  // namespace retrolux
