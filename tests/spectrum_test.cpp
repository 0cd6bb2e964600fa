// Light over wavelength: LEDs and their temperature, the room's lights, filters from tables.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "core/atomic_file.h"
#include "core/data_path.h"
#include "scenes/scene.h"
#include "tests/message_of.h"
#include "tests/own_folder.h"

namespace retrolux {
namespace {

double At(const Spectrum& spectrum, double nm) {
  return static_cast<double>(spectrum.At(static_cast<float>(nm)));
}

TEST(Led, OhnosShapeHasItsWidthAndIsSharper) {
  // (g + 2 g^5) / 3 is a half where g = 0.8086. At the full width from the peak the exponent is
  // four times as large: g = 0.8086^4 = 0.4275, which gives 0.15203; the Gaussian has 1/16.
  const Spectrum ohno = LedSpectrum({880.0, 80.0, LedShape::kOhno}),
                 gaussian = LedSpectrum({880.0, 80.0});
  EXPECT_NEAR(ohno.Integral(), 1.0, 1e-6);
  for (const double side : {-1.0, 1.0}) {
    EXPECT_NEAR(At(ohno, 880.0 + 40.0 * side) / At(ohno, 880.0), 0.5, 1e-4);
    EXPECT_NEAR(At(ohno, 880.0 + 80.0 * side) / At(ohno, 880.0), 0.15203, 1e-4);
    EXPECT_NEAR(At(gaussian, 880.0 + 80.0 * side) / At(gaussian, 880.0), 0.0625, 1e-4);
  }
}

TEST(Led, DriftsWithTheTemperatureOfItsJunction) {
  // 60 K above 25 C: 0.3 nm/K make 18 nm, -0.5 %/K leave 70 %.
  DiodeRing ring;
  EXPECT_EQ(ring.Led(), (LedType{880.0, 80.0}));
  EXPECT_EQ(ring.Intensity_w_sr(), 0.05);
  ring.junction_temperature_c = 85.0;
  EXPECT_NEAR(ring.Led().peak_nm, 898.0, 1e-9);
  EXPECT_NEAR(ring.Intensity_w_sr(), 0.035, 1e-12);
  ring.junction_temperature_c = 5.0;
  EXPECT_NEAR(ring.Led().peak_nm, 874.0, 1e-9);
}

TEST(AmbientSpectrum, IncandescentIsABlackBodyOf2856K) {
  // Planck's law with c2 = 14,388 um K; the table goes with CIE's older constants, 0.2 % apart at
  // 400 nm. CIE's own table has 14.71 at 400, 198.26 at 700 and 241.68 at 780 nm for 100 at 560.
  const Spectrum table = Spectrum::FromTable(DataPath("materials/data/incandescent.csv"));
  const auto planck = [](double nm) {
    return std::pow(560.0 / nm, 5) * std::expm1(14388e3 / (2856.0 * 560.0)) /
           std::expm1(14388e3 / (2856.0 * nm));
  };
  for (int nm = 400; nm <= 1100; nm += 7)
    EXPECT_NEAR(At(table, nm) / At(table, 560.0) / planck(nm), 1.0, 4e-3) << nm;
  EXPECT_NEAR(At(table, 400.0), 14.71, 0.01);
  EXPECT_NEAR(At(table, 700.0), 198.26, 0.01);
  EXPECT_NEAR(At(table, 780.0), 241.68, 0.01);
}

TEST(AmbientSpectrum, DaylightIsThatOfTheStandard) {
  // Single values of ASTM G173-03 where its spectrum has no strong lines, the mean over 10 nm
  // within 3 %; the bottom of the band of water is below a third, the mean over the narrow one of
  // oxygen below two thirds, of what is beside them.
  const Spectrum table = Spectrum::FromTable(DataPath("materials/data/daylight.csv"));
  const std::pair<double, double> values[] = {{550.0, 1.5399},   {610.0, 1.4686},  {675.0, 1.3958},
                                              {780.0, 1.1636},   {873.0, 0.95721}, {885.0, 0.94423},
                                              {1000.0, 0.73532}, {1050.0, 0.65463}};
  for (const auto& [nm, value] : values) EXPECT_NEAR(At(table, nm) / value, 1.0, 0.03) << nm;
  EXPECT_LT(At(table, 934.5), At(table, 884.5) / 3.0);
  EXPECT_LT(At(table, 764.5), 2.0 / 3.0 * At(table, 784.5));
}

// A filter that passes 0.8 from 840 to 860 nm, with flanks to 830 and 870 nm.
Spectrum Trapezium() {
  return Spectrum::FromPoints({{830.0, 0.0}, {840.0, 0.8}, {860.0, 0.8}, {870.0, 0.0}});
}

TEST(FilterTable, ShiftsAsAWhole) {
  DichroicFilter filter;
  filter.optical_density = 3.0;
  filter.effective_index = 2.0;
  filter.UseTable("trapezium", Trapezium());
  EXPECT_NEAR(filter.centre_nm, 850.0, 0.1);
  EXPECT_NEAR(filter.bandwidth_nm, 30.0, 0.2);
  EXPECT_NEAR(filter.peak_transmission, 0.8, 1e-6);
  EXPECT_NEAR(filter.Transmission(835.0, 0.0), 0.4, 1e-5);
  EXPECT_NEAR(filter.Transmission(600.0, 0.0), 1e-3, 1e-9);
  // At sin = 0.5 every wavelength is that of normal incidence times sqrt(1 - 0.25^2) = 0.968246.
  EXPECT_NEAR(filter.CentreAt(0.5) / filter.centre_nm, 0.968246, 1e-6);
  for (const double nm : {832.0, 837.0, 850.0, 866.0}) {
    EXPECT_NEAR(filter.Transmission(0.968246 * nm, 0.5), filter.Transmission(nm, 0.0), 1e-4) << nm;
  }
}

TEST(FilterTable, ComesFromAFile) {
  WriteTextFile(OwnFolder() / "filter.csv",
                "wavelength_nm,transmission\n830,0\n840,0.8\n860,0.8\n870,0\n");
  WriteTextFile(OwnFolder() / "amplifier.csv", "wavelength_nm,transmission\n830,0\n840,1.8\n");
  ASSERT_EQ(setenv("RETROLUX_DATA", OwnFolder().c_str(), 1), 0);
  const auto read = [](const std::string& text) {
    return ReadFilter(JsonReader::FromText(text, "f.json"));
  };
  const DichroicFilter filter = read(R"({"table": "filter.csv", "effective_index": 2.0})");
  DichroicFilter expected;
  expected.effective_index = 2.0;
  expected.UseTable("filter.csv", Trapezium());
  for (const double nm : {500.0, 833.3, 850.0, 868.0})
    EXPECT_EQ(filter.Transmission(nm, 0.1), expected.Transmission(nm, 0.1));
  EXPECT_EQ(ToJson(filter),
            (nlohmann::json{
                {"table", "filter.csv"}, {"effective_index", 2.0}, {"optical_density", 4.0}}));
  EXPECT_EQ(ToJson(read(ToJson(filter).dump())), ToJson(filter));
  const auto error = [&](const std::string& text) { return MessageOf([&] { read(text); }); };
  EXPECT_EQ(error(R"({"table": "filter.csv", "centre_nm": 850})"),
            "f.json: /: found both table and centre_nm; expected one of them");
  EXPECT_EQ(
      error(R"({"table": "none.csv"})"),
      "f.json: /table: found no table \"none.csv\"; expected a table of the data folder, such "
      "as materials/data/fluorescent.csv");
  EXPECT_NE(error(R"({"table": "amplifier.csv"})").find("each a number from 0 to 1"),
            std::string::npos);
  unsetenv("RETROLUX_DATA");
}

}  // namespace
}  // namespace retrolux
