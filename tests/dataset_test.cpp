// Labelled image sets: how scenes are drawn, what is traced, and the labels, read back with OpenCV
// and with this file's own decoder of COCO's masks.
#include "analysis/dataset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <set>

#include "analysis/bop.h"
#include "analysis/coco.h"
#include "analysis/dataset_csv.h"
#include "analysis/dataset_merge.h"
#include "analysis/picture_labels.h"
#include "analysis/signal_noise.h"
#include "analysis/sparse_film.h"
#include "core/atomic_file.h"
#include "core/image_file.h"
#include "renderer/exposure.h"
#include "scenes/built_in.h"
#include "scenes/marker_placement.h"
#include "scenes/mesh_shapes.h"
#include "scenes/scene_json.h"
#include "scenes/scene_parts.h"
#include "tests/message_of.h"
#include "tests/own_folder.h"

namespace retrolux {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using ::testing::HasSubstr;

// Everything that can be drawn, as often as not, in tiny pictures.
constexpr const char* kTiny = R"({
  "schema": "retrolux/dataset-1", "name": "tiny", "licence": "CC0-1.0", "seed": 7, "scenes": 4,
  "spp": 2, "splits": {"train": 0.5, "test": 0.5},
  "masks": [{"mesh": "oval"}, {"mesh": "face"}],
  "views": [{"kind": "free", "weight": 3, "cameras": 2, "distance_mm": [1200, 1600], "incidence_deg": [0, 60]},
            {"kind": "vault", "cameras": 2, "rotation_deg": {"y": [20, 60], "z": [60, 120]}}],
  "markers": {"identifiable": 5, "standard": 2, "polarity": {"bright": 1, "dark": 1},
              "touching": 0.5, "at_rim": 0.5, "wear": [0, 0.5]},
  "recording": {"size_px": [200, 150], "sensor": {"default": 1, "icx414al": 1},
                "defocused": 0.5, "distortion_k1": [-0.2, 0.1]},
  "distractors": {"glints": {"probability": 0.5}, "strip": {"probability": 0.5},
                  "cables": {"probability": 0.7}, "second_ring": {"probability": 0.5},
                  "plate": {"probability": 0.7}}
})";

fs::path WriteConfig(const fs::path& folder, const std::string& text) {
  fs::create_directories(folder);
  WriteTextFile(folder / "given.json", text);
  return folder / "given.json";
}

// --- drawing ---

TEST(SceneDraw, OfTheFirst2ToTheKScenesEachHasAStratumOfItsOwn) {
  for (const char* name : {"view", "marker-1 roll"}) {
    for (const int scenes : {4, 64, 1024}) {
      std::set<int> strata;
      for (int i = 0; i < scenes; ++i) {
        const double u = SceneDraw(3, static_cast<uint32_t>(i)).Uniform(name);
        ASSERT_GE(u, 0.0);
        ASSERT_LT(u, 1.0);
        strata.insert(static_cast<int>(u * scenes));
      }
      EXPECT_EQ(strata.size(), static_cast<size_t>(scenes)) << name;
    }
  }
}

// Two names must not go together: the correlation of n independent pairs is normal about 0 with
// sigma 1 / sqrt(n); stratified ones scatter less. Limit 5 sigma.
TEST(SceneDraw, NamesAreIndependentOfEachOther) {
  constexpr int kScenes = 4096;
  double sum = 0.0;
  for (uint32_t i = 0; i < kScenes; ++i) {
    const SceneDraw draw(3, i);
    sum += 12.0 * (draw.Uniform("exposure") - 0.5) * (draw.Uniform("ambient") - 0.5);
  }
  EXPECT_LT(std::abs(sum / kScenes), 5.0 / std::sqrt(kScenes));
}

TEST(SceneDraw, RangesAndWeights) {
  EXPECT_DOUBLE_EQ((Range{2.0, 6.0, false}.At(0.25)), 3.0);
  EXPECT_NEAR((Range{1.0, 100.0, true}.At(0.5)), 10.0, 1e-12);
  EXPECT_EQ(PickWeighted({1.0, 0.0, 3.0}, 0.2499), 0u);
  EXPECT_EQ(PickWeighted({1.0, 0.0, 3.0}, 0.2501), 2u);
  EXPECT_EQ(PickWeighted({1.0, 0.0}, 0.9999), 0u);
}

