#include "analysis/emva1288.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace retrolux {

namespace {

constexpr double kQuantisation_dn2 = 1.0 / 12.0;
constexpr double kLeastDarkVariance_dn2 = 0.24;

struct Point {
  double x, y;
};

// The line y = offset + slope x of least weighted squares.
struct Line {
  double slope, offset;
};
template <typename Weight>
Line FitLine(const std::vector<Point>& points, Weight weight) {
  double w = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const Point& p : points) {
    const double wi = weight(p);
    w += wi, x += wi * p.x, y += wi * p.y, xx += wi * p.x * p.x, xy += wi * p.x * p.y;
  }
  const double slope = (w * xy - x * y) / (w * xx - x * x);
  return {slope, (y - slope * x) / w};
}

double SlopeThroughZero(const std::vector<Point>& points) {
  double xx = 0.0, xy = 0.0;
  for (const Point& p : points) xx += p.x * p.x, xy += p.x * p.y;
  return xy / xx;
}

// A level of the series, without the dark one.
struct Level {
  double photons, signal_dn, variance_dn2;
};

// Those with a signal from `first` to `last` of that at saturation, as pairs of two of their
// members.
std::vector<Point> Range(const std::vector<Level>& levels, double saturation_dn, double first,
                         double last, double Level::*x, double Level::*y) {
  std::vector<Point> points;
  for (const Level& level : levels) {
    const double share = level.signal_dn / saturation_dn;
    if (share >= first && share <= last) points.push_back({level.*x, level.*y});
  }
  RETROLUX_CHECK(points.size() >= 3, "{} levels from {} to {} of saturation", points.size(), first,
                 last);
  return points;
}

// Largest relative deviation from the line that has the least of it, in per cent.
double LinearityError(const std::vector<Point>& points) {
  const Line line = FitLine(points, [](const Point& p) { return 1.0 / (p.y * p.y); });
  double largest = 0.0;
  for (const Point& p : points)
    largest = std::max(largest, std::abs(p.y / (line.offset + line.slope * p.x) - 1.0));
  return 100.0 * largest;
}

}  // namespace

TemporalStatistics MeasureTemporal(const std::vector<DigitalImage>& pictures) {
  RETROLUX_CHECK(pictures.size() >= 2, "{} pictures", pictures.size());
  double sum = 0.0, difference2 = 0.0;
  for (size_t k = 0; k < pictures.size(); ++k) {
    const std::vector<uint16_t>& dn = pictures[k].dn.data;
    for (const uint16_t value : dn) sum += value;
    if (k == 0) continue;
    for (size_t i = 0; i < dn.size(); ++i) {
      const double d = static_cast<double>(dn[i]) - pictures[k - 1].dn.data[i];
      difference2 += d * d;
    }
  }
  const auto pixels = static_cast<double>(pictures[0].dn.data.size());
  const auto count = static_cast<double>(pictures.size());
  return {sum / (pixels * count), 0.5 * difference2 / (pixels * (count - 1.0))};
}

double SpatialVariance_dn2(const std::vector<DigitalImage>& pictures) {
  const TemporalStatistics temporal = MeasureTemporal(pictures);
  const size_t pixels = pictures[0].dn.data.size();
  const auto count = static_cast<double>(pictures.size());
  double sum2 = 0.0;
  for (size_t i = 0; i < pixels; ++i) {
    double sum = 0.0;
    for (const DigitalImage& picture : pictures) sum += picture.dn.data[i];
    sum2 += std::pow(sum / count - temporal.mean_dn, 2);
  }
  return sum2 / static_cast<double>(pixels - 1) - temporal.variance_dn2 / count;
}

Emva1288 MeasureEmva1288(const std::vector<EvenPictures>& series) {
  const TemporalStatistics dark = MeasureTemporal(series.at(0).pictures);
  std::vector<Level> levels;
  for (size_t i = 1; i < series.size(); ++i) {
    const TemporalStatistics light = MeasureTemporal(series[i].pictures);
    levels.push_back({series[i].photons, light.mean_dn - dark.mean_dn, light.variance_dn2});
  }
  const Level saturated = *std::max_element(
      levels.begin(), levels.end(),
      [](const Level& a, const Level& b) { return a.variance_dn2 < b.variance_dn2; });

  Emva1288 result;
  const bool dark_is_clear = dark.variance_dn2 >= kLeastDarkVariance_dn2;
  const double first = dark_is_clear ? 0.0 : 0.1;
  std::vector<Point> transfer =
      Range(levels, saturated.signal_dn, first, 0.7, &Level::signal_dn, &Level::variance_dn2);
  if (dark_is_clear) {
    for (Point& p : transfer) p.y -= dark.variance_dn2;
    result.gain_dn_e = SlopeThroughZero(transfer);
    result.temporal_dark_noise_e =
        std::sqrt(dark.variance_dn2 - kQuantisation_dn2) / result.gain_dn_e;
  } else {
    result.gain_dn_e = FitLine(transfer, [](const Point&) { return 1.0; }).slope;
  }
  result.responsivity_dn = SlopeThroughZero(
      Range(levels, saturated.signal_dn, first, 0.7, &Level::photons, &Level::signal_dn));
  result.quantum_efficiency = result.responsivity_dn / result.gain_dn_e;
  result.saturation_photons = saturated.photons;
  result.saturation_e = result.quantum_efficiency * saturated.photons;
  const double dark_sigma_dn =
      std::sqrt(dark_is_clear ? dark.variance_dn2 : kLeastDarkVariance_dn2);
  result.sensitivity_threshold_e = dark_sigma_dn / result.gain_dn_e + 0.5;
  result.snr_max = std::sqrt(result.saturation_e);
  result.dynamic_range = result.saturation_e / result.sensitivity_threshold_e;
  result.linearity_error_percent = LinearityError(
      Range(levels, saturated.signal_dn, 0.05, 0.95, &Level::photons, &Level::signal_dn));
  return result;
}

NonUniformity MeasureNonUniformity(const std::vector<DigitalImage>& dark,
                                   const std::vector<DigitalImage>& half, double gain_dn_e) {
  const double dark_dn2 = SpatialVariance_dn2(dark);
  const double signal_dn = MeasureTemporal(half).mean_dn - MeasureTemporal(dark).mean_dn;
  return {std::sqrt(std::max(0.0, dark_dn2)) / gain_dn_e,
          std::sqrt(std::max(0.0, SpatialVariance_dn2(half) - dark_dn2)) / signal_dn};
}

}  // namespace retrolux
