// The sensor: its random numbers, the linear model, the pattern of its pixels, and its options.
// What EMVA 1288 measures from its pictures is in analysis/checks_sensor.cpp.
#include "renderer/sensor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "renderer/exposure.h"
#include "renderer/sensor_blooming.h"
#include "renderer/sensor_fields.h"
#include "renderer/sensor_noise.h"
#include "renderer/sensor_smear.h"
#include "scenes/built_in.h"
#include "tests/statistics.h"

namespace retrolux {
namespace {

using statistics::Moments;
using statistics::MomentsOf;

// --- random numbers ---

TEST(Poisson, CountsFollowTheProbabilities) {
  // Cells of one or more counts that expect 20 or more, by P(k) = mean^k exp(-mean) / k!. Means on
  // both sides of the change of method at 10. Significance 1 % for all.
  constexpr int kSamples = 200000;
  const double means[] = {0.3, 5.0, 9.99, 10.01, 50.0, 1000.0};
  for (const double mean : means) {
    std::vector<double> expected = {0.0};
    std::vector<size_t> cell_of;  // of a count
    for (int k = 0; k < mean + 12.0 * std::sqrt(mean) + 12.0; ++k) {
      if (expected.back() >= 20.0) expected.push_back(0.0);
      expected.back() += kSamples * std::exp(k * std::log(mean) - mean - std::lgamma(k + 1.0));
      cell_of.push_back(expected.size() - 1);
    }
    while (expected.back() < 20.0) {  // the upper tail belongs to the last cell
      expected[expected.size() - 2] += expected.back();
      expected.pop_back();
    }
    std::vector<double> observed(expected.size(), 0.0);
    KeyedRng rng(11);
    for (int i = 0; i < kSamples; ++i) {
      const double k = SamplePoisson(mean, rng);
      ASSERT_EQ(k, std::floor(k));
      ASSERT_GE(k, 0.0);
      const auto index = std::min(static_cast<size_t>(k), cell_of.size() - 1);
      observed[std::min(cell_of[index], expected.size() - 1)] += 1.0;
    }
    EXPECT_GT(statistics::ChiSquarePValue(observed, expected),
              statistics::Sidak(0.01, std::size(means)))
        << mean;
  }
  KeyedRng rng(1);
  EXPECT_EQ(SamplePoisson(0.0, rng), 0.0);
}

TEST(Poisson, MeanAndVarianceOfLargeSignals) {
  // Both are the mean. The standard error of the variance of n numbers is sqrt((m4 - var^2) / n)
  // with m4 = mean + 3 mean^2. Significance 1 %.
  constexpr int kSamples = 200000;
  for (const double mean : {20000.0, 1e7}) {
    KeyedRng rng(12);
    std::vector<double> counts(kSamples);
    for (double& k : counts) k = SamplePoisson(mean, rng);
    const Moments m = MomentsOf(counts);
    EXPECT_GT(statistics::NormalPValue((m.mean - mean) / std::sqrt(mean / kSamples)),
              statistics::Sidak(0.01, 4))
        << mean;
    EXPECT_GT(statistics::NormalPValue((m.variance - mean) /
                                       std::sqrt((mean + 2.0 * mean * mean) / kSamples)),
              statistics::Sidak(0.01, 4))
        << mean;
  }
}

TEST(Normal, FollowsItsDistribution) {
  // The distribution function of normal numbers is uniform on [0, 1]: 200 equal cells; significance
  // 1 %.
  constexpr int kSamples = 200000, kCells = 200;
  std::vector<double> counts(kCells, 0.0);
  KeyedRng rng(13);
  for (int i = 0; i < kSamples; ++i) {
    const double below = 0.5 * std::erfc(-SampleNormal(rng) / std::numbers::sqrt2);
    counts[std::min<size_t>(kCells - 1, static_cast<size_t>(below * kCells))] += 1.0;
  }
  EXPECT_GT(
      statistics::ChiSquarePValue(counts, std::vector<double>(kCells, 1.0 * kSamples / kCells)),
      0.01);
}

// --- the linear model ---

// Without noise but that of the light.
SensorSpec QuietSensor() {
  SensorSpec sensor;
  sensor.read_noise_e = 0.0;
  sensor.dark_current_e_s = 0.0;
  sensor.prnu = 0.0;
  sensor.dsnu_e = 0.0;
  return sensor;
}

// 16 bits in steps of one electron, nothing clipped below 65,000.
SensorSpec CountingSensor() {
  SensorSpec sensor = QuietSensor();
  sensor.adc_bits = 16;
  sensor.offset_dn = 0.0;
  sensor.gain_dn_e = 1.0;
  sensor.full_well_e = 65000.0;
  return sensor;
}

// One exposure of 1 ms to `light`.
DigitalImage Expose(const SensorSpec& spec, const FloatPlane& light, uint64_t key = 1) {
  return Sensor(spec, "test", light.width, light.height).Expose(light, 1e-3, key);
}

TEST(Sensor, ClipsAtTheFullWell) {
  // 10^6 e- on pixels that hold 30,000: with 0.005 DN/e- all read 3 + 150 DN, far below the 255 of
  // the ADC.
  SensorSpec sensor = QuietSensor();
  sensor.gain_dn_e = 0.005;
  EXPECT_THAT(Expose(sensor, FloatPlane(32, 32, 1e6f)).dn.data, testing::Each(153));
}

TEST(Sensor, OffsetAndRangeOfTheAdc) {
  SensorSpec sensor = QuietSensor();
  EXPECT_THAT(Expose(sensor, FloatPlane(32, 32)).dn.data, testing::Each(3));
  // By default a full well is the largest number, at any number of bits.
  for (const int bits : {8, 10, 12, 16}) {
    sensor.adc_bits = bits;
    sensor.gain_dn_e = 0.0;
    const DigitalImage image = Expose(sensor, FloatPlane(8, 8, 1e6f));
    EXPECT_EQ(image.bits, bits);
    EXPECT_THAT(image.dn.data, testing::Each((1 << bits) - 1));
    EXPECT_NEAR(sensor.offset_dn + GainDnPerElectron(sensor) * sensor.full_well_e, (1 << bits) - 1,
                1e-9);
    // And with more gain the ADC clips before the well is full.
    sensor.gain_dn_e = 10.0;
    EXPECT_THAT(Expose(sensor, FloatPlane(8, 8, 2e4f)).dn.data, testing::Each((1 << bits) - 1));
  }
  // Noise about zero without an offset: half of the numbers would be negative and read 0. Read
  // noise and DSNU together have sqrt(20^2 + 8^2) e-. 65,536 pixels, of which the share that reads
  // 0 has P(noise < 0.5 DN) = 0.5 + 0.0093 and a standard error of 0.002.
  SensorSpec no_offset;
  no_offset.offset_dn = 0.0;
  no_offset.gain_dn_e = 1.0;
  no_offset.dark_current_e_s = 0.0;
  const DigitalImage dark = Expose(no_offset, FloatPlane(256, 256));
  const auto zeros = static_cast<double>(std::count(dark.dn.data.begin(), dark.dn.data.end(), 0));
  EXPECT_NEAR(zeros / 65536.0, 0.5 * std::erfc(-0.5 / std::hypot(20.0, 8.0) / std::numbers::sqrt2),
              4.0 * 0.002);
}

// Mean and variance of a dark current of 50,000 e-/s over 0.1 s on top of a signal of 1000 e-, at
// 0.5 DN/e-: `dark_e` times 5000 more electrons, and 400 e-^2 of read noise. Significance 1 %.
void ExpectDarkSignal(const SensorSpec& sensor, double factor) {
  const FloatPlane light(256, 256, 1000.0f);
  const Moments m = MomentsOf(Sensor(sensor, "test", 256, 256).Expose(light, 0.1, 5).dn.data);
  const double electrons = 1000.0 + factor * 5000.0, n = 65536.0;
  const double variance = 0.25 * (electrons + 400.0) + 1.0 / 12.0;
  EXPECT_GT(statistics::NormalPValue((m.mean - 50.0 - 0.5 * electrons) / std::sqrt(variance / n)),
            statistics::Sidak(0.01, 6));
  EXPECT_GT(statistics::NormalPValue((m.variance - variance) / (variance * std::sqrt(2.0 / n))),
            statistics::Sidak(0.01, 6));
}

TEST(Sensor, DarkCurrentGrowsWithExposureAndTemperature) {
  // mu_I(T) = mu_I(T_ref) 2^((T - T_ref) / T_d): twice at 8 K more, 1/4 at 16 K less. Its shot
  // noise grows with it.
  SensorSpec sensor = QuietSensor();
  sensor.read_noise_e = 20.0;
  sensor.adc_bits = 14;
  sensor.offset_dn = 50.0;
  sensor.gain_dn_e = 0.5;
  sensor.dark_current_e_s = 50000.0;
  ExpectDarkSignal(sensor, 1.0);
  sensor.temperature_c = sensor.dark_reference_c + sensor.dark_doubling_k;
  ExpectDarkSignal(sensor, 2.0);
  sensor.temperature_c = sensor.dark_reference_c - 2.0 * sensor.dark_doubling_k;
  ExpectDarkSignal(sensor, 0.25);
}

TEST(Sensor, NoiseBelongsToItsPicture) {
  const FloatPlane light(64, 64, 5000.0f);
  SensorSpec spec;
  spec.prnu = 0.0;
  spec.dsnu_e = 0.0;
  const Sensor sensor(spec, "test", 64, 64);
  const DigitalImage a = sensor.Expose(light, 1e-3, 1), b = sensor.Expose(light, 1e-3, 2);
  EXPECT_EQ(a.dn.data, sensor.Expose(light, 1e-3, 1).dn.data);
  EXPECT_NE(a.dn.data, b.dn.data);
  // Independent: the correlation of 4096 pairs is zero within 4 / sqrt(4096).
  const Moments ma = MomentsOf(a.dn.data), mb = MomentsOf(b.dn.data);
  double product = 0.0;
  for (size_t i = 0; i < a.dn.data.size(); ++i)
    product += (a.dn.data[i] - ma.mean) * (b.dn.data[i] - mb.mean);
  EXPECT_LT(std::abs(product / 4096.0 / std::sqrt(ma.variance * mb.variance)), 4.0 / 64.0);
}

TEST(Sensor, NoiseOfAPixelDoesNotDependOnTheLightOfOthers) {
  // So another seed of the light transport leaves the noise alone.
  FloatPlane light(64, 64, 500.0f);
  const Sensor sensor({}, "test", 64, 64);
  const DigitalImage before = sensor.Expose(light, 1e-3, 1);
  for (int x = 0; x < 64; ++x) light(x, 20) = 20000.0f;
  const DigitalImage after = sensor.Expose(light, 1e-3, 1);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      if (y == 20) {
        EXPECT_GT(after.dn(x, y), before.dn(x, y));
      } else {
        EXPECT_EQ(after.dn(x, y), before.dn(x, y));
      }
    }
  }
}

