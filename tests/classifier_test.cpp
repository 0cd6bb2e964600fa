// The identification method against pictures that this file makes itself, so that neither renderer
// nor scene can share its mistakes: markers on a plane or a sphere, seen by a pinhole camera
// (the 12.18 degree lens at 640 px has f = 3000 px), each pixel the mean of 8 x 8 samples of the
// exact outline.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "classifier/contour.h"
#include "classifier/detections_json.h"
#include "classifier/edges.h"
#include "classifier/method.h"
#include "classifier/polygon_fit.h"
#include "core/atomic_file.h"
#include "core/data_path.h"
#include "core/error.h"
#include "core/image_file.h"
#include "core/marker_set.h"
#include "core/parallel.h"
#include "core/rng.h"

namespace retrolux {
namespace {

namespace fs = std::filesystem;

// ---- pictures ----

constexpr double kFocal_px = 3000.0;

struct View {
  double tilt_deg = 0.0;     // between the normal and the line of sight
  double azimuth_deg = 0.0;  // the way the normal leans, counter-clockwise from picture right
  double roll_deg = 0.0;     // of the marker about its normal
  double distance_mm = 1600.0;
  Vec2d at_px{100.0, 80.0};  // where the marker's origin is seen
  double radius_mm = 0.0;    // of the sphere that the marker lies on; 0: plane
  double background = 10.0;  // DN
  double contrast = 160.0;   // DN
  double noise = 1.0;        // DN
  uint64_t seed = 1;
};

struct Picture {
  DigitalImage image;
  Polygon corners_px;
  Vec2d centroid_px;
};

// Standard normal numbers: made once, read from a place that the key says.
double Gaussian(uint64_t key, size_t i) {
  static const std::vector<double> table = [] {
    std::vector<double> values(1 << 18);
    KeyedRng rng(42);
    for (double& v : values) {
      v = std::sqrt(-2.0 * std::log(1.0 - rng.NextDouble())) *
          std::cos(2.0 * kPi * rng.NextDouble());
    }
    return values;
  }();
  return table[(Mix64(key) + i) % table.size()];
}

DigitalImage Digitise(const Plane<double>& mean, double noise, uint64_t seed) {
  DigitalImage image{Plane<uint16_t>(mean.width, mean.height), 8};
  for (size_t i = 0; i < mean.data.size(); ++i) {
    const double dn = std::round(mean.data[i] + noise * Gaussian(seed, i));
    image.dn.data[i] = static_cast<uint16_t>(std::clamp(dn, 0.0, 255.0));
  }
  return image;
}

// How many of 8 x 8 samples of a pixel are inside; where 3 x 3 of them agree, so do the others.
template <typename Inside>
int HitsOf64(const Vec2d& px, Inside inside) {
  int hits = 0;
  for (const double dy : {-0.5, 0.0, 0.5}) {
    for (const double dx : {-0.5, 0.0, 0.5}) hits += inside(px + Vec2d(dx, dy));
  }
  if (hits == 0 || hits == 9) return hits == 0 ? 0 : 64;
  hits = 0;
  for (int j = 0; j < 8; ++j) {
    for (int i = 0; i < 8; ++i) hits += inside(px + Vec2d(i - 3.5, j - 3.5) / 8.0);
  }
  return hits;
}

// Adds the mean of 8 x 8 samples a pixel: `contrast` where `inside` says so. Only pixels within
// `reach` of `centre` are looked at.
template <typename Inside>
void Paint(Plane<double>& mean, double contrast, Inside inside, const Vec2d& centre = {0.0, 0.0},
           double reach = 1e4) {
  const auto from = [&](double c) {
    return static_cast<int>(std::max(0.0, std::floor(c - reach)));
  };
  const auto to = [&](double c, int size) {
    return static_cast<int>(std::min<double>(size, std::ceil(c + reach)));
  };
  for (int y = from(centre.y()); y < to(centre.y(), mean.height); ++y) {
    for (int x = from(centre.x()); x < to(centre.x(), mean.width); ++x) {
      const int hits = HitsOf64(Vec2d(x, y), inside);
      mean(x, y) += contrast * hits / 64.0;
    }
  }
}

// The pinhole camera and the surface of a View.
class Stage {
 public:
  Stage(const View& view, int width, int height)
      : view_(view), principal_(0.5 * (width - 1), 0.5 * (height - 1)) {
    const Vec3d sight = Direction(view.at_px).normalized();
    centre_ = view.distance_mm * sight;
    const Vec3d right = Vec3d(0.0, 1.0, 0.0).cross(sight).normalized();
    const Vec3d up = right.cross(sight);
    const double azimuth = RadFromDeg(view.azimuth_deg);
    const Vec3d lean = std::cos(azimuth) * right + std::sin(azimuth) * up;
    const Vec3d side = -std::sin(azimuth) * right + std::cos(azimuth) * up;
    const double tilt = RadFromDeg(view.tilt_deg);
    normal_ = -std::cos(tilt) * sight + std::sin(tilt) * lean;
    const Vec3d along = std::cos(tilt) * lean + std::sin(tilt) * sight;
    const double roll = RadFromDeg(view.roll_deg);
    x_ = std::cos(roll) * along + std::sin(roll) * side;
    y_ = normal_.cross(x_);
  }

