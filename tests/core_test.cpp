#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <numeric>
#include <thread>

#include "core/atomic_file.h"
#include "core/camera_model.h"
#include "core/csv.h"
#include "core/data_path.h"
#include "core/image_file.h"
#include "core/json_reader.h"
#include "core/marker_set.h"
#include "core/parallel.h"
#include "core/sampler.h"
#include "core/sampling.h"
#include "core/thread_limit.h"
#include "core/yaml_text.h"
#include "tests/message_of.h"
#include "tests/own_folder.h"
#include "tests/statistics.h"

namespace retrolux {
namespace {

namespace fs = std::filesystem;

fs::path Scratch(const std::string& name) {
  return OwnFolder() / name;
}

CameraModel ThesisCamera() {
  return CameraModel::FromFieldOfView("c", 640, 480, 12.18, 9.15,
                                      LookAt({1265, 600, 1109}, Vec3d::Zero(), Vec3d::UnitX()));
}

// A made-up hierarchy of control groups.
class CgroupTest : public testing::Test {
 protected:
  void Put(const std::string& file, const std::string& text) const {
    const fs::path path = OwnFolder() / file;
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }
};

TEST_F(CgroupTest, TheSmallestLimitOfTheGroupAndThoseAboveItCounts) {
  Put("two/cpu.max", "350000 100000\n");
  Put("two/a/cpu.max", "max 100000\n");
  Put("two/a/b/cpu.max", "800000 100000\n");
  EXPECT_DOUBLE_EQ(CgroupCpus("0::/a/b\n", OwnFolder() / "two").value(), 3.5);
  EXPECT_FALSE(CgroupCpus("0::/elsewhere\n", OwnFolder() / "none"));
}

TEST_F(CgroupTest, VersionOneKnowsQuotaAndPeriod) {
  Put("one/cpu,cpuacct/job/cpu.cfs_quota_us", "150000\n");
  Put("one/cpu,cpuacct/job/cpu.cfs_period_us", "100000\n");
  Put("one/cpu,cpuacct/cpu.cfs_quota_us", "-1\n");
  Put("one/cpu,cpuacct/cpu.cfs_period_us", "100000\n");
  const std::string membership = "5:memory:/job\n4:cpu,cpuacct:/job\n";
  EXPECT_DOUBLE_EQ(CgroupCpus(membership, OwnFolder() / "one").value(), 1.5);
}

TEST(UsableThreads, AsManyAsSlurmGivesButNoMoreThanThereAre) {
  const int all = UsableThreads().threads;
  ::setenv("SLURM_CPUS_PER_TASK", "1", 1);
  EXPECT_EQ(UsableThreads().threads, 1);
  if (all > 1) {
    EXPECT_EQ(UsableThreads().Text(), "1 thread (SLURM_CPUS_PER_TASK)");
  }
  for (const char* text : {"100000", "0", "two", ""}) {
    ::setenv("SLURM_CPUS_PER_TASK", text, 1);
    EXPECT_EQ(UsableThreads().threads, all) << text;
  }
  ::unsetenv("SLURM_CPUS_PER_TASK");
}

// Eigen leaves the elements of Vec3d{} as the memory was; ours are zero (core/CMakeLists.txt). The
// memory is filled first, so that the test fails where they are left alone.
TEST(Vectors, EmptyBracesAreZero) {
  alignas(Vec3d) std::array<unsigned char, sizeof(Vec3d)> memory;
  memory.fill(0x42);
  const Vec3d* v = new (memory.data()) Vec3d{};
  EXPECT_EQ(*v, Vec3d::Zero());
}

TEST(CameraModel, FieldOfViewOfTheThesisGivesTenMicrometrePixels) {
  // f / fx is the pixel pitch: 30 mm / fx with fx = 320 / tan(6.09 deg), i.e. 2 * 30 tan(6.09 deg)
  // / 640 = 10.0 um.
  const CameraModel camera = ThesisCamera();
  EXPECT_NEAR(1000.0 * 30.0 / camera.fx, 10.00, 0.01);
  EXPECT_NEAR(1000.0 * 30.0 / camera.fy, 10.00, 0.01);
}

TEST(CameraModel, PixelToRayToPixel) {
  const CameraModel camera = ThesisCamera();
  for (const Vec2d& px :
       {Vec2d(0, 0), Vec2d(-0.5, 479.5), Vec2d(319.5, 239.5), Vec2d(600.25, 17.75)}) {
    const Ray ray = camera.RayThrough(px);
    EXPECT_LT((*camera.Project(ray.origin + 1600.0 * ray.direction) - px).norm(), 1e-9);
  }
}

TEST(CameraModel, LooksAtItsTargetWithWorldUpUpwardsInThePicture) {
  const CameraModel camera = ThesisCamera();
  EXPECT_LT((*camera.Project(Vec3d::Zero()) - Vec2d(319.5, 239.5)).norm(), 1e-9);
  EXPECT_LT(camera.Project(Vec3d(10, 0, 0))->y(), 239.5);  // y points down
  // The front cameras look along -z: their right is the observer's right, which is -y.
  EXPECT_GT(camera.Project(Vec3d(0, -10, 0))->x(), 319.5);
  EXPECT_FALSE(camera.Project(2.0 * camera.Centre()).has_value());
}

TEST(CameraModel, ResizedKeepsTheEdgesOfThePicture) {
  const CameraModel camera = ThesisCamera();
  const CameraModel half = camera.Resized(320, 240);
  const Ray corner = camera.RayThrough({-0.5, -0.5});
  EXPECT_LT((*half.Project(corner.origin + corner.direction * 1000.0) - Vec2d(-0.5, -0.5)).norm(),
            1e-9);
}

TEST(Polygon, AreaCentroidInsideHull) {
  const Polygon l_shape = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {0, 3}};
  // 4 x 1 and 1 x 2 rectangles with centres (2, 0.5), (0.5, 2).
  EXPECT_DOUBLE_EQ(SignedArea(l_shape), 6.0);
  EXPECT_LT((Centroid(l_shape) - Vec2d(9.0 / 6.0, 1.0)).norm(), 1e-12);
  EXPECT_TRUE(Contains(l_shape, {0.5, 2.5}));
  EXPECT_FALSE(Contains(l_shape, {2.0, 2.0}));
  EXPECT_EQ(ConvexHull(l_shape).size(), 5u);
}

TEST(MarkerSet, SixMarkersAreToldApartByTheirEdges) {
  const MarkerSet& set = DefaultMarkerSet();
  for (int number = 1; number <= 6; ++number) {
    EXPECT_EQ(set.ByNumber(number).straight_edges, number + 2);
    EXPECT_EQ(set.NumberWithEdges(number + 2), number);
  }
  EXPECT_EQ(set.NumberWithEdges(9), std::nullopt);
  EXPECT_THAT(MessageOf([&] { set.ByNumber(7); }),
              testing::HasSubstr("marker 7 is not in the set; expected one of 1, 2, 3"));
}

TEST(Sampler, EveryPairAndDimensionIsStratified) {
  // A (0, 2)-sequence in base 2: the first 64 points fall one into each cell of every 2^a x 2^(6-a)
  // grid.
  constexpr int kPoints = 64;
  for (int skip = 0; skip < 3; ++skip) {
    for (int a = 0; a <= 6; ++a) {
      std::vector<int> cells(kPoints, 0);
      const int columns = 1 << a, rows = kPoints >> a;
      for (uint32_t s = 0; s < kPoints; ++s) {
        PixelSampler sampler(42, s);
        for (int i = 0; i < skip; ++i) sampler.Next2D();
        const Vec2f p = sampler.Next2D();
        const int x = static_cast<int>(p.x() * static_cast<float>(columns));
        const int y = static_cast<int>(p.y() * static_cast<float>(rows));
        ++cells[static_cast<size_t>(y * columns + x)];
      }
      EXPECT_THAT(cells, testing::Each(1)) << "grid " << columns << " x " << rows;
    }
  }
}

TEST(Sampler, PixelsAreIndependent) {
  // The first sample of 200,000 pixels, on a 16 x 16 grid; significance 1e-3.
  constexpr int kPixels = 200000;
  std::vector<double> counts(256, 0.0);
  for (uint64_t pixel = 0; pixel < kPixels; ++pixel) {
    const Vec2f p = PixelSampler(pixel, 0).Next2D();
    counts[static_cast<size_t>(p.x() * 16) * 16 + static_cast<size_t>(p.y() * 16)] += 1.0;
  }
  EXPECT_GT(statistics::ChiSquarePValue(counts, std::vector<double>(256, kPixels / 256.0)), 1e-3);
}

TEST(Sampling, CosineHemisphereMatchesItsDensity) {
  // With density cos/pi, cos^2 is uniform on [0, 1]; significance 1e-3.
  KeyedRng rng(7);
  std::vector<double> counts(50, 0.0);
  constexpr int kSamples = 100000;
  for (int i = 0; i < kSamples; ++i) {
    const float z = SampleCosineHemisphere({rng.NextFloat(), rng.NextFloat()}).z();
    counts[std::min<size_t>(49, static_cast<size_t>(50.0f * z * z))] += 1.0;
  }
  EXPECT_GT(statistics::ChiSquarePValue(counts, std::vector<double>(50, kSamples / 50.0)), 1e-3);
}

TEST(Image, ExrKeepsIdsAndFloatsExactly) {
  ExrImage image;
  IdPlane ids(7, 5);
  FloatPlane floats(7, 5);
  std::iota(ids.data.begin(), ids.data.end(), 4000000006u);
  for (size_t i = 0; i < floats.data.size(); ++i) floats.data[i] = 1.0f / static_cast<float>(i + 3);
  image.channels = {{"id.object", ids}, {"electrons.Y", floats}};
  image.attributes["retrolux/seed"] = "17";
  WriteExr(Scratch("a.exr"), image);
  const ExrImage read = ReadExr(Scratch("a.exr"));
  EXPECT_EQ(read.Ids("id.object").data, ids.data);
  EXPECT_EQ(read.Float("electrons.Y").data, floats.data);
  EXPECT_EQ(read.attributes.at("retrolux/seed"), "17");
  EXPECT_THAT(MessageOf([&] { static_cast<void>(read.Float("depth.Z")); }),
              testing::HasSubstr("no FLOAT channel 'depth.Z'; expected one of electrons.Y"));
}

TEST(Image, PngKeepsDigitalNumbers) {
  for (const int bits : {8, 12}) {
    DigitalImage image;
    image.bits = bits;
    image.dn = Plane<uint16_t>(64, 3);
    for (size_t i = 0; i < image.dn.data.size(); ++i)
      image.dn.data[i] = static_cast<uint16_t>((i * 37) % (1u << bits));
    WritePng(Scratch("a.png"), image);
    EXPECT_EQ(ReadGrey(Scratch("a.png")).dn.data, image.dn.data) << bits << " bits";
  }
}

TEST(Image, NoPictureIsAnError) {
  WriteTextFile(Scratch("text.png"), "no picture");
  EXPECT_THAT(MessageOf([] { ReadGrey(Scratch("text.png")); }),
              testing::HasSubstr("expected a picture"));
  EXPECT_THAT(MessageOf([] { ReadGrey(Scratch("absent.png")); }),
              testing::HasSubstr("no such file; expected a picture"));
}

TEST(AtomicFile, LeavesNothingWithoutCommit) {
  fs::path temporary;
  {
    const AtomicFile file(Scratch("never.txt"));
    temporary = file.Temporary();
    std::ofstream(temporary) << "half";
  }
  EXPECT_FALSE(fs::exists(temporary));
  EXPECT_FALSE(fs::exists(Scratch("never.txt")));
  EXPECT_THAT(MessageOf([] { WriteTextFile("/proc/no/such/place", "x"); }),
              testing::HasSubstr("expected a place that can be written to"));
}

// The folder beside an installed program: tests/install_test.sh.
TEST(DataPath, TheEnvironmentsFolderBeforeTheSourceTree) {
  const fs::path ours = "scenes/data/markers.json";
  const fs::path source = DataPath(ours);
  fs::create_directories(OwnFolder() / ours.parent_path());
  WriteTextFile(OwnFolder() / ours, "{}");
  ASSERT_EQ(setenv("RETROLUX_DATA", OwnFolder().c_str(), 1), 0);
  EXPECT_EQ(DataPath(ours), OwnFolder() / ours);
  EXPECT_EQ(DataPath("scenes/data/sensors.json"), source.parent_path() / "sensors.json");
  EXPECT_THAT(MessageOf([] { DataPath("none.csv"); }),
              testing::MatchesRegex("none.csv: .*" + OwnFolder().string() +
                                    " or .*/share/retrolux or .*RETROLUX_DATA.*"));
  unsetenv("RETROLUX_DATA");
  EXPECT_THAT(MessageOf([] { DataPath("../none.csv"); }), testing::HasSubstr("leaves"));
}

TEST(Csv, NumbersWithSourceComments) {
  WriteTextFile(Scratch("t.csv"), "# source\na_nm,b\n1,2.5\n3,-4e2\n");
  EXPECT_EQ(ReadNumberTable(Scratch("t.csv")).rows[1][1], -400.0);
  WriteTextFile(Scratch("t.csv"), "a,b\n1,nan\n");
  EXPECT_THAT(MessageOf([] { ReadNumberTable(Scratch("t.csv")); }),
              testing::HasSubstr("line 2: 'nan'; expected a number"));
  WriteTextFile(Scratch("t.csv"), "a,b\n1\n");
  EXPECT_THAT(MessageOf([] { ReadNumberTable(Scratch("t.csv")); }),
              testing::HasSubstr("line 2: 1 cells; expected 2 (a, b)"));
}

TEST(Csv, TextsAsTheWriterQuotesThem) {
  CsvWriter csv({"name", "note"});
  csv.Row({"a, b", "says \"no\""});
  csv.Row({"two\nlines", ""});
  csv.Write(Scratch("q.csv"));
  const TextTable table = ReadTextTable(Scratch("q.csv"));
  EXPECT_EQ(table.columns, (std::vector<std::string>{"name", "note"}));
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[0], (std::vector<std::string>{"a, b", "says \"no\""}));
  EXPECT_EQ(table.rows[1], (std::vector<std::string>{"two\nlines", ""}));
  EXPECT_EQ(CellNumber("4.5"), 4.5);
  EXPECT_FALSE(CellNumber("4.5 mm"));
  EXPECT_FALSE(CellNumber(""));
  WriteTextFile(Scratch("q.csv"), "a\n1\n\"open\n");
  EXPECT_THAT(MessageOf([] { ReadTextTable(Scratch("q.csv")); }),
              testing::HasSubstr("line 3: a quote that does not end"));
}