TEST(Sensor, ThreadsChangeNothing) {
  // Eight pictures of one sensor with all options, on one thread and on two.
  SensorSpec spec;
  spec.scan = Scan::kInterlaced;
  spec.blooming = Blooming{};
  spec.smear = Smear{};
  spec.defects = DefectPixels{};
  FloatPlane light(64, 64, 3000.0f);
  light(20, 30) = 5e5f;
  const Sensor sensor(spec, "test", 64, 64);
  std::vector<DigitalImage> pictures[2];
  for (const int threads : {1, 2}) {
    const LimitThreads limit(threads);
    std::vector<DigitalImage>& these = pictures[threads - 1];
    these.resize(8);
    ParallelFor(8, [&](int64_t i) {
      these[static_cast<size_t>(i)] = sensor.Expose(light, 1e-3, static_cast<uint64_t>(i));
    });
  }
  for (size_t i = 0; i < 8; ++i) EXPECT_EQ(pictures[0][i].dn.data, pictures[1][i].dn.data);
}

// --- the pattern of the pixels ---

TEST(Pattern, BelongsToTheSerialAndThePixel) {
  SensorSpec sensor;
  sensor.defects = DefectPixels{1000.0, 1e4, 1000.0};
  const PixelPattern a = MakePixelPattern(sensor, "a", 64, 48);
  const PixelPattern b = MakePixelPattern(sensor, "b", 64, 48);
  EXPECT_EQ(a.response.data, MakePixelPattern(sensor, "a", 64, 48).response.data);
  EXPECT_NE(a.response.data, b.response.data);
  EXPECT_NE(a.offset_e.data, b.offset_e.data);
  EXPECT_NE(a.dark_current_e_s.data, b.dark_current_e_s.data);
  // A serial stands above the camera's name; one that is the name is the same part.
  sensor.serial = "a";
  const PixelPattern part = MakePixelPattern(sensor, "b", 64, 48);
  EXPECT_EQ(part.response.data, a.response.data);
  EXPECT_EQ(part.offset_e.data, a.offset_e.data);
  EXPECT_EQ(part.dark_current_e_s.data, a.dark_current_e_s.data);
  // The pixel's place decides, not the size of the picture.
  const PixelPattern larger = MakePixelPattern(sensor, "b", 128, 96);
  for (const auto& [x, y] : {std::pair(0, 0), std::pair(63, 47), std::pair(17, 40)}) {
    EXPECT_EQ(larger.response(x, y), a.response(x, y));
    EXPECT_EQ(larger.offset_e(x, y), a.offset_e(x, y));
  }
}

