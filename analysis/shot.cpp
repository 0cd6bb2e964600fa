#include "analysis/shot.h"

#include "core/atomic_file.h"
#include "renderer/edge_pixels.h"
#include "renderer/exposure.h"
#include "renderer/lens_scatter.h"
#include "renderer/sensor.h"
#include "scenes/scene_json.h"

namespace retrolux {

namespace {

std::vector<const CameraSpec*> ChosenCameras(const Scene& scene,
                                             const std::vector<std::string>& names) {
  std::vector<const CameraSpec*> cameras;
  if (names.empty()) {
    for (const CameraSpec& camera : scene.cameras) cameras.push_back(&camera);
  }
  for (const std::string& name : names) cameras.push_back(&scene.Camera(name));
  return cameras;
}

int EdgeSamples(const ShotOptions& options) {
  constexpr int kMore = 4;
  return options.edge_samples_per_pixel > 0 ? options.edge_samples_per_pixel
                                            : kMore * options.trace.samples_per_pixel;
}

Plane<int> SamplesOf(const IdBuffers& ids, const CameraModel& camera, const ShotInfo& info) {
  const Plane<uint8_t> edges = EdgePixels(ids, camera);
  Plane<int> samples(camera.width, camera.height, info.samples_per_pixel);
  for (size_t i = 0; i < edges.data.size(); ++i) {
    if (edges.data[i] != 0) samples.data[i] = info.edge_samples_per_pixel;
  }
  return samples;
}

}  // namespace

std::vector<std::string> RenderShot(const Scene& scene, const ShotOptions& options,
                                    const std::filesystem::path& folder, Progress& progress) {
  const std::vector<const CameraSpec*> cameras = ChosenCameras(scene, options.cameras);
  ShotInfo info{scene.name,
                SceneHash(scene),
                scene.poses.empty() ? "" : scene.poses.front().name,
                options.trace.seed,
                options.noise_seed,
                options.ids_only ? 0 : options.trace.samples_per_pixel,
                options.ids_only ? 0 : EdgeSamples(options),
                0.0};
  std::vector<double> exposures_s;
  for (const CameraSpec* camera : cameras)
    exposures_s.push_back(options.ids_only ? 0.0 : ExposureSeconds(scene, *camera));

  EnsureWritableFolder(folder);

  const RayScene rays(scene);
  const std::vector<PlacedMarker> markers = PlaceMarkers(scene);
  std::vector<MarkerSurface> surfaces;
  for (const PlacedMarker& marker : markers) surfaces.push_back(SampleMarkerSurface(rays, marker));

  int64_t pixels = 0;
  for (const CameraSpec* camera : cameras)
    pixels += static_cast<int64_t>(camera->model.width) * camera->model.height;
  progress.Begin("render", pixels, "px");
  std::vector<std::string> files;
  std::vector<CameraTruth> truths;
  std::vector<CameraModel> models;
  for (size_t c = 0; c < cameras.size(); ++c) {
    const CameraSpec& camera = *cameras[c];
    const std::string& name = camera.model.name;
    info.exposure_s = exposures_s[c];
    const IdBuffers ids = RenderIds(rays, camera.model, markers);
    std::optional<Film> film;
    if (!options.ids_only) {
      const Lights lights(scene, rays, options.rings, name);
      const CameraResponse response(camera, lights.Spectra(), exposures_s[c]);
      const PathTracer tracer(scene, rays, lights, response, markers, options.trace);
      film.emplace(RenderFilm(tracer, camera.model, SamplesOf(ids, camera.model, info),
                              lights.GroupNames(), progress));
      LensScatter(camera, response.MeanWavelength_nm()).Apply(*film);
    }
    WriteExr(folder / (name + ".exr"), ShotExr(camera, ids, film ? &*film : nullptr, info,
                                               rays.BodyNames(), markers, scene.markers));
    files.push_back(name + ".exr");
    if (film) {
      WritePng(folder / (name + ".png"), Sensor(camera).Expose(film->electrons, exposures_s[c],
                                                               NoiseKey(options.noise_seed, name)));
      files.push_back(name + ".png");
    }
    CameraTruth truth{name, {}};
    for (size_t m = 0; m < markers.size(); ++m) {
      truth.views.push_back(ViewMarker(surfaces[m], rays, camera.model));
      if (film)
        truth.views.back().centroid_radiometric_px =
            RadiometricCentroid(*film, markers[m].instance, camera.sensor);
    }
    truths.push_back(std::move(truth));
    models.push_back(camera.model);
  }
  progress.End();
  WriteTextFile(folder / "truth.json",
                TruthJson(truths, markers, scene.markers, scene, info).dump(2) + "\n");
  WriteTextFile(folder / "cameras.yml", CamerasYaml(models));
  files.insert(files.end(), {"truth.json", "cameras.yml"});
  return files;
}

}  // namespace retrolux