TEST(JsonReader, ErrorsNamePlaceFoundAndExpected) {
  const auto read = [](const std::string& text, auto use) {
    return MessageOf([&] {
      JsonReader json = JsonReader::FromText(text, "s.json");
      use(json);
      json.Finish();
    });
  };
  const auto spp = [](JsonReader& json) { json.Integer("spp", 1, 100); };
  EXPECT_EQ(read(R"({"spp": 5} // comment)", spp), "no error");
  EXPECT_EQ(read(R"({"spp": -5})", spp),
            "s.json: /spp: found number -5; expected a number from 1 to 100");
  EXPECT_EQ(read(R"({"spp": "5"})", spp),
            "s.json: /spp: found string \"5\"; expected a number from 1 to 100");
  EXPECT_EQ(read(R"({"spp": 2.5})", spp),
            "s.json: /spp: found number 2.5; expected a whole number from 1 to 100");
  EXPECT_EQ(read(R"({"spp": 5, "ssp": 1})", spp),
            "s.json: /: found the unknown key 'ssp'; expected 'spp', perhaps");
  EXPECT_EQ(read(R"({})", spp), "s.json: /: found no key 'spp'; expected 'spp'");
  EXPECT_THAT(read(R"({"spp": NaN})", spp), testing::HasSubstr("line 1, column"));
  EXPECT_THAT(read(R"({"spp": 1e999})", spp), testing::HasSubstr("expected finite numbers"));
}