TEST(Pattern, HasTheMomentsThatItIsDescribedWith) {
  // Standard errors of mean and standard deviation: sigma / sqrt(n) and sigma / sqrt(2 n). Not
  // correlated: 1 / sqrt(n). Significance 1 % for all.
  SensorSpec sensor;
  const PixelPattern pattern = MakePixelPattern(sensor, "moments", 256, 256);
  constexpr double kPixels = 65536.0;
  const auto expect = [](const Moments& m, double mean, double sigma) {
    EXPECT_GT(statistics::NormalPValue((m.mean - mean) / (sigma / std::sqrt(kPixels))),
              statistics::Sidak(0.01, 5));
    EXPECT_GT(statistics::NormalPValue((std::sqrt(m.variance) - sigma) /
                                       (sigma / std::sqrt(2.0 * kPixels))),
              statistics::Sidak(0.01, 5));
  };
  expect(MomentsOf(pattern.response.data), 1.0, 0.01);
  expect(MomentsOf(pattern.offset_e.data), 0.0, 8.0);
  double product = 0.0;
  for (size_t i = 0; i < pattern.response.data.size(); ++i) {
    product += static_cast<double>((pattern.response.data[i] - 1.0f) / 0.01f *
                                   pattern.offset_e.data[i] / 8.0f);
  }
  EXPECT_GT(statistics::NormalPValue(product / std::sqrt(kPixels)), statistics::Sidak(0.01, 5));
}

