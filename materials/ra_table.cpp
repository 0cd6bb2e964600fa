#include "materials/ra_table.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/csv.h"
#include "core/error.h"

namespace retrolux {

namespace {

const std::vector<std::string> kColumns = {"observation_deg", "entrance_deg", "ra_cd_lx_m2"};

void CheckRow(const std::filesystem::path& file, size_t number, const std::vector<double>& row) {
  const auto check = [&](size_t column, bool good, std::string_view expected) {
    if (good) return;
    throw InputError::At(file, fmt::format("row {}", number + 1),
                         fmt::format("{} {}", kColumns[column], row[column]), expected);
  };
  check(0, row[0] > 0.0 && row[0] < 90.0, "an angle above 0 and below 90");
  check(1, std::abs(row[1]) < 90.0, "an angle from -90 to 90");
  check(2, row[2] > 0.0, "a coefficient above 0");
}

bool SmallerBySize(double a, double b) {
  return std::abs(a) < std::abs(b);
}

}  // namespace

RaTable RaTable::FromFile(const std::filesystem::path& file) {
  const NumberTable table = ReadNumberTable(file);
  if (table.columns != kColumns) {
    throw InputError::At(file, "header", JoinNames(table.columns), JoinNames(kColumns));
  }
  std::map<std::pair<double, double>, double> values;
  std::set<double> observation;
  std::set<double, decltype(&SmallerBySize)> entrance(&SmallerBySize);
  for (size_t i = 0; i < table.rows.size(); ++i) {
    const std::vector<double>& row = table.rows[i];
    CheckRow(file, i, row);
    observation.insert(row[0]);
    entrance.insert(row[1]);
    if (!values.emplace(std::pair(row[0], row[1]), row[2]).second) {
      throw InputError::At(file, fmt::format("row {}", i + 1),
                           fmt::format("{} / {} degrees again", row[0], row[1]),
                           "each pair of angles once");
    }
  }
  RaTable result;
  result.observation_deg.assign(observation.begin(), observation.end());
  result.entrance_deg.assign(entrance.begin(), entrance.end());
  if (result.observation_deg.size() < 2) {
    throw InputError::At(file, "", "one observation angle", "two or more");
  }
  for (const double alpha : result.observation_deg) {
    std::vector<double>& row = result.ra.emplace_back();
    for (const double beta : result.entrance_deg) {
      const auto value = values.find({alpha, beta});
      if (value == values.end()) {
        throw InputError::At(file, "", fmt::format("no value at {} / {} degrees", alpha, beta),
                             "one for every observation angle at every entrance angle");
      }
      row.push_back(value->second);
    }
  }
  return result;
}

CoplanarDirections CoplanarAt(double observation_deg, double entrance_deg) {
  const auto at = [](double deg) -> Vec3d {
    return {std::sin(RadFromDeg(deg)), 0.0, std::cos(RadFromDeg(deg))};
  };
  return {at(entrance_deg), at(entrance_deg - observation_deg)};
}

}  // namespace retrolux