TEST(DatasetConfig, TellsWhatIsWrong) {
  const auto message = [&](const std::string& what, const std::string& by) {
    std::string text = kTiny;
    text.replace(text.find(what), what.size(), by);
    const fs::path file = WriteConfig(OwnFolder(), text);
    return MessageOf([&] { DatasetScenes(ReadDatasetConfig(file)).Draw(0); });
  };
  EXPECT_THAT(message("\"spp\"", "\"ssp\""), HasSubstr("the unknown key 'ssp'"));
  EXPECT_THAT(message("[1200, 1600]", "[1600, 1200]"), HasSubstr("the smaller number first"));
  EXPECT_THAT(message("0.5, \"test\": 0.5", "0.5, \"test\": 0.4"),
              HasSubstr("shares that add up to 1"));
  EXPECT_THAT(message("\"oval\"", "\"ovals\""), HasSubstr("ovals"));
  EXPECT_THAT(message("\"icx414al\"", "\"icx4\""), HasSubstr("/recording/sensor"));
}

TEST(DatasetScenes, ASceneFollowsFromItsNumberAlone) {
  const fs::path file = WriteConfig(OwnFolder(), kTiny);
  const DatasetScenes scenes(ReadDatasetConfig(file));
  std::vector<std::string> hashes;
  for (int i = 0; i < 4; ++i) hashes.push_back(SceneHash(scenes.Draw(i).scene));
  EXPECT_EQ(std::set<std::string>(hashes.begin(), hashes.end()).size(), 4u);
  const DatasetScenes again(ReadDatasetConfig(file));
  for (int i = 3; i >= 0; --i)
    EXPECT_EQ(SceneHash(again.Draw(i).scene), hashes[static_cast<size_t>(i)]);
}

// Further scenes, and a nuisance that was not drawn before, leave what was drawn as it is.
TEST(DatasetScenes, ANewNuisanceMovesNoOther) {
  const DrawnScene before =
      DatasetScenes(ReadDatasetConfig(WriteConfig(OwnFolder(), kTiny))).Draw(1);
  std::string text = kTiny;
  const std::string old = "\"defocused\": 0.5";
  text.replace(text.find(old), old.size(), "\"defocused\": 0.5, \"ambient\": [1, 5]");
  const DrawnScene after = DatasetScenes(ReadDatasetConfig(WriteConfig(OwnFolder(), text))).Draw(1);
  Json expected = before.nuisances;
  EXPECT_NE(expected["ambient"], after.nuisances["ambient"]);
  expected["ambient"] = after.nuisances["ambient"];
  EXPECT_EQ(after.nuisances, expected);
}

TEST(DatasetScenes, MarkersLieApartAndWhereACameraCanSeeThem) {
  std::string text = kTiny;
  for (const auto& [what, by] : {std::pair("\"touching\": 0.5", "\"touching\": 0.0"),
                                 std::pair("\"scenes\": 4", "\"scenes\": 12")})
    text.replace(text.find(what), std::string(what).size(), by);
  const DatasetScenes scenes(ReadDatasetConfig(WriteConfig(OwnFolder(), text)));
  for (int i = 0; i < 12; ++i) {
    const DrawnScene drawn = scenes.Draw(i);
    const std::vector<PlacedMarker> markers = PlaceMarkers(drawn.scene);
    ASSERT_GE(markers.size(), 2u);
    for (size_t a = 0; a < markers.size(); ++a) {
      double best = -1.0;
      for (const std::string& name : drawn.cameras) {
        const Vec3d to = drawn.scene.Camera(name).model.Centre() - markers[a].CentreInWorld();
        best = std::max(best, to.normalized().dot(markers[a].NormalInWorld()));
      }
      EXPECT_GE(best, std::cos(RadFromDeg(75.0)) - 1e-6);
      for (size_t b = 0; b < a; ++b) {
        const double radius =
            markers[a].dark ? 10.5 * std::numbers::sqrt2 : markers[a].shape->Radius();
        const double other =
            markers[b].dark ? 10.5 * std::numbers::sqrt2 : markers[b].shape->Radius();
        EXPECT_GE((markers[a].CentreInWorld() - markers[b].CentreInWorld()).norm(),
                  radius + other + 3.0 - 1e-6);
      }
    }
  }
}

// --- masks ---

// The example of COCO's own C code (maskApi): 9 x 10 px.
TEST(RunLengths, ReadAndWriteCocosString) {
  const std::vector<uint32_t> counts = {6, 1, 40, 4, 5, 4, 5, 4, 21};
  const Json json = RunsToJson({10, 9, counts});
  EXPECT_EQ(json, (Json{{"size", {9, 10}}, {"counts", "61X13mN000`0"}}));
  EXPECT_EQ(RunsFromJson(json).counts, counts);
}