TEST(Pattern, MultipliesTheLightAndShiftsTheDark) {
  // In each pixel the mean of 100 pictures is offset + response x light + dark current, with a
  // standard error of sqrt(charge / 100) and steps of 1 DN. 1024 pixels in two lights: 5 of them.
  SensorSpec sensor = CountingSensor();
  sensor.offset_dn = 500.0;
  sensor.prnu = 0.05;
  sensor.dsnu_e = 50.0;
  sensor.dark_current_e_s = 1e6;  // 1000 e- in 1 ms, which the response must not touch
  const PixelPattern pattern = MakePixelPattern(sensor, "test", 32, 32);
  for (const float light : {0.0f, 20000.0f}) {
    std::vector<double> mean(1024, 0.0);
    for (uint64_t key = 0; key < 100; ++key) {
      const DigitalImage image = Expose(sensor, FloatPlane(32, 32, light), key);
      for (size_t i = 0; i < mean.size(); ++i) mean[i] += image.dn.data[i] / 100.0;
    }
    for (size_t i = 0; i < mean.size(); ++i) {
      const double charge = static_cast<double>(light * pattern.response.data[i]) + 1000.0;
      EXPECT_NEAR(mean[i], 500.0 + charge + static_cast<double>(pattern.offset_e.data[i]),
                  5.0 * std::sqrt((charge + 1.0) / 100.0))
          << i << " in " << light;
    }
  }
}

