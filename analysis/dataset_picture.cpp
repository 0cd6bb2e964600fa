#include "analysis/dataset_picture.h"

#include <chrono>

#include "analysis/picture_labels.h"
#include "analysis/sparse_film.h"
#include "core/atomic_file.h"
#include "core/hash.h"
#include "core/image_file.h"
#include "renderer/exposure.h"
#include "renderer/lens_scatter.h"
#include "renderer/render_files.h"
#include "renderer/sensor.h"
#include "scenes/scene_json.h"

namespace retrolux {

using Json = nlohmann::json;

namespace {

// Adds the time from its making, or from the last call, to one of RecordTimes.
class Clock {
 public:
  void AddTo(std::atomic<double>& sum) {
    const auto now = std::chrono::steady_clock::now();
    sum += std::chrono::duration<double>(now - start_).count();
    start_ = now;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

Json RowByRow(const Mat3d& r) {
  return {r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)};
}

// What all cameras of a scene share.
struct Stage {
  const DrawnScene& drawn;
  const RecordOptions& options;
  RayScene rays;
  std::vector<LabelledMarker> markers;
  std::vector<PlacedMarker> placed;

  Stage(const DrawnScene& drawn_scene, const RecordOptions& record_options)
      : drawn(drawn_scene),
        options(record_options),
        rays(drawn_scene.scene),
        markers(LabelledMarkers(drawn_scene.scene, rays)),
        placed(PlaceMarkers(drawn_scene.scene)) {}
};

TraceOptions Tracing(const Stage& stage) {
  TraceOptions trace;
  trace.samples_per_pixel = stage.options.samples_per_pixel;
  trace.seed = CombineKeys(stage.options.seed, HashBytes(stage.drawn.name));
  trace.own_ray_share = kStrongGroups;
  return trace;
}

SparseSamples SamplesOf(const RecordOptions& options) {
  const int n = options.samples_per_pixel;
  return {n, 2 * n, 4 * n};
}

void WriteExrOf(const Stage& stage, const CameraSpec& camera, const IdBuffers& ids,
                const Film& film, double exposure_s, const std::filesystem::path& file) {
  const Scene& scene = stage.drawn.scene;
  ShotInfo info;
  info.scene_name = scene.name;
  info.scene_hash = SceneHash(scene);
  info.seed = info.noise_seed = stage.options.seed;
  info.samples_per_pixel = stage.options.samples_per_pixel;
  info.edge_samples_per_pixel = SamplesOf(stage.options).marker;
  info.exposure_s = exposure_s;
  WriteExr(file,
           ShotExr(camera, ids, &film, info, stage.rays.BodyNames(), stage.placed, scene.markers));
}

DatasetPicture Record(const Stage& stage, const CameraSpec& camera,
                      const std::filesystem::path& folder, RecordTimes& times) {
  const Scene& scene = stage.drawn.scene;
  const std::string stem = stage.drawn.name + "_" + camera.model.name;
  DatasetPicture picture;
  picture.camera = camera.model.name;
  picture.file = "images/" + stem + ".png";
  picture.model = camera.model;
  picture.bits = camera.sensor.adc_bits;
  picture.exposure_s = ExposureSeconds(scene, camera);

  Clock clock;
  const IdBuffers ids = RenderIds(stage.rays, camera.model, stage.placed);
  clock.AddTo(times.geometry);
  const Lights lights(scene, stage.rays, stage.drawn.rings, camera.model.name);
  const CameraResponse response(camera, lights.Spectra(), picture.exposure_s);
  const PathTracer tracer(scene, stage.rays, lights, response, stage.placed, Tracing(stage));
  SparseFilm sparse = RenderSparseFilm(tracer, scene, camera, ids, picture.exposure_s,
                                       SamplesOf(stage.options), lights.GroupNames());
  LensScatter(camera, response.MeanWavelength_nm()).Apply(sparse.film);
  times.paths += sparse.paths;
  times.traced_pixels += sparse.traced_pixels;
  times.pixels += static_cast<int64_t>(camera.model.width) * camera.model.height;
  clock.AddTo(times.trace);
  const DigitalImage digital = Sensor(camera).Expose(sparse.film.electrons, picture.exposure_s,
                                                     NoiseKey(stage.options.seed, stem));
  clock.AddTo(times.sensor);
  const std::string png = EncodeGreyPng(digital);
  picture.hash = HexHash(HashBytes(png));
  clock.AddTo(times.encode);
  WriteTextFile(folder / picture.file, png);
  if (stage.options.keep_exr) {
    const std::filesystem::path exr = folder / "exr" / (stem + ".exr");
    WriteExrOf(stage, camera, ids, sparse.film, picture.exposure_s, exr);
    picture.exr_hash = HexHash(HashBytes(ReadTextFile(exr)));
  }
  clock.AddTo(times.write);
  ++times.pictures;
  picture.markers =
      LabelPicture(stage.markers, stage.rays, camera, ids, sparse.film, picture.exposure_s);
  clock.AddTo(times.labels);
  return picture;
}

}  // namespace

Json DatasetPicture::ToJson() const {
  Json labels = Json::array();
  for (const MarkerLabel& label : markers) labels.push_back(label.ToJson());
  const Vec3d& t = model.camera_from_world.translation;
  Json json = {{"camera", camera},
               {"file", file},
               {"hash", hash},
               {"width_px", model.width},
               {"height_px", model.height},
               {"camera_matrix", {model.fx, 0, model.cx, 0, model.fy, model.cy, 0, 0, 1}},
               {"distortion", model.distortion.Coefficients()},
               {"R_camera_from_world", RowByRow(model.camera_from_world.rotation)},
               {"t_camera_from_world_mm", {t.x(), t.y(), t.z()}},
               {"bits", bits},
               {"exposure_s", exposure_s},
               {"markers", labels}};
  if (!exr_hash.empty()) json["exr_hash"] = exr_hash;
  return json;
}

DatasetPicture DatasetPicture::FromJson(const Json& json) {
  DatasetPicture picture;
  picture.camera = json.at("camera");
  picture.file = json.at("file");
  picture.hash = json.at("hash");
  picture.exr_hash = json.value("exr_hash", "");
  CameraModel& model = picture.model;
  model.name = picture.camera;
  model.width = json.at("width_px");
  model.height = json.at("height_px");
  const Json& k = json.at("camera_matrix");
  model.fx = k[0];
  model.cx = k[2];
  model.fy = k[4];
  model.cy = k[5];
  const Json& d = json.at("distortion");
  model.distortion = Distortion(d[0], d[1], d[2], d[3], d[4]);
  const Json& r = json.at("R_camera_from_world");
  for (Eigen::Index i = 0; i < 9; ++i)
    model.camera_from_world.rotation(i / 3, i % 3) = r[static_cast<size_t>(i)];
  const Json& t = json.at("t_camera_from_world_mm");
  model.camera_from_world.translation = Vec3d(t[0], t[1], t[2]);
  picture.bits = json.at("bits");
  picture.exposure_s = json.at("exposure_s");
  for (const Json& label : json.at("markers"))
    picture.markers.push_back(MarkerLabel::FromJson(label));
  return picture;
}

std::vector<DatasetPicture> RecordScene(const DrawnScene& drawn, const RecordOptions& options,
                                        const std::filesystem::path& folder, RecordTimes& times) {
  Clock clock;
  const Stage stage(drawn, options);
  clock.AddTo(times.geometry);
  std::vector<DatasetPicture> pictures;
  for (const std::string& name : drawn.cameras)
    pictures.push_back(Record(stage, drawn.scene.Camera(name), folder, times));
  return pictures;
}

}  // namespace retrolux