TEST(RunLengths, GoDownTheColumns) {
  MaskPlane mask(3, 2, 0);
  mask(0, 1) = mask(1, 0) = mask(2, 1) = 1;
  const RunLengths runs = EncodeRuns(mask);
  EXPECT_EQ(runs.counts, (std::vector<uint32_t>{1, 2, 2, 1}));
  EXPECT_EQ(DecodeRuns(runs).data, mask.data);
  EXPECT_EQ(runs.Area(), 3);
  EXPECT_EQ(EncodeRuns(MaskPlane(2, 2, 1)).counts, (std::vector<uint32_t>{0, 4}));
}

TEST(MarkerLabel, FilledPolygonHoldsThePixelCentresInIt) {
  MaskPlane mask(20, 20, 0);
  const Polygon polygon = {{2.2, 3.1}, {15.7, 4.6}, {9.4, 17.3}, {8.0, 8.0}};
  FillPolygon(polygon, mask);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 20; ++x)
      EXPECT_EQ(mask(x, y) != 0, Contains(polygon, Vec2d(x, y))) << x << " " << y;
  }
}

TEST(MarkerLabel, LongSideOfATurnedRectangle) {
  const Eigen::Rotation2Dd turn(0.4);
  Polygon points;
  for (const Vec2d& p : {Vec2d(0, 0), Vec2d(9, 0), Vec2d(9, 4), Vec2d(0, 4), Vec2d(3, 2)})
    points.push_back(turn * p);
  EXPECT_NEAR(LongSide(points), 9.0, 1e-9);
}

// A marker under a cable is there all the same: what the cable hides counts as hidden.
TEST(MarkerTruth, WhatLiesOverAMarkerHidesIt) {
  Scene scene = OvalScene();
  scene.markers = {{"m", 2, "mask", Vec3d(100, 0, 0)}};
  const auto fraction = [&] {
    const RayScene rays(scene);
    const MarkerSurface surface =
        SampleMarkerSurface(rays, PlaceMarker(scene, scene.markers[0], 1));
    return ViewMarker(surface, rays, scene.cameras[0].model).visible_fraction;
  };
  EXPECT_EQ(fraction(), 1.0);
  // Over the half y < 0 of the trapezoid (x = -y is to the right): 2 mm above the surface.
  AddObject(scene, "plate", RectangleMesh({102, -30, -30}, {0, 30, 0}, {0, 0, 60}), "black");
  // The marker's x axis is -y or y, so one half of 15 x 11 mm: (7.5 x 15) of 195 mm2, or the rest.
  const double hidden = 1.0 - fraction();
  EXPECT_TRUE(std::abs(hidden - 112.5 / 195.0) < 0.03 || std::abs(hidden - 82.5 / 195.0) < 0.03)
      << hidden;
}

// --- what is traced, what is interpolated ---

// Interpolated pixels are right on the average, and their error is small beside the sensor's noise.
TEST(SparseFilm, IsTheWholePictureToWithinTheNoise) {
  Scene scene = OvalScene();
  CameraSpec& camera = scene.cameras[0];
  camera.model = camera.model.Resized(320, 240);
  scene.ambient.environment_w_m2_sr = 0.3;
  const double exposure_s = ExposureSeconds(scene, camera);
  const RayScene rays(scene);
  const std::vector<PlacedMarker> markers = PlaceMarkers(scene);
  const Lights lights(scene, rays, RingChoice::kAll, "camera");
  const CameraResponse response(camera, lights.Spectra(), exposure_s);
  TraceOptions trace;
  trace.samples_per_pixel = 64;
  const PathTracer tracer(scene, rays, lights, response, markers, trace);
  const IdBuffers ids = RenderIds(rays, camera.model, markers);
  const SparseFilm sparse =
      RenderSparseFilm(tracer, scene, camera, ids, exposure_s, {64, 64, 64}, lights.GroupNames());
  const Film full = RenderFilm(tracer, camera.model, lights.GroupNames(), NoProgress());
  EXPECT_LT(sparse.traced_pixels, 320 * 240 / 3);
  double bias = 0.0, square = 0.0, noise = 0.0;
  for (size_t i = 0; i < full.electrons.data.size(); ++i) {
    const auto mean = static_cast<double>(full.electrons.data[i]);
    const double error = static_cast<double>(sparse.film.electrons.data[i]) - mean;
    const double sigma = NoiseSigma_e(camera.sensor, exposure_s, mean);
    bias += error / sigma;
    square += error * error / (sigma * sigma);
    noise += 1.0;
  }
  EXPECT_LT(std::abs(bias / noise), 0.02);
  EXPECT_LT(std::sqrt(square / noise), 0.2);
  // Markers are traced, all of them.
  for (size_t i = 0; i < ids.marker.data.size(); ++i) {
    if (ids.marker.data[i] != 0) {
      EXPECT_EQ(sparse.film.electrons.data[i], full.electrons.data[i]);
    }
  }
}