// --- defect pixels ---

TEST(Defects, AreAsManyAsTheyShouldBe) {
  // Binomial: standard error sqrt(n p) for small p. Significance 1 %.
  SensorSpec sensor;
  sensor.defects = DefectPixels{2000.0, 10000.0, 500.0};
  sensor.temperature_c = sensor.dark_reference_c + sensor.dark_doubling_k;
  const PixelPattern pattern = MakePixelPattern(sensor, "defects", 640, 480);
  double hot = 0.0, dead = 0.0;
  for (size_t i = 0; i < pattern.response.data.size(); ++i) {
    dead += pattern.response.data[i] == 0.0f ? 1.0 : 0.0;
    if (pattern.dark_current_e_s.data[i] == 100.0f) continue;  // 50 e-/s, twice
    EXPECT_EQ(pattern.dark_current_e_s.data[i], 20100.0f);     // and 10,000 e-/s more, twice
    EXPECT_NE(pattern.response.data[i], 0.0f);
    hot += 1.0;
  }
  const double n = 640.0 * 480.0;
  EXPECT_GT(statistics::NormalPValue((hot - 2e-3 * n) / std::sqrt(2e-3 * n)),
            statistics::Sidak(0.01, 2));
  EXPECT_GT(statistics::NormalPValue((dead - 5e-4 * n) / std::sqrt(5e-4 * n)),
            statistics::Sidak(0.01, 2));
}

// --- blooming ---

Plane<double> Column(const std::vector<double>& charge_e) {
  Plane<double> column(1, static_cast<int>(charge_e.size()));
  column.data = charge_e;
  return column;
}

double Sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(Blooming, ASingleHotPixelFlowsToBothSidesAlike) {
  // 1000 e- above wells of 100 that hold 30 each: it keeps 100, and 900 go to both sides, 70 to a
  // well: six wells and 30 e- more on each side.
  std::vector<double> charge(41, 30.0);
  charge[20] = 1000.0;
  Plane<double> column = Column(charge);
  Bloom({}, 100.0, column);
  for (int d = 0; d <= 20; ++d) {
    const double expected = d <= 6 ? 100.0 : (d == 7 ? 60.0 : 30.0);
    EXPECT_NEAR(column(0, 20 + d), expected, 1e-9) << d;
    EXPECT_NEAR(column(0, 20 - d), expected, 1e-9) << d;
  }
  EXPECT_NEAR(Sum(column.data), Sum(charge), 1e-9);
}

TEST(Blooming, TheDrainTakesItsShare) {
  std::vector<double> charge(41, 30.0);
  charge[20] = 1000.0;
  Plane<double> column = Column(charge);
  Bloom({0.75}, 100.0, column);
  EXPECT_NEAR(Sum(column.data), Sum(charge) - 0.75 * 900.0, 1e-9);
  Plane<double> drained = Column(charge);
  Bloom({1.0}, 100.0, drained);
  charge[20] = 100.0;
  EXPECT_EQ(drained.data, charge);
}

TEST(Blooming, WallsKeepTheChargeAndAFullColumnLosesIt) {
  // At the top of the column all goes down: 900 e- fill twelve wells of 70 and 60 of the next.
  std::vector<double> charge(41, 30.0);
  charge[0] = 1000.0;
  Plane<double> column = Column(charge);
  Bloom({}, 100.0, column);
  for (int y = 0; y < 41; ++y)
    EXPECT_NEAR(column(0, y), y <= 12 ? 100.0 : (y == 13 ? 90.0 : 30.0), 1e-9) << y;
  Plane<double> full = Column({50.0, 500.0, 50.0});
  Bloom({}, 100.0, full);
  EXPECT_THAT(full.data, testing::Each(100.0));
}

