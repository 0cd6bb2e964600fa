#include "materials/entrance_weight.h"

#include <cmath>

#include "core/conventions.h"
#include "core/csv.h"
#include "core/error.h"

namespace retrolux {

namespace {

constexpr int kEntries = 2049;

double Interpolate(const std::vector<std::vector<double>>& points, double beta_deg) {
  if (beta_deg <= points.front()[0]) return points.front()[1];
  size_t i = 1;
  while (i + 1 < points.size() && points[i][0] < beta_deg) ++i;
  const double x0 = points[i - 1][0] * points[i - 1][0];
  const double x1 = points[i][0] * points[i][0];
  const double t = (beta_deg * beta_deg - x0) / (x1 - x0);
  return std::exp((1.0 - t) * std::log(points[i - 1][1]) + t * std::log(points[i][1]));
}

}  // namespace

EntranceWeight::EntranceWeight() : table_(2, 1.0f) {}

EntranceWeight EntranceWeight::FromTable(const std::filesystem::path& file) {
  const NumberTable points = ReadNumberTable(file);
  if (points.columns != std::vector<std::string>{"entrance_deg", "weight"} ||
      points.rows.size() < 2) {
    throw InputError::At(file, "", JoinNames(points.columns),
                         "entrance_deg,weight and two rows or more");
  }
  for (size_t i = 0; i < points.rows.size(); ++i) {
    const bool falls = i == 0 || (points.rows[i][0] > points.rows[i - 1][0] &&
                                  points.rows[i][1] <= points.rows[i - 1][1]);
    if (!falls || points.rows[i][1] <= 0.0) {
      throw InputError::At(file, fmt::format("row {}", i + 1),
                           fmt::format("weight {}", points.rows[i][1]),
                           "ascending angles with positive weights that do not rise");
    }
  }
  EntranceWeight weight;
  weight.table_.resize(kEntries);
  for (int i = 0; i < kEntries; ++i) {
    const double beta_deg = DegFromRad(std::acos(static_cast<double>(i) / (kEntries - 1)));
    weight.table_[static_cast<size_t>(i)] = static_cast<float>(Interpolate(points.rows, beta_deg));
  }
  return weight;
}

}  // namespace retrolux