// What ends the outer loop does not cut short the loops within it: each of them is done whole, or
// not begun. (oneTBB hands a cancellation down otherwise.)
TEST(Parallel, AnErrorOutsideLeavesInnerLoopsWhole) {
  std::atomic<int> cut{0}, begun{0};
  EXPECT_THROW(ParallelFor(64,
                           [&](int64_t i) {
                             std::atomic<int> steps{0};
                             ++begun;
                             ParallelFor(200, [&](int64_t) {
                               std::this_thread::sleep_for(std::chrono::microseconds(50));
                               ++steps;
                             });
                             if (steps != 200) ++cut;
                             if (i == 1) throw InputError("one");
                           }),
               InputError);
  EXPECT_GT(begun, 1);
  EXPECT_EQ(cut, 0);
}

TEST(Yaml, BlocksBracketsAndComments) {
  const std::string text =
      "%YAML:1.0\n---\n# comment\nname: \"a: \\\"b\\\"\"\nwhole: -3 # comment\nreal: 1.5e+1\n"
      "huge: 1e400\nempty:\nlist:\n- 1.\n-  x: 1\n   y: !!opencv-matrix\n      rows: 3\n"
      "flow: { a: [ 1,\n 2 ], b: !!t { c: plain text } }\n";
  EXPECT_EQ(JsonOfYaml(text, "a.yml"), nlohmann::json::parse(R"({
      "name": "a: \"b\"", "whole": -3, "real": 15.0, "huge": "1e400", "empty": null,
      "list": [1.0, {"x": 1, "y": {"rows": 3}}],
      "flow": {"a": [1, 2], "b": {"c": "plain text"}}})"));
  const auto message = [](const std::string& body) {
    return MessageOf([&] { JsonOfYaml("%YAML:1.0\n---\n" + body, "a.yml"); });
  };
  EXPECT_THAT(message("a: [1, 2"), testing::HasSubstr("a.yml: line "));
  EXPECT_THAT(message("a: *b"), testing::HasSubstr("expected YAML as OpenCV's FileStorage writes"));
  std::string deep = "a:";
  for (int i = 0; i < 100; ++i) deep += "\n" + std::string(static_cast<size_t>(i), ' ') + "-";
  EXPECT_THAT(message(deep), testing::HasSubstr("YAML nested more than 64 deep"));
  EXPECT_THAT(message("a: " + std::string(100'000, '[')), testing::HasSubstr("a.yml: line "));
}

TEST(Parallel, AllStepsOnceAndErrorsComeThrough) {
  std::vector<int> steps(1000, 0);
  ParallelFor(1000, [&](int64_t i) { ++steps[static_cast<size_t>(i)]; });
  EXPECT_THAT(steps, testing::Each(1));
  EXPECT_THROW(ParallelFor(10,
                           [](int64_t i) {
                             if (i == 7) throw InputError("seven");
                           }),
               InputError);
}

}  // namespace
}  // namespace retrolux