  Vec2d Project(const Vec2d& in_marker) const {
    const double r = view_.radius_mm;
    const double height = r > 0.0 ? std::sqrt(r * r - in_marker.squaredNorm()) - r : 0.0;
    const Vec3d p = centre_ + in_marker.x() * x_ + in_marker.y() * y_ + height * normal_;
    return principal_ + kFocal_px * p.head<2>() / p.z();
  }

  // Where the ray of a pixel meets the surface, in the marker's frame.
  std::optional<Vec2d> InMarker(const Vec2d& px) const {
    const Vec3d d = Direction(px);
    double t = normal_.dot(centre_) / normal_.dot(d);
    if (view_.radius_mm > 0.0) {
      const Vec3d c = centre_ - view_.radius_mm * normal_;
      const double half = d.dot(c);
      const double root =
          half * half - d.squaredNorm() * (c.squaredNorm() - view_.radius_mm * view_.radius_mm);
      if (root < 0.0) return std::nullopt;
      t = (half - std::sqrt(root)) / d.squaredNorm();
    }
    const Vec3d p = t * d - centre_;
    return Vec2d(x_.dot(p), y_.dot(p));
  }

 private:
  Vec3d Direction(const Vec2d& px) const {
    const Vec2d xy = (px - principal_) / kFocal_px;
    return {xy.x(), xy.y(), 1.0};
  }

