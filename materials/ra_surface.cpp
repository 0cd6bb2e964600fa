#include "materials/ra_surface.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace retrolux {

namespace {

double ChordOf(double deg) {
  return 2.0 * std::sin(0.5 * RadFromDeg(deg));
}

// ln f of a table's point, with what else the sheet reflects taken off.
double LnF(const RaTable& table, size_t i, size_t j, const RaSurface::Rest& rest) {
  const CoplanarDirections at = CoplanarAt(table.observation_deg[i], table.entrance_deg[j]);
  const double cosines = at.to_light.z() * at.to_observer.z();
  const double elsewhere = cosines * rest(at.to_observer.cast<float>(), at.to_light.cast<float>());
  if (table.ra[i][j] <= elsewhere) {
    throw InputError(fmt::format(
        "R_A {} cd/(lx m2) at {} / {} degrees; expected more than the {:.3g} that cover and body "
        "reflect there",
        table.ra[i][j], table.observation_deg[i], table.entrance_deg[j], elsewhere));
  }
  return std::log((table.ra[i][j] - elsewhere) / cosines);
}

}  // namespace

RaSurface::RaSurface(const RaTable& table, const Rest& rest)
    : core2_(static_cast<float>(std::pow(1.5 * ChordOf(table.observation_deg.front()), 2))) {
  for (size_t i = 0; i < table.observation_deg.size(); ++i) {
    Row& row = rows_.emplace_back();
    row.t = static_cast<float>(
        std::log(std::pow(ChordOf(table.observation_deg[i]), 2) + static_cast<double>(core2_)));
    for (size_t j = 0; j < table.entrance_deg.size(); ++j) {
      const CoplanarDirections at = CoplanarAt(table.observation_deg[i], table.entrance_deg[j]);
      row.x.push_back(
          X(static_cast<float>(at.to_observer.z()), static_cast<float>(at.to_light.z())));
      row.ln_f.push_back(static_cast<float>(LnF(table, i, j, rest)));
      if (j > 0 && row.x[j] <= row.x[j - 1]) {
        throw InputError(fmt::format(
            "entrance angles {} and {} degrees at {} degrees; expected entrance angles that are "
            "further apart than the observation angle",
            table.entrance_deg[j - 1], table.entrance_deg[j], table.observation_deg[i]));
      }
    }
    const size_t last = row.x.size() - 1;
    if (last > 0) {
      last_slope_ += (row.ln_f[last] - row.ln_f[last - 1]) / (row.x[last] - row.x[last - 1]) /
                     static_cast<float>(table.observation_deg.size());
    }
  }
  last_slope_ = std::min(last_slope_, 0.0f);
}

float RaSurface::LnFInRow(const Row& row, float x) const {
  if (x <= row.x.front()) return row.ln_f.front();
  if (x >= row.x.back()) return row.ln_f.back() + last_slope_ * (x - row.x.back());
  size_t i = 0;
  while (x > row.x[i + 1]) ++i;
  const float share = (x - row.x[i]) / (row.x[i + 1] - row.x[i]);
  return row.ln_f[i] + share * (row.ln_f[i + 1] - row.ln_f[i]);
}

float RaSurface::At(float t, float x) const {
  size_t i = 0;
  while (i + 2 < rows_.size() && t > rows_[i + 1].t) ++i;
  const float a = LnFInRow(rows_[i], x), b = LnFInRow(rows_[i + 1], x);
  const float share = (t - rows_[i].t) / (rows_[i + 1].t - rows_[i].t);
  return std::exp(a + share * (b - a));
}

namespace {

class LeftOut {
 public:
  // Of one value, with its neighbours'.
  void Add(double ln_found, double before, double value, double after) {
    const double error = ln_found - std::log(value), range = 0.5 * std::log(after / before);
    error2_ += error * error;
    range2_ += range * range;
    largest_ = std::max(largest_, std::abs(error));
    ++count_;
  }
  LeaveOneOut Result() const {
    if (count_ == 0) return {};
    return {std::sqrt(error2_ / count_), largest_, std::sqrt(range2_ / count_)};
  }

 private:
  double error2_ = 0.0, range2_ = 0.0, largest_ = 0.0;
  int count_ = 0;
};

// ln R_A at a point of the table, from the interpolation of another.
double LnRaAt(const RaSurface& surface, const RaTable& table, size_t i, size_t j) {
  const CoplanarDirections at = CoplanarAt(table.observation_deg[i], table.entrance_deg[j]);
  const Vec3f wo = at.to_observer.cast<float>(), wi = at.to_light.cast<float>();
  const float f = surface.At(surface.T(wo, wi), RaSurface::X(wo.z(), wi.z()));
  return std::log(static_cast<double>(f * wo.z() * wi.z()));
}

RaSurface Whole(const RaTable& table) {
  return {table, [](const Vec3f&, const Vec3f&) { return 0.0; }};
}

}  // namespace

LeaveOneOut LeaveOneOutObservation(const RaTable& table) {
  LeftOut sum;
  for (size_t i = 1; i + 1 < table.observation_deg.size(); ++i) {
    RaTable rest = table;
    rest.observation_deg.erase(rest.observation_deg.begin() + static_cast<ptrdiff_t>(i));
    rest.ra.erase(rest.ra.begin() + static_cast<ptrdiff_t>(i));
    const RaSurface surface = Whole(rest);
    for (size_t j = 0; j < table.entrance_deg.size(); ++j) {
      sum.Add(LnRaAt(surface, table, i, j), table.ra[i - 1][j], table.ra[i][j], table.ra[i + 1][j]);
    }
  }
  return sum.Result();
}

LeaveOneOut LeaveOneOutEntrance(const RaTable& table) {
  LeftOut sum;
  for (size_t j = 1; j + 1 < table.entrance_deg.size(); ++j) {
    RaTable rest = table;
    rest.entrance_deg.erase(rest.entrance_deg.begin() + static_cast<ptrdiff_t>(j));
    for (std::vector<double>& row : rest.ra) row.erase(row.begin() + static_cast<ptrdiff_t>(j));
    const RaSurface surface = Whole(rest);
    for (size_t i = 0; i < table.observation_deg.size(); ++i) {
      sum.Add(LnRaAt(surface, table, i, j), table.ra[i][j - 1], table.ra[i][j], table.ra[i][j + 1]);
    }
  }
  return sum.Result();
}

}  // namespace retrolux
