#include "classifier/gradient.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace retrolux {

namespace {

float Median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Noise of one tile: the median of |picture * (1 -2 1)^T (1 -2 1)|, which no constant, ramp or
// straight edge along an axis answers to (Immerkaer 1996); 0.6745 is the median of |N(0, 1)|, 6 the
// kernel's norm.
float TileNoise(const FloatPlane& p, int x0, int y0) {
  constexpr int kStep = 4;  // 256 of the 4096 pixels: the median is good to 8 %
  std::vector<float> responses;
  responses.reserve((NoiseMap::kTile / kStep) * (NoiseMap::kTile / kStep));
  const int x1 = std::min(x0 + NoiseMap::kTile, p.width - 1);
  const int y1 = std::min(y0 + NoiseMap::kTile, p.height - 1);
  for (int y = std::max(y0, 1); y < y1; y += kStep) {
    for (int x = std::max(x0, 1); x < x1; x += kStep) {
      const float* row = &p.data[p.Index(x, y)];
      const float* up = row - p.width;
      const float* down = row + p.width;
      responses.push_back(std::abs(up[-1] + up[1] + down[-1] + down[1] + 4.0f * row[0] -
                                   2.0f * (up[0] + down[0] + row[-1] + row[1])));
    }
  }
  return responses.empty() ? 0.0f : Median(responses) / (6.0f * 0.6745f);
}

// Standard deviation of rounding to whole DN, or to 1/255 of the picture's range if that is
// coarser, so that 8-bit data in a 16-bit file count as what they are.
float QuantisationNoise(const Plane<uint16_t>& dn) {
  int low = 65535;
  int high = 0;
  for (const uint16_t v : dn.data) {
    low = std::min<int>(low, v);
    high = std::max<int>(high, v);
  }
  return std::max(1.0f, static_cast<float>(high - low) / 255.0f) / std::sqrt(12.0f);
}

// No tile is quieter than the median tile or than `least`.
NoiseMap MeasureNoise(const FloatPlane& picture, float least) {
  constexpr int kTile = NoiseMap::kTile;
  NoiseMap noise;
  noise.tiles =
      FloatPlane((picture.width + kTile - 1) / kTile, (picture.height + kTile - 1) / kTile);
  for (int j = 0; j < noise.tiles.height; ++j) {
    for (int i = 0; i < noise.tiles.width; ++i) {
      noise.tiles(i, j) = TileNoise(picture, i * kTile, j * kTile);
    }
  }
  std::vector<float> all = noise.tiles.data;
  least = std::max(Median(all), least);
  for (float& sigma : noise.tiles.data) sigma = std::max(sigma, least);
  return noise;
}

// Length of the gradient, a few rows at a time, which stay in the cache.
void MeasureSlope(const cv::Mat& smooth, FloatPlane& slope) {
  constexpr int kRows = 16;
  cv::Mat right, down;
  for (int y0 = 0; y0 < slope.height; y0 += kRows) {
    const cv::Mat rows = smooth.rowRange(y0, std::min(y0 + kRows, slope.height));
    cv::Sobel(rows, right, CV_32F, 1, 0, 3, 1.0 / 8.0);  // sees the rows above and below, too
    cv::Sobel(rows, down, CV_32F, 0, 1, 3, 1.0 / 8.0);
    const float* gx = right.ptr<float>();
    const float* gy = down.ptr<float>();
    float* out = &slope.data[slope.Index(0, y0)];
    const size_t count = rows.total();
    for (size_t i = 0; i < count; ++i) out[i] = std::sqrt(gx[i] * gx[i] + gy[i] * gy[i]);
  }
}

void Resize(FloatPlane& plane, int width, int height) {
  if (plane.width != width || plane.height != height) plane = FloatPlane(width, height);
}

}  // namespace

void MeasureGradient(const DigitalImage& image, GradientField& field) {
  Resize(field.smooth, image.dn.width, image.dn.height);
  Resize(field.slope, image.dn.width, image.dn.height);
  std::copy(image.dn.data.begin(), image.dn.data.end(), field.smooth.data.begin());
  field.noise = MeasureNoise(field.smooth, QuantisationNoise(image.dn));
  cv::Mat smooth(field.smooth.height, field.smooth.width, CV_32FC1, field.smooth.data.data());
  cv::GaussianBlur(smooth, smooth, cv::Size(3, 3), 0.0);  // sigma 0: exactly (1 2 1)/4
  MeasureSlope(smooth, field.slope);
}

void MeasureRelief(const GradientField& field, FloatPlane& relief) {
  constexpr double kSigma_px = 2.0;
  Resize(relief, field.smooth.width, field.smooth.height);
  FloatPlane smooth = field.smooth;
  const cv::Mat from(smooth.height, smooth.width, CV_32FC1, smooth.data.data());
  cv::Mat to(relief.height, relief.width, CV_32FC1, relief.data.data());
  cv::GaussianBlur(from, to, cv::Size(0, 0), kSigma_px);
  cv::subtract(from, to, to);
}

double SampleBilinear(const FloatPlane& plane, double x, double y) {
  x = std::clamp(x, 0.0, plane.width - 1.0);
  y = std::clamp(y, 0.0, plane.height - 1.0);
  const int x0 = std::min(static_cast<int>(x), std::max(plane.width - 2, 0));
  const int y0 = std::min(static_cast<int>(y), std::max(plane.height - 2, 0));
  const int x1 = std::min(x0 + 1, plane.width - 1);
  const int y1 = std::min(y0 + 1, plane.height - 1);
  const float fx = static_cast<float>(x - x0);
  const float fy = static_cast<float>(y - y0);
  const float value = (1.0f - fy) * ((1.0f - fx) * plane(x0, y0) + fx * plane(x1, y0)) +
                      fy * ((1.0f - fx) * plane(x0, y1) + fx * plane(x1, y1));
  return static_cast<double>(value);
}

}  // namespace retrolux