  View view_;
  Vec2d principal_;
  Vec3d centre_, normal_, x_, y_;
};

Picture Draw(const MarkerShape& shape, const View& view, int width = 200, int height = 160) {
  const Stage stage(view, width, height);
  Picture picture;
  for (const Vec2d& corner : shape.outline_mm) picture.corners_px.push_back(stage.Project(corner));
  picture.centroid_px = Centroid(picture.corners_px);
  const double reach = 2.0 + kFocal_px * shape.Radius() / (view.distance_mm - shape.Radius());
  Plane<double> mean(width, height, view.background);
  const auto inside = [&](const Vec2d& px) {
    const std::optional<Vec2d> p = stage.InMarker(px);
    return p && shape.Contains(*p);
  };
  Paint(mean, view.contrast, inside, view.at_px, reach);
  picture.image = Digitise(mean, view.noise, view.seed);
  return picture;
}

// A picture of one polygon given in px.
DigitalImage DrawPolygon(const Polygon& polygon_px, int width = 200, int height = 160,
                         double contrast = 100.0) {
  Plane<double> mean(width, height, 10.0);
  Paint(mean, contrast, [&](const Vec2d& px) { return Contains(polygon_px, px); });
  return Digitise(mean, 1.0, 7);
}

std::vector<Detection> Identify(const DigitalImage& image,
                                const MarkerSet& markers = DefaultMarkerSet()) {
  return IdentifyByEdges(image, markers, EdgesOptions{});
}

MarkerSet WithoutStandard() {
  MarkerSet set = DefaultMarkerSet();
  std::erase_if(set.shapes, [](const MarkerShape& s) { return s.number == 0; });
  return set;
}

std::optional<int> OnlyName(const DigitalImage& image,
                            const MarkerSet& markers = DefaultMarkerSet()) {
  const std::vector<Detection> found = Identify(image, markers);
  EXPECT_EQ(found.size(), 1u);
  return found.size() == 1 ? found[0].marker : std::nullopt;
}

// Half the angle between the two edges at a corner.
double HalfAngle(const Polygon& polygon, size_t i) {
  const size_t n = polygon.size();
  const Vec2d a = (polygon[(i + 1) % n] - polygon[i]).normalized();
  const Vec2d b = (polygon[(i + n - 1) % n] - polygon[i]).normalized();
  return 0.5 * std::acos(std::clamp(a.dot(b), -1.0, 1.0));
}

// How far the edges must be off their true places, at least, to put the corners where they were
// found: px. An edge that is off by d moves the corner up to d / sin(half the angle). A triangle
// may begin anywhere.
double EdgeError(const Detection& found, const Polygon& truth) {
  const size_t n = truth.size();
  if (found.corners_px.size() != n) return INFINITY;
  double best = INFINITY;
  for (size_t shift = 0; shift < (n == 3 ? n : 1); ++shift) {
    double worst = 0.0;
    for (size_t i = 0; i < n; ++i) {
      const double distance = (found.corners_px[(i + shift) % n] - truth[i]).norm();
      worst = std::max(worst, distance * std::sin(HalfAngle(truth, i)));
    }
    best = std::min(best, worst);
  }
  return best;
}

// ---- names ----

TEST(Edges, NamesEveryMarkerAtEveryRollAndTilt) {
  for (const MarkerShape& shape : DefaultMarkerSet().shapes) {
    for (const double tilt : {0.0, 20.0, 40.0, 55.0}) {
      for (const double roll : {0.0, 45.0, 130.0, 250.0}) {
        View view;
        view.tilt_deg = tilt;
        view.roll_deg = roll;
        view.azimuth_deg = 3.0 * roll + tilt;
        view.at_px = {100.3 + 0.1 * tilt, 80.4 + 0.01 * roll};
        view.seed = static_cast<uint64_t>(tilt + roll);
        SCOPED_TRACE(fmt::format("{} tilt {} roll {}", shape.name, tilt, roll));
        const Picture picture = Draw(shape, view);
        const std::vector<Detection> found = Identify(picture.image);
        ASSERT_EQ(found.size(), 1u);
        ASSERT_EQ(found[0].marker, shape.number);
        EXPECT_EQ(found[0].straight_edges, shape.straight_edges);
        EXPECT_GT(found[0].confidence, 0.1);
        EXPECT_LE(found[0].confidence, 1.0);
        EXPECT_LT((found[0].centroid_px - picture.centroid_px).norm(), 0.2);
        if (shape.number == 0) continue;
        // Corner by corner, in the order of the outline: place and handedness at once.
        // 0.14 px is 0.2 px at a right angle. Foreshortened, the shortest edges are 4 px.
        EXPECT_LT(EdgeError(found[0], picture.corners_px), tilt < 30.0 ? 0.14 : 0.21);
      }
    }
  }
}

TEST(Edges, NameDoesNotDependOnScale) {
  for (const MarkerShape& shape : DefaultMarkerSet().shapes) {
    for (const double distance : {350.0, 700.0, 1200.0, 2000.0}) {
      View view;
      view.distance_mm = distance;  // 15 mm are 129, 64, 38, 22 px
      view.at_px = {130.0, 120.0};
      view.roll_deg = 25.0;
      view.tilt_deg = 20.0;
      SCOPED_TRACE(fmt::format("{} at {} mm", shape.name, distance));
      EXPECT_EQ(OnlyName(Draw(shape, view, 260, 240).image), shape.number);
    }
  }
}

TEST(Edges, CurvedSurfaceBendsNoNameAway) {
  for (const MarkerShape& shape : DefaultMarkerSet().shapes) {
    View view;
    view.radius_mm = 71.0;  // the tips of the oval
    view.tilt_deg = 50.0;
    view.azimuth_deg = 30.0;
    view.roll_deg = 75.0;
    EXPECT_EQ(OnlyName(Draw(shape, view).image), shape.number) << shape.name;
  }
}

TEST(Edges, MirroredShapeIsNotTheMarker) {
  MarkerSet set;
  set.size_mm = 15.0;
  MarkerShape flag{1, "flag", {{-7.5, -7.5}, {2.0, -7.5}, {2.0, 1.0}, {7.5, 7.5}, {-7.5, 7.5}}, 5};
  set.shapes = {flag};
  MarkerShape mirrored = flag;
  for (Vec2d& corner : mirrored.outline_mm) corner.x() *= -1.0;
  std::reverse(mirrored.outline_mm.begin(), mirrored.outline_mm.end());
  EXPECT_EQ(OnlyName(Draw(flag, View{}).image, set), 1);
  EXPECT_EQ(OnlyName(Draw(mirrored, View{}).image, set), std::nullopt);
}

TEST(Edges, DimMarkerOnABrighterHighlight) {
  // The highlight is higher than the marker, but soft: its slope stays under the noise.
  View view;
  view.tilt_deg = 60.0;
  view.roll_deg = 10.0;
  view.contrast = 0.0;
  const MarkerShape& shape = DefaultMarkerSet().ByNumber(2);
  const Stage stage(view, 200, 160);
  Plane<double> mean(200, 160);
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 200; ++x)
      mean(x, y) = 5.0 + 30.0 * std::exp(-(Vec2d(x, y) - Vec2d(140, 60)).squaredNorm() / 5000.0);
  }
  Paint(mean, 12.0, [&](const Vec2d& px) {
    const auto p = stage.InMarker(px);
    return p && shape.Contains(*p);
  });
  EXPECT_EQ(OnlyName(Digitise(mean, 1.0, 3)), 2);
}

