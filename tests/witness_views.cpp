#include "tests/witness_views.h"

#include <algorithm>
#include <cmath>

#include "analysis/signal_noise.h"
#include "analysis/sparse_film.h"
#include "core/json_reader.h"
#include "renderer/exposure.h"
#include "renderer/lens_scatter.h"
#include "renderer/marker_truth.h"
#include "renderer/sensor.h"
#include "scenes/masks.h"
#include "scenes/mesh_shapes.h"
#include "scenes/scene_parts.h"
#include "tests/drawn_markers.h"

namespace retrolux {

namespace {

constexpr double kFocal_px = 3000.0;
constexpr double kPanel_mm = 4000.0;
constexpr int kMargin_px = 14;

int HalfWindow_px(const TagView& view) {
  const double half_diagonal_px =
      std::sqrt(0.5) * view.size_mm * kFocal_px / (view.distance_mm - view.size_mm);
  return static_cast<int>(std::ceil(half_diagonal_px)) + kMargin_px;
}

Scene GroundScene(const TagView& view) {
  Scene scene;
  scene.name = "tag";
  if (view.ground == TagGround::kOval) {
    AddObject(scene, "ground", MakeMask("oval"), "mask");
  } else {
    scene.materials["panel"] = ReadMaterial(
        "panel", JsonReader::FromText(R"({"type": "diffuse", "reflectance": 0.04})", "panel.json"));
    AddObject(scene, "ground",
              RectangleMesh({0, -0.5 * kPanel_mm, -0.5 * kPanel_mm}, {0, kPanel_mm, 0},
                            {0, 0, kPanel_mm}),
              "panel");
  }
  scene.UseMaterial(view.sheeting);
  scene.exposure.marker_material = view.sheeting;
  scene.exposure.distance_mm = view.distance_mm;
  scene.exposure.fraction = view.full_scales;
  scene.marker_set =
      std::make_shared<const MarkerSet>(MakeTagSet(*view.family, {view.id}, view.size_mm));
  const double x_mm = view.ground == TagGround::kOval ? 100.0 : 0.0;
  scene.markers.push_back(
      {"tag", view.id, "ground", Vec3d(x_mm, 0, 0), view.tag_roll_deg, view.sheeting});
  return scene;
}

// The camera sees the tag's middle, on +x, at `at_px`.
CameraSpec CameraOf(const TagView& view, const Vec3d& middle) {
  const double tilt = RadFromDeg(view.incidence_deg), azimuth = RadFromDeg(view.azimuth_deg);
  const Vec3d towards(std::cos(tilt), std::sin(tilt) * std::cos(azimuth),
                      std::sin(tilt) * std::sin(azimuth));
  const Vec3d up = std::abs(towards.z()) < 0.9 ? Vec3d::UnitZ() : Vec3d::UnitY();
  CameraSpec camera = ThesisCamera("camera", middle + view.distance_mm * towards, up);
  CameraModel& model = camera.model;
  model.fx = model.fy = kFocal_px;
  model.distortion = {view.distortion_k1, 0.0, 0.0, 0.0, 0.0};
  camera.sensor.serial = std::to_string(view.seed);
  if (view.blooming) camera.sensor.blooming = Blooming{};
  if (view.blur_px > 0.0) {
    // A point at d becomes fx A (1/s - 1/d) px wide if the lens with aperture A is focused at s <
    // d.
    const double aperture_mm = 2.0 * camera.lens.ApertureRadius_mm();
    camera.lens.focus_distance_mm =
        1.0 / (1.0 / view.distance_mm + view.blur_px / (kFocal_px * aperture_mm));
  }
  const Vec3d sight = model.PlanePoint(view.at_px)->homogeneous();
  const Mat3d turn =
      Eigen::Quaterniond::FromTwoVectors(Vec3d::UnitZ(), sight).toRotationMatrix() *
      Eigen::AngleAxisd(RadFromDeg(view.camera_roll_deg), Vec3d::UnitZ()).toRotationMatrix();
  const RigidTransform upright = LookAt(middle + view.distance_mm * towards, middle, up);
  model.camera_from_world = RigidTransform{turn, Vec3d::Zero()} * upright;
  return camera;
}

// The same camera with the pixels around `at_px` only.
void Crop(const TagView& view, CameraModel& model) {
  const int half = HalfWindow_px(view);
  model.width = model.height = 2 * half + 1;
  model.cx -= std::round(view.at_px.x()) - half;
  model.cy -= std::round(view.at_px.y()) - half;
}

void MarkTruth(const TagView& view, const CameraModel& camera, const RayScene& rays,
               const PlacedMarker& tag, TagPicture& picture) {
  const std::array<Vec2d, 4> square = DarkSquare(*view.family, view.size_mm);
  for (size_t k = 0; k < 4; ++k) {
    const Vec3d corner = OntoSurface(rays, tag, square[k])->position.cast<double>();
    picture.corners_px[k] = *camera.Project(corner);
  }
  picture.middle_px = *camera.Project(tag.CentreInWorld());
  picture.tilt = (camera.camera_from_world.rotation * tag.NormalInWorld()).head<2>().normalized();
}

// Bright cells: pixels that show nothing else; without any, the brightest. Ground: the picture's
// first row.
void MarkLevels(const Film& film, const CameraSpec& camera, double exposure_s,
                TagPicture& picture) {
  double bright = 0.0, ground = 0.0, brightest = 0.0;
  int count = 0;
  for (size_t i = 0; i < film.electrons.data.size(); ++i) {
    const double signal = static_cast<double>(film.electrons.data[i]);
    brightest = std::max(brightest, signal);
    if (film.marker_weight[0].data[i] < 0.999f) continue;
    bright += signal;
    ++count;
  }
  bright = count > 0 ? bright / count : brightest;
  for (int x = 0; x < film.electrons.width; ++x)
    ground += static_cast<double>(film.electrons(x, 0)) / film.electrons.width;
  picture.contrast_dn = (bright - ground) * GainDnPerElectron(camera.sensor);
  picture.snr = (bright - ground) / NoiseSigma_e(camera.sensor, exposure_s, bright);
}

}  // namespace

double TagView::FrontalCell_px() const {
  return kFocal_px * size_mm / family->cells / distance_mm;
}

std::vector<TagView> RandomViews(const TagView& like, int count, uint64_t seed) {
  std::vector<TagView> views;
  for (int i = 0; i < count; ++i) {
    KeyedRng rng(CombineKeys(seed, static_cast<uint64_t>(i)));
    TagView view = like;
    view.id = 1 + static_cast<int>(rng.NextDouble() * 9.0);
    view.azimuth_deg = 360.0 * rng.NextDouble();
    view.tag_roll_deg = 360.0 * rng.NextDouble();
    view.camera_roll_deg = 360.0 * rng.NextDouble();
    view.at_px = Vec2d(80.0 + 480.0 * rng.NextDouble(), 80.0 + 320.0 * rng.NextDouble());
    view.seed = rng.NextBits();
    views.push_back(view);
  }
  return views;
}

TagPicture RenderTag(const TagView& view) {
  Scene scene = GroundScene(view);
  const Vec3d middle = PlaceMarker(scene, scene.markers[0], 1).CentreInWorld();
  scene.cameras.push_back(CameraOf(view, middle));
  CameraSpec& camera = scene.cameras[0];
  Crop(view, camera.model);
  const RayScene rays(scene);
  const std::vector<PlacedMarker> tags = PlaceMarkers(scene);
  const double exposure_s = ExposureSeconds(scene, camera);
  const IdBuffers ids = RenderIds(rays, camera.model, tags);
  const Lights lights(scene, rays, RingChoice::kOwn, camera.model.name);
  const CameraResponse response(camera, lights.Spectra(), exposure_s);
  TraceOptions trace;
  trace.seed = view.seed;
  trace.own_ray_share = kStrongGroups;
  trace.roulette = 0.5f;
  const PathTracer tracer(scene, rays, lights, response, tags, trace);
  // The paths' scatter counts as noise to a threshold half way between the darkest and the
  // brightest neighbour: with 8 paths a pixel it makes dark squares 0.007 px larger.
  SparseFilm sparse =
      RenderSparseFilm(tracer, scene, camera, ids, exposure_s, {32, 16, 64}, lights.GroupNames());
  LensScatter(camera, response.MeanWavelength_nm()).Apply(sparse.film);
  TagPicture picture;
  picture.image = Sensor(camera).Expose(sparse.film.electrons, exposure_s, Mix64(view.seed));
  MarkTruth(view, camera.model, rays, tags[0], picture);
  MarkLevels(sparse.film, camera, exposure_s, picture);
  return picture;
}

TagPicture DrawTag(const TagView& view, double contrast_dn, double ground_dn) {
  // As the default sensor: 30,000 e- fill 8 bits; black level, read noise, unequal pixels.
  constexpr double kGain = 255.0 / 30000.0, kBlack_dn = 3.0, kRead_dn = 22.0 * kGain;
  constexpr double kPattern = 0.01;
  const int half = HalfWindow_px(view), side = 2 * half + 1;
  MarkerPose pose;
  pose.focal_px = kFocal_px;
  pose.tilt_deg = view.incidence_deg;
  pose.azimuth_deg = view.azimuth_deg;
  pose.roll_deg = view.tag_roll_deg;
  pose.distance_mm = view.distance_mm;
  const Vec2d behind_point = view.at_px - view.at_px.array().floor().matrix();
  pose.at_px = Vec2d(half, half) + behind_point;
  const PosedMarker marker(pose, side, side);
  const Plane<uint8_t> cells = view.family->pattern(view.id);
  DrawnPicture drawn(side, side, ground_dn);
  drawn.Lay(marker.Box(std::sqrt(0.5) * view.size_mm), 0.0,
            [&](const Vec2d& px) -> std::optional<double> {
              const Vec2d at = marker.Meet(px)->in_marker / view.size_mm;
              if (at.cwiseAbs().maxCoeff() >= 0.5) return std::nullopt;
              const int column = static_cast<int>((at.x() + 0.5) * cells.width);
              const int row = static_cast<int>((0.5 - at.y()) * cells.height);
              if (cells(column, std::min(row, cells.height - 1)) == 0) return std::nullopt;
              return ground_dn + contrast_dn;
            });
  for (double& v : drawn.mean().data) v += kBlack_dn;
  TagPicture picture;
  picture.image = drawn.Digitise(kRead_dn, kGain, kPattern, view.seed);
  const std::array<Vec2d, 4> square = DarkSquare(*view.family, view.size_mm);
  for (size_t k = 0; k < 4; ++k) picture.corners_px[k] = marker.Project(square[k]);
  picture.middle_px = marker.Project(Vec2d::Zero());
  const double azimuth = RadFromDeg(view.azimuth_deg);
  picture.tilt = Vec2d(std::cos(azimuth), -std::sin(azimuth));
  const double bright_dn = ground_dn + contrast_dn;
  picture.contrast_dn = contrast_dn;
  picture.snr = contrast_dn / std::sqrt(kRead_dn * kRead_dn + kGain * bright_dn +
                                        std::pow(kPattern * bright_dn, 2.0));
  return picture;
}

WitnessResult Witness(const TagFinder& finder, const std::vector<TagView>& views,
                      const std::vector<TagPicture>& pictures) {
  constexpr double kMinTilt_deg = 10.0;
  WitnessResult result;
  std::vector<PlaceError> corners;
  std::vector<double> u, v, outward, tilt;
  for (size_t i = 0; i < pictures.size(); ++i) {
    const TagPicture& picture = pictures[i];
    ++result.pictures;
    result.contrast_dn += picture.contrast_dn / static_cast<double>(pictures.size());
    result.snr += picture.snr / static_cast<double>(pictures.size());
    bool found = false;
    for (const FoundTag& tag : finder.find(picture.image)) {
      if (found || tag.id != views[i].id) {
        ++result.wrong;
        continue;
      }
      found = true;
      ++result.found;
      const bool is_tilted = views[i].incidence_deg >= kMinTilt_deg;
      Vec2d mean = Vec2d::Zero();
      double mean_outward = 0.0;
      for (size_t k = 0; k < 4; ++k) {
        PlaceError corner{tag.corners_px[k] - picture.corners_px[k], std::nullopt,
                          (picture.corners_px[k] - picture.middle_px).normalized()};
        if (is_tilted) corner.tilt = picture.tilt;
        mean += 0.25 * corner.error;
        mean_outward += 0.25 * corner.error.dot(*corner.outward);
        corners.push_back(corner);
      }
      u.push_back(mean.x());
      v.push_back(mean.y());
      outward.push_back(mean_outward);
      if (is_tilted) tilt.push_back(mean.dot(picture.tilt));
    }
  }
  result.corners = PlaceErrorsOf(corners);
  result.u = ScalarErrorsOf(u);
  result.v = ScalarErrorsOf(v);
  result.outward = ScalarErrorsOf(outward);
  result.tilt = ScalarErrorsOf(tilt);
  return result;
}

}  // namespace retrolux