// Where a detector looks, on markers and beside them, what the paths scatter must not drown what
// the sensor does, or a set shows a noise that no camera makes. The worst light that sets have: a
// CT room in twenty times the usual daylight, all rings on, each in another's shadow somewhere. Two
// pictures of the same scene by other paths differ by sqrt(2) of the scatter, here in sigmas of the
// sensor's noise. Measured: 0.5 on markers, 1.2 beside them (0.3 with the own ring alone), 2.2 at
// edges, where the share of a pixel is counted with 32 samples; with lights drawn by radiance
// instead of electrons it was 9.
TEST(DatasetPicture, PathsScatterNoMoreThanTheSensor) {
  constexpr const char* kConfig = R"({
    "schema": "retrolux/dataset-1", "name": "bright", "licence": "CC0-1.0", "seed": 3, "scenes": 1,
    "splits": {"test": 1}, "masks": [{"mesh": "oval"}], "views": [{"kind": "ct-room", "cameras": 2}],
    "markers": {"identifiable": 6, "standard": 4, "max_incidence_deg": 70},
    "recording": {"size_px": [320, 240], "exposure": 1, "ambient": 20, "rings": "all"}
  })";
  const DatasetScenes scenes(ReadDatasetConfig(WriteConfig(OwnFolder(), kConfig)));
  const DrawnScene drawn = scenes.Draw(0);
  std::vector<DatasetPicture> pictures;
  for (const uint64_t seed : {1, 2}) {
    RecordTimes times;
    const fs::path folder = OwnFolder() / std::to_string(seed);
    fs::create_directories(folder / "images");
    fs::create_directories(folder / "exr");
    pictures = RecordScene(drawn, {seed, scenes.Config().samples_per_pixel, true}, folder, times);
  }
  enum Place { kEdge, kMarker, kGround, kPlaces };
  std::array<double, kPlaces> square{};
  std::array<int, kPlaces> pixels{};
  for (const DatasetPicture& picture : pictures) {
    const std::string exr = drawn.name + "_" + picture.camera + ".exr";
    const ExrImage a = ReadExr(OwnFolder() / "1" / "exr" / exr);
    const ExrImage b = ReadExr(OwnFolder() / "2" / "exr" / exr);
    const FloatPlane &first = a.Float("electrons.Y"), &second = b.Float("electrons.Y");
    const IdPlane& ids = a.Ids("id.marker");
    cv::Mat shown(ids.height, ids.width, CV_8UC1), near, beside, within;
    for (size_t i = 0; i < ids.data.size(); ++i) shown.data[i] = ids.data[i] != 0 ? 1 : 0;
    cv::dilate(shown, near, cv::Mat::ones(7, 7, CV_8UC1));
    cv::dilate(shown, beside, cv::Mat::ones(3, 3, CV_8UC1));
    cv::erode(shown, within, cv::Mat::ones(3, 3, CV_8UC1));
    for (size_t i = 0; i < ids.data.size(); ++i) {
      if (near.data[i] == 0) continue;
      const size_t place = within.data[i] != 0 ? kMarker : beside.data[i] != 0 ? kEdge : kGround;
      const auto u = static_cast<double>(first.data[i]), v = static_cast<double>(second.data[i]);
      const double sigma = NoiseSigma_e(drawn.scene.Camera(picture.camera).sensor,
                                        picture.exposure_s, 0.5 * (u + v));
      square[place] += 0.5 * (u - v) * (u - v) / (sigma * sigma);
      ++pixels[place];
    }
  }
  const auto scatter = [&](Place place) { return std::sqrt(square[place] / pixels[place]); };
  EXPECT_GT(pixels[kMarker], 200);
  EXPECT_LT(scatter(kMarker), 0.8);
  EXPECT_LT(scatter(kGround), 1.5);
  EXPECT_LT(scatter(kEdge), 3.0);
}