// ---- no names ----

TEST(Edges, DiscIsTheStandardMarkerOfTheSetOrNothing) {
  const DigitalImage disc = Draw(DefaultMarkerSet().ByNumber(0), View{}).image;
  EXPECT_EQ(OnlyName(disc), 0);
  EXPECT_EQ(OnlyName(disc, WithoutStandard()), std::nullopt);
}

TEST(Edges, DiscsOfAnySizeAreNeverIdentifiable) {
  for (double radius = 3.5; radius < 60.0; radius *= 1.07) {
    Plane<double> mean(140, 140, 10.0);
    Paint(mean, 80.0, [&](const Vec2d& px) { return (px - Vec2d(69.7, 70.2)).norm() < radius; });
    for (const Detection& d : Identify(Digitise(mean, 1.0, static_cast<uint64_t>(radius * 100)))) {
      EXPECT_TRUE(!d.marker || d.marker == 0) << "radius " << radius << ": " << *d.marker;
    }
  }
}

TEST(Edges, OtherPolygonsHaveNoName) {
  const Polygon rectangle = {{60, 50}, {110, 60}, {103, 95}, {53, 85}};
  EXPECT_EQ(OnlyName(DrawPolygon(rectangle)), std::nullopt);
  const Polygon strip = {{20.3, 70.2}, {180.1, 90.4}, {179.4, 96.3}, {19.6, 76.1}};
  EXPECT_EQ(OnlyName(DrawPolygon(strip)), std::nullopt);
  const Polygon pentagon = {{100, 50}, {128.5, 70.7}, {117.6, 104.3}, {82.4, 104.3}, {71.5, 70.7}};
  EXPECT_EQ(OnlyName(DrawPolygon(pentagon)), std::nullopt);
}

