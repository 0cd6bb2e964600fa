// How pictures and the results of runs are compared.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "analysis/folder_difference.h"
#include "analysis/picture_view.h"
#include "core/atomic_file.h"
#include "core/image_file.h"
#include "tests/message_of.h"
#include "tests/own_folder.h"

namespace retrolux {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr int kWidth = 200, kHeight = 100;

FloatPlane Flat(float value) {
  return FloatPlane(kWidth, kHeight, value);
}

// Of electrons, their variance, and ids.
fs::path Picture(const std::string& name, const FloatPlane& electrons, float variance,
                 const IdPlane& ids = IdPlane(kWidth, kHeight, 1)) {
  const fs::path file = OwnFolder() / name;
  WriteExr(file, {{{"electrons.Y", electrons}, {"variance.Y", Flat(variance)}, {"id.object", ids}},
                  {{"retrolux/objects", "1=mask, 2=couch, left, 3=bore"}}});
  return file;
}

const ChannelDifference& Channel(const PictureDifference& difference, const std::string& name) {
  for (const ChannelDifference& channel : difference.channels) {
    if (channel.name == name) return channel;
  }
  throw std::logic_error("no channel " + name);
}

// b - a = 2 everywhere over a = 10: relMSE = 4 / (100 + (0.01 10)^2).
TEST(ComparePictures, MeasuresOfAConstantShift) {
  const PictureDifference difference = ComparePictures(
      ReadPair(Picture("a.exr", Flat(10.0f), 0.0f), Picture("b.exr", Flat(12.0f), 0.0f)));
  EXPECT_FALSE(difference.Same());
  const ChannelDifference& electrons = Channel(difference, "electrons.Y");
  EXPECT_EQ(electrons.different, kWidth * kHeight);
  EXPECT_DOUBLE_EQ(electrons.bias, 2.0);
  EXPECT_DOUBLE_EQ(electrons.rms, 2.0);
  EXPECT_DOUBLE_EQ(electrons.most, 2.0);
  EXPECT_NEAR(electrons.relative_mse, 4.0 / 100.01, 1e-9);
  EXPECT_EQ(electrons.unit, "e-");
  EXPECT_FALSE(electrons.rms_in_sigmas) << "no pixel has a variance";
  EXPECT_EQ(Channel(difference, "id.object").different, 0);
}

// Two pictures that differ by noise of the variance that they state, 9 + 16: the squares in units
// of it follow chi-square of as many degrees as pixels, so their mean is 1 within 5 sqrt(2 / N)
// (significance 6e-7, seed fixed).
TEST(ComparePictures, NoiseIsOneSigma) {
  std::mt19937_64 rng(1);
  std::normal_distribution<float> unit;
  FloatPlane a = Flat(100.0f), b = Flat(100.0f);
  for (float& value : a.data) value += 3.0f * unit(rng);
  for (float& value : b.data) value += 4.0f * unit(rng);
  const PictureDifference difference =
      ComparePictures(ReadPair(Picture("na.exr", a, 9.0f), Picture("nb.exr", b, 16.0f)));
  const std::optional<double> sigmas = Channel(difference, "electrons.Y").rms_in_sigmas;
  ASSERT_TRUE(sigmas);
  EXPECT_NEAR(*sigmas * *sigmas, 1.0, 5.0 * std::sqrt(2.0 / (kWidth * kHeight)));
}

TEST(ComparePictures, IdsAndNaNs) {
  IdPlane ids(kWidth, kHeight, 1);
  for (int x = 0; x < 7; ++x) ids(x, 3) = 2;
  FloatPlane holes = Flat(1.0f);
  holes(5, 5) = std::nanf("");
  const PictureDifference difference = ComparePictures(
      ReadPair(Picture("ia.exr", holes, 0.0f), Picture("ib.exr", holes, 0.0f, ids)));
  EXPECT_EQ(Channel(difference, "electrons.Y").different, 0) << "NaN is the same as NaN";
  EXPECT_EQ(Channel(difference, "id.object").different, 7);
  EXPECT_TRUE(Channel(difference, "id.object").ids);
}

// One DN apart everywhere: 20 log10(255) = 48.13 dB.
TEST(ComparePictures, PsnrOfDigitalPictures) {
  const fs::path a = OwnFolder() / "a.png", b = OwnFolder() / "b.png";
  WritePng(a, {Plane<uint16_t>(kWidth, kHeight, 100), 8});
  WritePng(b, {Plane<uint16_t>(kWidth, kHeight, 101), 8});
  const PictureDifference difference = ComparePictures(ReadPair(a, b));
  ASSERT_TRUE(Channel(difference, "grey").psnr_db);
  EXPECT_NEAR(*Channel(difference, "grey").psnr_db, 20.0 * std::log10(255.0), 1e-9);
  EXPECT_TRUE(ComparePictures(ReadPair(a, a)).Same());
  WritePng(b, {Plane<uint16_t>(kWidth, 50, 100), 8});
  EXPECT_THAT(MessageOf([&] { ReadPair(a, b); }), HasSubstr("200 x 50 px; expected 200 x 100"));
}

TEST(ReadChannels, NamesAndUnits) {
  const PictureChannels picture = ReadChannels(Picture("c.exr", Flat(3.0f), 1.0f));
  EXPECT_EQ(picture.channels.front().name, "electrons.Y");
  ASSERT_TRUE(picture.Find("id.object"));
  EXPECT_EQ(picture.Find("id.object")->names,
            (std::vector<std::string>{"mask", "couch, left", "bore"}));
  EXPECT_EQ(Summarise(*picture.Find("electrons.Y")).mean, 3.0);
  EXPECT_THAT(MessageOf([] { PictureView(OwnFolder() / "c.exr", {"electron.Y"}, ""); }),
              HasSubstr("no channel 'electron.Y'; expected one of electrons.Y, "));
}

void WriteRun(const fs::path& folder, const std::string& table, const std::string& json) {
  fs::create_directories(folder / "tasks");
  WriteTextFile(folder / "hits.csv", table);
  WriteTextFile(folder / "summary.json", json);
  WriteTextFile(folder / "run.json", "{\"seconds\": " + std::to_string(table.size()) + "}");
  WriteTextFile(folder / "tasks" / "t.json", table);
}

TEST(CompareFolders, TablesByColumnAndJsonByValue) {
  const fs::path a = OwnFolder() / "run-a", b = OwnFolder() / "run-b";
  WriteRun(a, "marker,x_mm,reason\n2,1.5,\"a, b\"\n3,2.5,hidden\n",
           "{\"areas\": [1, 2], \"name\": \"n\"}");
  WriteRun(b, "marker,x_mm,reason\n2,1.5,\"a, b\"\n3,4.5,\n",
           "{\"areas\": [1, 5], \"name\": \"n\"}");
  WriteTextFile(b / "more.csv", "a\n1\n");
  const std::vector<FileDifference> files = CompareFolders(a, b);
  ASSERT_EQ(files.size(), 3u) << "times and tasks are left out";
  EXPECT_EQ(files[0].file, "hits.csv");
  ASSERT_EQ(files[0].values.size(), 2u);
  EXPECT_EQ(files[0].values[0].name, "x_mm");
  EXPECT_EQ(files[0].values[0].different, 1);
  EXPECT_EQ(files[0].values[0].numbers, 2);
  EXPECT_DOUBLE_EQ(files[0].values[0].bias, 1.0);
  EXPECT_DOUBLE_EQ(files[0].values[0].most, 2.0);
  EXPECT_EQ(files[0].values[1].name, "reason");
  EXPECT_EQ(files[0].values[1].numbers, 0);
  EXPECT_EQ(files[1].note, "only in b");
  ASSERT_EQ(files[2].values.size(), 1u);
  EXPECT_EQ(files[2].values[0].name, "/areas/1");
  EXPECT_DOUBLE_EQ(files[2].values[0].bias, 3.0);
  for (const FileDifference& file : CompareFolders(a, a)) EXPECT_TRUE(file.same) << file.file;
  WriteTextFile(b / "hits.csv", "marker,x_mm,reason\n2,1.5,\n");
  EXPECT_EQ(CompareFolders(a, b)[0].note, "2 rows and 1");
}

}  // namespace
}  // namespace retrolux
