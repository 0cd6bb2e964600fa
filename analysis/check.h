// Physical checks: a number that the program measures, the number that it must be, and where that
// comes from. The tests call them, and so does `retrolux validate`. To add one: a function that
// returns its checks, in the file of its subject, and a row in the table of check.cpp.
#pragma once

#include <string>
#include <vector>

namespace retrolux {

struct Check {
  std::string name;
  double measured = 0.0;
  double expected = 0.0;
  double tolerance =
      0.0;  // absolute, in `unit`; for random results several standard errors, said in `source`
  std::string unit;
  std::string source;  // of the expected value: the closed form or the table
  bool Pass() const;   // false for NaN
};

struct CheckGroup {
  const char* name;
  std::vector<Check> (*run)();
  // What the expected values are made from that the tested code does not share: a check that could
  // only confirm its own input would not count.
  const char* independent_of;
};
const std::vector<CheckGroup>& CheckGroups();

// The checks, by subject.
std::vector<Check> CheckWhiteFurnace();
std::vector<Check> CheckDiodeIrradiance();
std::vector<Check> CheckRingIrradiance();
std::vector<Check> CheckCosFourth();
std::vector<Check> CheckLightGroups();
std::vector<Check> CheckRetroReflection();
std::vector<Check> CheckSheetings();
std::vector<Check> CheckFilter();
std::vector<Check> CheckFilterGain();
std::vector<Check> CheckLedMismatch();
std::vector<Check> CheckExposure();
std::vector<Check> CheckProjection();
std::vector<Check> CheckBlur();
std::vector<Check> CheckCentroids();
std::vector<Check> CheckCalibration();
std::vector<Check> CheckFormFactor();
std::vector<Check> CheckVisibleCaps();
std::vector<Check> CheckPhotonTransfer();

}  // namespace retrolux