// A well above its capacity gives half of the excess to either neighbour, and at a wall what would
// leave comes back; in the given order, until nothing is above.
std::vector<double> Topple(std::vector<double> charge, double well, bool downwards) {
  const auto n = charge.size();
  for (bool again = true; again;) {
    again = false;
    for (size_t k = 0; k < n; ++k) {
      const size_t i = downwards ? k : n - 1 - k;
      const double excess = charge[i] - well;
      if (excess < 1e-9) continue;
      again = true;
      charge[i] = well;
      charge[i == 0 ? 0 : i - 1] += 0.5 * excess;
      charge[i == n - 1 ? n - 1 : i + 1] += 0.5 * excess;
    }
  }
  return charge;
}

TEST(Blooming, IsWhereEqualSharingEndsInAnyOrder) {
  KeyedRng rng(61);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<double> charge(40);
    for (double& c : charge)
      c = rng.NextDouble() < 0.15 ? 600.0 * rng.NextDouble() : 90.0 * rng.NextDouble();
    if (Sum(charge) > 0.95 * 100.0 * 40.0) continue;  // hardly any room: sharing takes for ever
    Plane<double> column = Column(charge);
    Bloom({}, 100.0, column);
    const std::vector<double> down = Topple(charge, 100.0, true), up = Topple(charge, 100.0, false);
    for (size_t i = 0; i < charge.size(); ++i) {
      EXPECT_NEAR(column.data[i], down[i], 1e-5);
      EXPECT_NEAR(column.data[i], up[i], 1e-5);
    }
  }
}

TEST(Blooming, StaysInItsColumn) {
  // 200,000 e- on one photosite of 30,000 over a picture of 1000: a column of wells that are full,
  // (200,000 - 30,000) / 29,000 = 5.9 of them beside the pixel, and no change elsewhere.
  SensorSpec sensor = CountingSensor();
  sensor.full_well_e = 30000.0;
  FloatPlane light(9, 64, 1000.0f);
  light(4, 32) = 2e5f;
  const DigitalImage without = Expose(sensor, light);
  sensor.blooming = Blooming{};
  const DigitalImage with = Expose(sensor, light);
  int full = 0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 9; ++x) {
      if (x == 4 && std::abs(y - 32) <= 3) continue;
      EXPECT_EQ(with.dn(x, y), without.dn(x, y));
    }
    if (with.dn(4, y) == 30000) ++full;
  }
  EXPECT_EQ(full, 5);  // and the two next ones are nearly so
}

// --- smear ---

TEST(Smear, IsTheLightOfTheColumnOverTheTimeOfALine) {
  // 33 rows of 50,000 e- in 1 ms, lines of 64 us, 1e-5: 50,000 x 33 x 1e-5 x 0.064 = 1.056 e-.
  FloatPlane light(8, 480);
  for (int y = 100; y < 133; ++y) light(3, y) = 50000.0f;
  const Smear smear{1e-5, 64e-6};
  const std::vector<double> charge = SmearCharge(smear, light, 1e-3);
  for (size_t x = 0; x < 8; ++x) EXPECT_NEAR(charge[x], x == 3 ? 1.056 : 0.0, 1e-9);
  EXPECT_NEAR(SmearCharge(smear, light, 0.5e-3)[3], 2.112, 1e-9);  // a shorter exposure smears more
}