TEST(Edges, WallsAndCutMarkersAreNotPatterns) {
  const Polygon wall = {{-50, -50}, {150.4, -50}, {120.2, 300}, {-50, 300}};
  EXPECT_THAT(Identify(DrawPolygon(wall)), testing::IsEmpty());
  const Polygon everything = {{-50, -50}, {300, -50}, {300, 300}, {-50, 300}};
  EXPECT_THAT(Identify(DrawPolygon(everything)), testing::IsEmpty());
  for (const MarkerShape& shape : DefaultMarkerSet().shapes) {
    View view;
    for (const Vec2d& at : {Vec2d(8, 80), Vec2d(193, 80), Vec2d(100, 6), Vec2d(100, 153)}) {
      view.at_px = at;
      EXPECT_THAT(Identify(Draw(shape, view).image), testing::IsEmpty()) << shape.name;
    }
  }
}

TEST(Edges, MarkerJustInsideTheBorderIsNamed) {
  View view;
  view.at_px = {17.5, 80.0};  // its left edge at 3.4 px
  EXPECT_EQ(OnlyName(Draw(DefaultMarkerSet().ByNumber(2), view).image), 2);
}

TEST(Edges, GlowOfALampIsNotAPattern) {
  for (const double sigma : {4.0, 8.0, 20.0}) {
    Plane<double> mean(200, 160);
    for (int y = 0; y < 160; ++y) {
      for (int x = 0; x < 200; ++x) {
        mean(x, y) = 10.0 + 120.0 * std::exp(-(Vec2d(x, y) - Vec2d(90, 80)).squaredNorm() /
                                             (2.0 * sigma * sigma));
      }
    }
    EXPECT_THAT(Identify(Digitise(mean, 1.0, 5)), testing::IsEmpty()) << sigma;
  }
}

TEST(Edges, RingHasNoName) {
  Plane<double> mean(120, 120, 10.0);
  Paint(mean, 100.0, [](const Vec2d& px) {
    const double r = (px - Vec2d(60, 60)).norm();
    return r > 14.0 && r < 24.0;
  });
  for (const Detection& d : Identify(Digitise(mean, 1.0, 5))) EXPECT_FALSE(d.marker);
}

TEST(Edges, UniformAndNoisyPicturesHoldNothing) {
  EXPECT_THAT(Identify(Digitise(Plane<double>(640, 480, 0.0), 0.0, 1)), testing::IsEmpty());
  EXPECT_THAT(Identify(Digitise(Plane<double>(640, 480, 255.0), 0.0, 1)), testing::IsEmpty());
  for (const double noise : {0.3, 1.0, 5.0}) {
    for (uint64_t seed = 0; seed < 10; ++seed) {
      EXPECT_THAT(Identify(Digitise(Plane<double>(640, 480, 12.0), noise, seed)),
                  testing::IsEmpty());
    }
  }
  for (const int side : {1, 2, 3, 5, 65}) {
    EXPECT_THAT(Identify(Digitise(Plane<double>(side, 3, 12.0), 1.0, 1)), testing::IsEmpty());
  }
}

// 2000 views of all six markers: tilt to 70 degrees, any roll and azimuth, 15 mm at 15 to 60 px, on
// a sphere of 70 to 200 mm, contrast 5 to 150 times the noise. No wrong name in n named views means
// that the rate of wrong names is below 3 / n at 95 % confidence (rule of three), here 0.2 %.
TEST(Edges, RandomViewsGetNoWrongNames) {
  int hits = 0;
  int wrong = 0;
  int clear_hits =
      0;  // frontal to 60 degrees, 15 mm at least 24 px, contrast at least 10 times the noise
  int clear = 0;
  constexpr int kViews = 2000;
  for (int i = 0; i < kViews; ++i) {
    KeyedRng rng(CombineKeys(2026, static_cast<uint64_t>(i)));
    const int number = 1 + i % 6;
    View view;
    view.tilt_deg = 70.0 * rng.NextDouble();
    view.azimuth_deg = 360.0 * rng.NextDouble();
    view.roll_deg = 360.0 * rng.NextDouble();
    const double size_px = 15.0 * std::pow(4.0, rng.NextDouble());
    view.distance_mm = 15.0 * kFocal_px / size_px;
    view.radius_mm = 70.0 + 130.0 * rng.NextDouble();
    view.contrast = 5.0 * std::pow(30.0, rng.NextDouble());
    view.at_px = {50.0 + 20.0 * rng.NextDouble(), 50.0 + 20.0 * rng.NextDouble()};
    view.seed = static_cast<uint64_t>(i);
    bool hit = false;
    for (const Detection& d :
         Identify(Draw(DefaultMarkerSet().ByNumber(number), view, 120, 120).image)) {
      hit = hit || d.marker == number;
      wrong += d.marker && d.marker != number;
    }
    hits += hit;
    if (view.tilt_deg <= 60.0 && size_px >= 24.0 && view.contrast >= 10.0) {
      ++clear;
      clear_hits += hit;
    }
  }
  RecordProperty("hit_percent", 100 * hits / kViews);
  RecordProperty("clear_hit_percent", 100 * clear_hits / clear);
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(hits, kViews * 3 / 4);
  EXPECT_GT(clear_hits, clear * 95 / 100);
}

