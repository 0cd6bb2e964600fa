#include "classifier/edge_bands.h"

#include <algorithm>

namespace retrolux {

namespace {

struct Pixel {
  int x, y;
};

constexpr int kSteep = -1;  // steep, not labelled yet

void MarkSteep(const GradientField& field, double min_slope_sigma, Plane<int>& labels) {
  const FloatPlane& slope = field.slope;
  if (labels.width != slope.width || labels.height != slope.height) {
    labels = Plane<int>(slope.width, slope.height);
  }
  const float factor = static_cast<float>(min_slope_sigma) * kSlopeNoise;
  for (int y = 0; y < slope.height; ++y) {
    for (int x0 = 0; x0 < slope.width; x0 += NoiseMap::kTile) {
      const float limit = factor * field.noise.At(x0, y);
      const size_t end = slope.Index(std::min(x0 + NoiseMap::kTile, slope.width), y);
      for (size_t i = slope.Index(x0, y); i < end; ++i) {
        labels.data[i] = slope.data[i] > limit ? kSteep : 0;
      }
    }
  }
}

// Labels the steep pixels connected with `first`; `pixels` becomes their list.
void Flood(Plane<int>& labels, int label, const Pixel& first, std::vector<Pixel>& pixels) {
  pixels.assign(1, first);
  labels(first.x, first.y) = label;
  for (size_t next = 0; next < pixels.size(); ++next) {
    const Pixel p = pixels[next];
    for (int y = std::max(p.y - 1, 0); y <= std::min(p.y + 1, labels.height - 1); ++y) {
      for (int x = std::max(p.x - 1, 0); x <= std::min(p.x + 1, labels.width - 1); ++x) {
        if (labels(x, y) != kSteep) continue;
        labels(x, y) = label;
        pixels.push_back({x, y});
      }
    }
  }
}

PixelBox BoxAround(const std::vector<Pixel>& pixels) {
  PixelBox box{pixels.front().x, pixels.front().y, 0, 0};
  for (const Pixel& p : pixels) {
    box.x0 = std::min(box.x0, p.x);
    box.y0 = std::min(box.y0, p.y);
    box.x1 = std::max(box.x1, p.x + 1);
    box.y1 = std::max(box.y1, p.y + 1);
  }
  return box;
}

// Weighted by slope. On the way round a closed outline the ramps of opposite edges cancel (the
// integral of the normal vanishes), so that the fitted plane leans with the brightness and not with
// the ramps.
LevelPlane SteepestLevel(const GradientField& field, const std::vector<Pixel>& pixels,
                         const PixelBox& box) {
  LevelFit fit({0.5 * (box.x0 + box.x1 - 1), 0.5 * (box.y0 + box.y1 - 1)});
  for (const Pixel& p : pixels) {
    fit.Add(Vec2d(p.x, p.y), static_cast<double>(field.smooth(p.x, p.y)),
            static_cast<double>(field.slope(p.x, p.y)));
  }
  return fit.Solve();
}

}  // namespace

void FindEdgeBands(const GradientField& field, double min_slope_sigma, EdgeBands& found) {
  MarkSteep(field, min_slope_sigma, found.labels);
  found.bands.clear();
  std::vector<Pixel> pixels;
  const std::vector<int>& labels = found.labels.data;
  for (auto next = std::find(labels.begin(), labels.end(), kSteep); next != labels.end();
       next = std::find(next, labels.end(), kSteep)) {
    const auto index = static_cast<int>(next - labels.begin());
    EdgeBand band;
    band.label = static_cast<int>(found.bands.size()) + 1;
    Flood(found.labels, band.label, {index % found.labels.width, index / found.labels.width},
          pixels);
    band.box = BoxAround(pixels);
    band.level = SteepestLevel(field, pixels, band.box);
    found.bands.push_back(band);
  }
}

void LevelFit::Add(const Vec2d& px, double value, double weight) {
  const Vec3d row(1.0, px.x() - origin_px_.x(), px.y() - origin_px_.y());
  normal_ += weight * row * row.transpose();
  right_ += weight * value * row;
}

LevelPlane LevelFit::Solve() const {
  const Eigen::FullPivLU<Mat3d> solver(normal_);
  if (solver.rcond() > 1e-9) {
    const Vec3d plane = solver.solve(right_);
    return {origin_px_, plane.x(), plane.tail<2>()};
  }
  return {origin_px_, normal_(0, 0) > 0.0 ? right_.x() / normal_(0, 0) : 0.0, Vec2d::Zero()};
}

}  // namespace retrolux