// --- a whole dataset ---

// The runs of COCO's string, and their pixels, without the code under test.
cv::Mat DecodedMask(const Json& rle) {
  const int height = rle["size"][0], width = rle["size"][1];
  cv::Mat mask = cv::Mat::zeros(height, width, CV_8UC1);
  std::vector<int64_t> counts;
  int64_t value = 0, weight = 1;
  for (const char c : rle["counts"].get<std::string>()) {
    const int digit = c - '0';
    value += weight * (digit % 32);
    weight *= 32;
    if (digit >= 32) continue;
    if (digit >= 16) value -= weight;
    counts.push_back(value + (counts.size() > 2 ? counts[counts.size() - 2] : 0));
    value = 0;
    weight = 1;
  }
  int64_t place = 0;
  for (size_t i = 0; i < counts.size(); ++i) {
    for (int64_t k = 0; k < counts[i]; ++k, ++place) {
      if (i % 2 == 1)
        mask.at<uint8_t>(static_cast<int>(place % height), static_cast<int>(place / height)) = 255;
    }
  }
  EXPECT_EQ(place, int64_t{width} * height);
  return mask;
}

cv::Rect BoundsOfPixels(const cv::Mat& mask) {
  std::vector<cv::Point> points;
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      if (mask.at<uint8_t>(y, x) != 0) points.emplace_back(x, y);
    }
  }
  if (points.empty()) return {-1, -1, -1, -1};
  int x0 = mask.cols, y0 = mask.rows, x1 = -1, y1 = -1;
  for (const cv::Point& p : points) {
    x0 = std::min(x0, p.x);
    x1 = std::max(x1, p.x);
    y0 = std::min(y0, p.y);
    y1 = std::max(y1, p.y);
  }
  return {x0, y0, x1 - x0 + 1, y1 - y0 + 1};
}

cv::Rect ToRect(const Json& box) {
  return {box[0].get<int>(), box[1].get<int>(), box[2].get<int>(), box[3].get<int>()};
}

bool Same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && cv::countNonZero(a != b) == 0;
}

class TinyDataset : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = OwnFolder() / "whole";
    PlanDataset(WriteConfig(OwnFolder(), kTiny), folder_);
    Run(folder_, {});
    ExportCoco(ReadDatasetIndex(folder_), folder_);
    ExportBop(ReadDatasetIndex(folder_), folder_);
  }

  static DatasetState Run(const fs::path& folder, const DatasetRunOptions& options) {
    RecordTimes times;
    DatasetState state = RunDataset(folder, options, NoProgress(), times);
    if (state.IsDone()) WriteDatasetIndex(DatasetPlan(folder));
    return state;
  }
  // Scene 0 and 2 of the tiny dataset, in a folder of its own.
  static fs::path HalfOf(const std::string& name) {
    const fs::path folder = OwnFolder() / name;
    PlanDataset(OwnFolder() / "given.json", folder);
    DatasetRunOptions options;
    options.chosen = [](size_t scene) { return scene % 2 == 0; };
    Run(folder, options);
    return folder;
  }
  static void ExpectTheWholeSet(const fs::path& folder) {
    EXPECT_EQ(ReadTextFile(folder / "dataset.json"), ReadTextFile(folder_ / "dataset.json"));
    for (const auto& file : fs::directory_iterator(folder_ / "images")) {
      EXPECT_EQ(ReadTextFile(folder / "images" / file.path().filename()),
                ReadTextFile(file.path()));
    }
  }
  static Json Read(const fs::path& file) { return Json::parse(ReadTextFile(file)); }

  // BOP's folder of a scene: its number in six digits.
  static fs::path BopFolder(const Json& scene) {
    const int number = std::stoi(scene["scene"].get<std::string>().substr(6));
    return folder_ / "bop" / scene["split"].get<std::string>() /
           std::string(cv::format("%06d", number));
  }

  static inline fs::path folder_;
};