// ---- pictures as files, depth, threads ----

TEST(Edges, SixteenBitsSeeWhatEightBitsSee) {
  View view;
  view.tilt_deg = 35.0;
  const DigitalImage eight = Draw(DefaultMarkerSet().ByNumber(4), view).image;
  for (const int factor : {16, 257}) {
    DigitalImage wide = eight;
    wide.bits = 16;
    for (uint16_t& dn : wide.dn.data) dn = static_cast<uint16_t>(dn * factor);
    const std::vector<Detection> a = Identify(eight);
    const std::vector<Detection> b = Identify(wide);
    ASSERT_EQ(a.size(), 1u);
    ASSERT_EQ(b.size(), 1u);
    EXPECT_EQ(a[0].marker, b[0].marker);
    EXPECT_LT(EdgeError(b[0], a[0].corners_px), 1e-3);
  }
}

TEST(Edges, SeveralMarkersFromTopToBottomOnAnyNumberOfThreads) {
  Plane<double> mean(460, 300, 8.0);
  for (int number = 1; number <= 6; ++number) {
    View view;
    view.at_px = {60.0 + 55.0 * number, 40.0 * number};
    view.roll_deg = 50.0 * number;
    const Stage stage(view, 460, 300);
    Paint(
        mean, 90.0,
        [&](const Vec2d& px) {
          const auto p = stage.InMarker(px);
          return p && DefaultMarkerSet().ByNumber(number).Contains(*p);
        },
        view.at_px, 25.0);
  }
  const DigitalImage image = Digitise(mean, 1.0, 9);
  const auto text = [](const std::vector<Detection>& found) {
    return DetectionsJson("edges", {{"a.png", "a", found}}).dump();
  };
  const std::vector<Detection> alone = Identify(image);
  ASSERT_EQ(alone.size(), 6u);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(alone[static_cast<size_t>(i)].marker, i + 1);
  std::vector<std::string> results(32);
  ParallelFor(32, [&](int64_t i) { results[static_cast<size_t>(i)] = text(Identify(image)); });
  EXPECT_THAT(results, testing::Each(text(alone)));
}