TEST(Smear, FillsTheWholeColumnWithItsShotNoise) {
  // A column of 480 rows of which one half, 10,000 e- each, lights: 240 x 10,000 x 1e-3 x 0.064 =
  // 153.6 e- on all rows, beyond the full well too; Poisson. Significance 1 %.
  SensorSpec sensor = CountingSensor();
  sensor.full_well_e = 8000.0;
  sensor.smear = Smear{1e-3, 64e-6};
  FloatPlane light(400, 480);
  for (int y = 240; y < 480; ++y) {
    for (int x = 0; x < 400; x += 2) light(x, y) = 10000.0f;
  }
  const DigitalImage image = Expose(sensor, light);
  std::vector<double> dark, full;
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 400; x += 2) {
      (y < 240 ? dark : full).push_back(image.dn(x, y) - (y < 240 ? 0.0 : 8000.0));
      EXPECT_EQ(image.dn(x + 1, y), 0);
    }
  }
  for (const auto& charges : {dark, full}) {
    const Moments m = MomentsOf(charges);
    const double n = static_cast<double>(m.count);
    EXPECT_GT(statistics::NormalPValue((m.mean - 153.6) / std::sqrt(153.6 / n)),
              statistics::Sidak(0.01, 4));
    EXPECT_GT(statistics::NormalPValue((m.variance - 153.6) / (153.6 * std::sqrt(2.0 / n))),
              statistics::Sidak(0.01, 4));
  }
}

// --- interlaced scan ---

TEST(Fields, AddTwoLinesAndShiftByOne) {
  Plane<double> first(1, 6), second(1, 6);
  for (int y = 0; y < 6; ++y) {
    first(0, y) = std::pow(10.0, y);
    second(0, y) = 2.0 * std::pow(10.0, y);
  }
  EXPECT_THAT(WeaveFields(first, second).data,
              testing::ElementsAre(11.0, 220.0, 1100.0, 22000.0, 110000.0, 200000.0));
}

TEST(Fields, HaveTheirOwnExposureAndNoise) {
  // Each row holds the electrons of two lines, 2 x 5000, with their variance. Rows 0 and 1 share
  // line 1, but not its exposure: their noise is not correlated. 1 % for all.
  SensorSpec sensor = CountingSensor();
  sensor.scan = Scan::kInterlaced;
  const DigitalImage image = Expose(sensor, FloatPlane(4096, 4, 5000.0f));
  std::vector<double> rows[2];
  for (int x = 0; x < 4096; ++x) {
    for (int y = 0; y < 2; ++y) rows[y].push_back(image.dn(x, y));
  }
  double product = 0.0;
  for (size_t i = 0; i < 4096; ++i) product += (rows[0][i] - 1e4) * (rows[1][i] - 1e4) / 1e4;
  EXPECT_GT(statistics::NormalPValue(product / std::sqrt(4096.0)), statistics::Sidak(0.01, 5));
  for (const auto& row : rows) {
    const Moments m = MomentsOf(row);
    EXPECT_GT(statistics::NormalPValue((m.mean - 1e4) / std::sqrt(1e4 / 4096.0)),
              statistics::Sidak(0.01, 5));
    EXPECT_GT(statistics::NormalPValue((m.variance - 1e4) / (1e4 * std::sqrt(2.0 / 4096.0))),
              statistics::Sidak(0.01, 5));
  }
}

TEST(Fields, TwoFullWellsAreTheLargestNumber) {
  SensorSpec sensor = QuietSensor();
  sensor.scan = Scan::kInterlaced;
  EXPECT_NEAR(sensor.offset_dn + GainDnPerElectron(sensor) * 2.0 * sensor.full_well_e, 255.0, 1e-9);
  const DigitalImage image = Expose(sensor, FloatPlane(8, 8, 1e6f));
  for (int y = 0; y < 8; ++y) EXPECT_EQ(image.dn(3, y), y < 7 ? 255 : 129);  // 3 + 252 / 2
}

TEST(Fields, TheDerivedExposureTakesUpTheTwoLines) {
  // With the gain given, half the time; with two full wells on the whole range, the same.
  Scene scene = OvalScene();
  CameraSpec& camera = scene.cameras[0];
  const double progressive_s = ExposureSeconds(scene, camera);
  camera.sensor.scan = Scan::kInterlaced;
  EXPECT_NEAR(ExposureSeconds(scene, camera), progressive_s, 1e-9 * progressive_s);
  camera.sensor.gain_dn_e = 252.0 / 30000.0;
  EXPECT_NEAR(ExposureSeconds(scene, camera), 0.5 * progressive_s, 1e-9 * progressive_s);
}

}  // namespace
}  // namespace retrolux