TEST_F(TinyDataset, AMaskHasAPixelExactlyIfItsMarkerIsInTheLabels) {
  const Json index = Read(folder_ / "dataset.json");
  int shown = 0;
  for (const Json& scene : index["scenes"]) {
    for (const Json& picture : scene["pictures"]) {
      for (const Json& marker : picture["markers"]) {
        const int pixels = cv::countNonZero(DecodedMask(marker["mask_visible"]));
        EXPECT_EQ(pixels, marker["visible_px"].get<int>());
        EXPECT_GT(pixels + cv::countNonZero(DecodedMask(marker["mask_amodal"])), 0);
        shown += pixels > 0 ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(index["markers"], shown);
  EXPECT_GT(shown, 20);
}

// The outline is followed in steps of 0.5 mm on a curved surface: a pixel centre right on it may
// fall to either side.
TEST_F(TinyDataset, WhatIsSeenLiesInTheOutline) {
  const Json index = Read(folder_ / "dataset.json");
  for (const Json& scene : index["scenes"]) {
    for (const Json& picture : scene["pictures"]) {
      for (const Json& marker : picture["markers"]) {
        const cv::Mat visible = DecodedMask(marker["mask_visible"]);
        const cv::Mat outside = visible & ~DecodedMask(marker["mask_amodal"]);
        EXPECT_LE(cv::countNonZero(outside), 2 + cv::countNonZero(visible) / 25)
            << scene["scene"] << picture["camera"] << marker["name"];
      }
    }
  }
}

// cam_K, distortion, pose and corners of BOP's files, by OpenCV's own projection, are the corners
// of the labels; so are COCO's keypoints.
TEST_F(TinyDataset, CornersReprojectTo001Px) {
  int corners = 0;
  const Json index = Read(folder_ / "dataset.json");
  for (const Json& scene : index["scenes"]) {
    const fs::path bop = BopFolder(scene);
    const Json cameras = Read(bop / "scene_camera.json"), poses = Read(bop / "scene_gt.json");
    for (size_t i = 0; i < scene["pictures"].size(); ++i) {
      const Json& camera = cameras[std::to_string(i)];
      const auto k = camera["cam_K"].get<std::vector<double>>();
      const auto d = camera["distortion"].get<std::vector<double>>();
      for (const Json& pose : poses[std::to_string(i)]) {
        const auto r = pose["cam_R_m2c"].get<std::vector<double>>();
        const auto t = pose["cam_t_m2c"].get<std::vector<double>>();
        cv::Mat turn;
        cv::Rodrigues(cv::Mat(3, 3, CV_64F, const_cast<double*>(r.data())), turn);
        for (size_t c = 0; c < pose["corners_px"].size(); ++c) {
          if (pose["corners_px"][c].is_null()) continue;
          const Json& x = pose["corners_in_marker_mm"][c];
          std::vector<cv::Point2d> px;
          cv::projectPoints(std::vector<cv::Point3d>{{x[0], x[1], x[2]}}, turn, cv::Mat(t),
                            cv::Mat(3, 3, CV_64F, const_cast<double*>(k.data())), cv::Mat(d), px);
          EXPECT_NEAR(px[0].x, pose["corners_px"][c][0].get<double>(), 0.01);
          EXPECT_NEAR(px[0].y, pose["corners_px"][c][1].get<double>(), 0.01);
          ++corners;
        }
      }
    }
  }
  EXPECT_GT(corners, 100);
}

TEST_F(TinyDataset, BopMasksAreTheLabels) {
  const Json index = Read(folder_ / "dataset.json");
  for (const Json& scene : index["scenes"]) {
    const fs::path bop = BopFolder(scene);
    const Json infos = Read(bop / "scene_gt_info.json");
    for (size_t i = 0; i < scene["pictures"].size(); ++i) {
      const cv::Mat grey =
          cv::imread((bop / "gray" / cv::format("%06zu.png", i)).string(), cv::IMREAD_UNCHANGED);
      EXPECT_EQ(grey.cols, 200);
      EXPECT_EQ(grey.depth(), scene["pictures"][i]["bits"] > 8 ? CV_16U : CV_8U);
      for (size_t m = 0; m < infos[std::to_string(i)].size(); ++m) {
        const Json& info = infos[std::to_string(i)][m];
        const Json& label = scene["pictures"][i]["markers"][m];
        const std::string file = cv::format("%06zu_%06zu.png", i, m);
        const cv::Mat all = cv::imread((bop / "mask" / file).string(), cv::IMREAD_UNCHANGED);
        const cv::Mat seen = cv::imread((bop / "mask_visib" / file).string(), cv::IMREAD_UNCHANGED);
        EXPECT_TRUE(Same(seen, DecodedMask(label["mask_visible"])));
        EXPECT_TRUE(Same(all, DecodedMask(label["mask_amodal"])));
        EXPECT_EQ(ToRect(info["bbox_visib"]), BoundsOfPixels(seen));
        EXPECT_EQ(ToRect(info["bbox_obj"]), BoundsOfPixels(all));
        EXPECT_EQ(info["px_count_visib"], cv::countNonZero(seen));
        EXPECT_EQ(info["px_count_all"], cv::countNonZero(all));
      }
    }
  }
}

TEST_F(TinyDataset, CocoHasTheSamePicturesAndMarkers) {
  std::map<std::string, Json> labels;  // by file, then instance
  const Json index = Read(folder_ / "dataset.json");
  for (const Json& scene : index["scenes"]) {
    for (const Json& picture : scene["pictures"]) {
      for (const Json& marker : picture["markers"])
        labels[fs::path(picture["file"].get<std::string>()).filename()]
              [std::to_string(marker["instance"].get<int>())] = marker;
    }
  }
  size_t annotations = 0;
  for (const char* split : {"train", "test"}) {
    if (!fs::exists(folder_ / "coco" / (std::string(split) + ".json"))) continue;
    const Json coco = Read(folder_ / "coco" / (std::string(split) + ".json"));
    std::map<int, std::string> files;
    for (const Json& image : coco["images"]) files[image["id"]] = image["file_name"];
    for (const Json& a : coco["annotations"]) {
      const Json& label = labels[files[a["image_id"]]][std::to_string(a["instance"].get<int>())];
      const cv::Mat mask = DecodedMask(a["segmentation"]);
      EXPECT_EQ(ToRect(a["bbox"]), BoundsOfPixels(mask));
      EXPECT_EQ(a["area"], cv::countNonZero(mask));
      EXPECT_TRUE(Same(mask, DecodedMask(label["mask_visible"])));
      ASSERT_EQ(a["keypoints"].size(), 3 * label["corners_px"].size());
      int labelled = 0;
      for (size_t c = 0; c < label["corners_px"].size(); ++c) {
        const int v = a["keypoints"][3 * c + 2];
        EXPECT_EQ(v, label["corners_visibility"][c]);
        labelled += v > 0 ? 1 : 0;
        if (v == 0) continue;
        EXPECT_EQ(a["keypoints"][3 * c], label["corners_px"][c][0]);
        EXPECT_EQ(a["keypoints"][3 * c + 1], label["corners_px"][c][1]);
      }
      EXPECT_EQ(a["num_keypoints"], labelled);
      ++annotations;
    }
  }
  EXPECT_EQ(annotations, Read(folder_ / "dataset.json")["markers"].get<size_t>());
}

TEST_F(TinyDataset, ReadsItsOwnLabelsBack) {
  const DatasetIndex index = ReadDatasetIndex(folder_);
  const Json json = Read(folder_ / "dataset.json");
  for (size_t i = 0; i < index.scenes.size(); ++i)
    EXPECT_EQ(index.scenes[i].ToJson(), json["scenes"][i]);
}

TEST_F(TinyDataset, CsvHasARowForEachLabel) {
  const DatasetIndex index = ReadDatasetIndex(folder_);
  const std::string text = ReadTextFile(ExportCsv(index, folder_));
  int64_t labels = 0;
  for (const DatasetScene& scene : index.scenes) {
    for (const DatasetPicture& picture : scene.pictures)
      labels += static_cast<int64_t>(picture.markers.size());
  }
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), labels + 1);
  EXPECT_THAT(text, HasSubstr("scene.exposure_full_scales"));
}

// Two shards, the second of which does again what is lost between them, give the bytes of one run.
TEST_F(TinyDataset, ShardsGiveTheBytesOfOneRun) {
  const fs::path folder = HalfOf("shards");
  EXPECT_EQ(StateOf(DatasetPlan(folder)).ScenesDone(), 2u);
  EXPECT_FALSE(fs::exists(folder / "dataset.json"));
  fs::remove(folder / DatasetPlan(folder).Read(0).pictures[0].file);
  const DatasetState whole = Run(folder, {});
  EXPECT_EQ(whole.tasks.done_before, 1);
  EXPECT_EQ(whole.tasks.done_now, 3);
  ExpectTheWholeSet(folder);
}

TEST_F(TinyDataset, FoldersOfOnePlanAreMerged) {
  const fs::path first = HalfOf("first"), second = OwnFolder() / "second";
  PlanDataset(OwnFolder() / "given.json", second);
  DatasetRunOptions options;
  options.chosen = [](size_t scene) { return scene != 0; };
  Run(second, options);
  EXPECT_TRUE(MergeDatasets(first, {second}, NoProgress()).empty());
  const DatasetFaults faults = VerifyDataset(first, IndexToo::kNo, NoProgress());
  EXPECT_EQ(faults.checked, 4u);
  EXPECT_TRUE(faults.damaged.empty() && faults.missing.empty());
  WriteDatasetIndex(DatasetPlan(first));
  ExpectTheWholeSet(first);
}

TEST_F(TinyDataset, WhatIsDamagedIsNotMerged) {
  const fs::path first = HalfOf("merged"), second = OwnFolder() / "damaged";
  PlanDataset(OwnFolder() / "given.json", second);
  DatasetRunOptions options;
  options.chosen = [](size_t scene) { return scene == 1; };
  Run(second, options);
  WriteTextFile(second / DatasetPlan(second).Read(1).pictures[1].file, "no picture");
  EXPECT_THAT(MergeDatasets(first, {second}, NoProgress()),
              testing::ElementsAre(HasSubstr(
                  "scene-00001 (number 1): images/scene-00001_camera-5.png: not what was")));
  EXPECT_EQ(StateOf(DatasetPlan(first)).ScenesDone(), 2u);
}

TEST_F(TinyDataset, VerifyFindsWhatIsDamagedAndRunMakesItAgain) {
  const fs::path folder = OwnFolder() / "verified";
  PlanDataset(OwnFolder() / "given.json", folder);
  Run(folder, {});
  const DatasetPlan plan(folder);
  WriteTextFile(folder / plan.Read(0).pictures[0].file, "no picture");
  fs::remove(folder / plan.Read(1).pictures[1].file);
  const fs::path result = plan.Store().ResultFile(plan.Store().Place(plan.Tasks()[2]));
  fs::resize_file(result, fs::file_size(result) / 2);
  fs::remove(plan.Store().ResultFile(plan.Store().Place(plan.Tasks()[3])));
  const DatasetFaults faults = VerifyDataset(folder, IndexToo::kYes, NoProgress());
  EXPECT_EQ(faults.checked, 3u);
  EXPECT_THAT(faults.damaged,
              testing::ElementsAre(
                  "scene-00000 (number 0): images/scene-00000_camera-1.png: not what was written",
                  "scene-00001 (number 1): images/scene-00001_camera-5.png: missing",
                  HasSubstr("scene-00002 (number 2): " + result.string() + ": damaged")));
  EXPECT_THAT(faults.missing, testing::ElementsAre("scene-00003 (number 3)"));
  EXPECT_EQ(Run(folder, {}).tasks.done_now, 4);
  EXPECT_TRUE(VerifyDataset(folder, IndexToo::kYes, NoProgress()).damaged.empty());
  ExpectTheWholeSet(folder);
  std::string index = ReadTextFile(folder / "dataset.json");
  const size_t place = index.find("\"incidence_deg\":") + 17;
  index[place] = index[place] == '1' ? '2' : '1';
  WriteTextFile(folder / "dataset.json", index);
  EXPECT_THAT(VerifyDataset(folder, IndexToo::kYes, NoProgress()).damaged,
              testing::ElementsAre("dataset.json: not what the results say"));
  index.resize(index.size() / 2);
  WriteTextFile(folder / "dataset.json", index);
  EXPECT_THAT(VerifyDataset(folder, IndexToo::kYes, NoProgress()).damaged,
              testing::ElementsAre("dataset.json: not what the results say"));
  fs::remove(folder / "dataset.json");
  EXPECT_THAT(VerifyDataset(folder, IndexToo::kYes, NoProgress()).missing,
              testing::ElementsAre(HasSubstr("dataset.json")));
}

TEST_F(TinyDataset, AnotherPlanIsRefusedAndToldWhatChanged) {
  std::string other = kTiny;
  other.replace(other.find("\"seed\": 7"), 9, "\"seed\": 8");
  EXPECT_THAT(MessageOf([&] { PlanDataset(WriteConfig(OwnFolder() / "other", other), folder_); }),
              HasSubstr("/config/seed was 7, is 8"));
  RecordTimes times;
  DatasetRunOptions options;
  options.recording.samples_per_pixel = 3;
  EXPECT_THAT(MessageOf([&] { RunDataset(folder_, options, NoProgress(), times); }),
              HasSubstr("/spp was 2, is 3"));
  EXPECT_THAT(MessageOf([&] { MergeDatasets(folder_, {OwnFolder() / "nowhere"}, NoProgress()); }),
              HasSubstr("no config.json"));
}

}  // namespace
}  // namespace retrolux