class EdgesFiles : public testing::Test {
 protected:
  EdgesFiles()
      : folder_(fs::path(testing::TempDir()) / fmt::format("retrolux_edges_{}", ::getpid())) {
    fs::create_directories(folder_);
  }
  ~EdgesFiles() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_F(EdgesFiles, PngIsSeenAsItsPicture) {
  const DigitalImage image = Draw(DefaultMarkerSet().ByNumber(3), View{}).image;
  WritePng(folder_ / "a.png", image);
  EXPECT_EQ(OnlyName(ReadGrey(folder_ / "a.png")), 3);
}

TEST_F(EdgesFiles, DebugWritesEveryStage) {
  const fs::path debug = folder_ / "debug";
  const DigitalImage image = Draw(DefaultMarkerSet().ByNumber(5), View{}).image;
  IdentifyByEdges(image, DefaultMarkerSet(), EdgesOptions{}, &debug);
  for (const char* name : {"01_picture.png", "02_slope.png", "03_steep.png", "04_outlines.png",
                           "05_edges.png", "06_names.png"}) {
    EXPECT_EQ(ReadGrey(debug / name).dn.width, 600) << name;  // three times 200
  }
}

TEST_F(EdgesFiles, DetectionsFileHoldsWhatTheSchemaAsksFor) {
  const Picture picture = Draw(DefaultMarkerSet().ByNumber(0), View{});
  std::vector<Detection> found = Identify(picture.image);
  found.push_back(Detection{});
  const fs::path file = folder_ / "detections.json";
  WriteDetections(file, "edges", {{"shots/left.png", "left", found}});
  const auto json = nlohmann::json::parse(ReadTextFile(file));
  EXPECT_EQ(json["schema"], "retrolux/detections-1");
  EXPECT_EQ(json["pixel_origin"], "center");
  const auto& image = json["images"][0];
  EXPECT_EQ(image["camera"], "left");
  EXPECT_EQ(image["detections"][0]["marker"], "standard");
  EXPECT_TRUE(image["detections"][1]["marker"].is_null());
  const auto schema =
      nlohmann::json::parse(ReadTextFile(DataPath("scenes/schema/detections-1.schema.json")));
  for (const auto& key : schema["$defs"]["detection"]["required"]) {
    EXPECT_TRUE(image["detections"][0].contains(key)) << key;
  }
  for (const auto& [key, value] : image["detections"][0].items()) {
    EXPECT_TRUE(schema["$defs"]["detection"]["properties"].contains(key)) << key;
  }
}

TEST(EdgesOptions, OutOfRangeIsTheUsersFault) {
  EdgesOptions options;
  options.min_gain = NAN;
  EXPECT_THROW(options.Check(), InputError);
  EXPECT_THROW(MethodByName("edgse"), InputError);
}

// ---- parts ----

TEST(Contour, OfADiscHasItsAreaAndRunsCounterClockwise) {
  Plane<double> mean(80, 80, 0.0);
  Paint(mean, 1.0, [](const Vec2d& px) { return (px - Vec2d(40.2, 39.7)).norm() < 20.0; });
  FloatPlane plane(80, 80);
  std::copy(mean.data.begin(), mean.data.end(), plane.data.begin());
  LevelPlane level;
  level.value = 0.5;
  const std::vector<Polygon> contours = TraceContours(plane, {0, 0, 80, 80}, level);
  ASSERT_EQ(contours.size(), 1u);
  EXPECT_NEAR(ScreenArea(contours[0]), kPi * 400.0, 6.0);
  EXPECT_LT((Centroid(contours[0]) - Vec2d(40.2, 39.7)).norm(), 0.02);
  EXPECT_NEAR(Perimeter(contours[0]), 40.0 * kPi, 1.5);
}

TEST(Contour, HolesRunClockwiseAndOpenLinesAreNotGiven) {
  FloatPlane plane(9, 9, 1.0f);
  plane(4, 4) = 0.0f;
  LevelPlane level;
  level.value = 0.5;
  const std::vector<Polygon> hole = TraceContours(plane, {0, 0, 9, 9}, level);
  ASSERT_EQ(hole.size(), 1u);
  EXPECT_NEAR(ScreenArea(hole[0]), -0.5, 1e-9);  // a diamond with half-diagonals of half a pixel
  plane(4, 4) = 1.0f;
  for (int y = 0; y < 9; ++y) plane(2, y) = 0.0f;
  EXPECT_THAT(TraceContours(plane, {0, 0, 9, 9}, level), testing::IsEmpty());
}

TEST(PolygonFit, FindsTheCornersOfAnExactOutline) {
  const Polygon corners = {{10, 10}, {40, 12}, {38, 45}, {25, 30}, {8, 40}};
  const Polygon outline = Resample(corners, 140);
  const auto fit = FitPolygon(outline, Perimeter(corners) / 140.0, PolygonFitLimits{});
  ASSERT_TRUE(fit);
  ASSERT_EQ(fit->corners.size(), 5u);
  for (const Vec2d& corner : corners) {
    double nearest = INFINITY;
    for (const Vec2d& found : fit->corners) nearest = std::min(nearest, (found - corner).norm());
    EXPECT_LT(nearest, 0.05);
  }
}

}  // namespace
}  // namespace retrolux
