#include "analysis/sparse_film.h"

#include <algorithm>
#include <cmath>

#include "analysis/signal_noise.h"
#include "analysis/sparse_needs.h"
#include "core/parallel.h"

namespace retrolux {

namespace {

// Corners of a cell may differ by so many sigma of the sensor's noise and the paths' scatter.
constexpr double kTolerance_sigma = 3.0;
// Not quartered further.
constexpr int kLeastCell_px = 2;

struct Cell {
  int x0, y0, x1, y1;  // corners, inclusive
};

class Painter {
 public:
  Painter(const PathTracer& tracer, const CameraSpec& camera, const IdBuffers& ids,
          double exposure_s, const SparseSamples& samples, Plane<Need> needs,
          std::vector<std::string> groups)
      : tracer_(tracer),
        camera_(camera),
        ids_(ids),
        exposure_s_(exposure_s),
        samples_(samples),
        needs_(std::move(needs)),
        traced_(needs_.width, needs_.height, 0),
        interpolated_(traced_),
        result_{Film(needs_.width, needs_.height, std::move(groups)), 0, 0} {}

  SparseFilm Paint() {
    std::vector<size_t> pixels;
    for (size_t i = 0; i < needs_.data.size(); ++i) {
      if (needs_.data[i] != Need::kGrid) pixels.push_back(i);
    }
    Trace(std::move(pixels));
    std::vector<Cell> cells = AllCells();
    TraceCorners(cells);
    Calm([](int x, int y) { return IsNode(x, y); }, PairsWithin(1, kSparseCell_px));
    while (!cells.empty()) {
      TraceCorners(cells);
      std::vector<Cell> smaller;
      for (const Cell& cell : cells) {
        if (IsSmooth(cell)) {
          Interpolate(cell);
        } else if (cell.x1 - cell.x0 > kLeastCell_px || cell.y1 - cell.y0 > kLeastCell_px) {
          Quarter(cell, smaller);
        }
      }
      cells = std::move(smaller);
    }
    FillGaps();
    Calm([&](int x, int y) { return traced_(x, y) != 0 && !IsNode(x, y); }, PairsWithin(3, 1));
    return std::move(result_);
  }

 private:
  int SamplesOf(int x, int y) const {
    const Need need = needs_(x, y);
    if (need == Need::kMarker) return samples_.marker;
    return need == Need::kGrid && IsNode(x, y) ? samples_.node : samples_.pixel;
  }

  void Trace(std::vector<size_t> pixels) {
    std::erase_if(pixels, [&](size_t i) { return traced_.data[i]++ != 0; });
    const auto width = static_cast<size_t>(needs_.width);
    for (const size_t i : pixels)
      result_.paths += SamplesOf(static_cast<int>(i % width), static_cast<int>(i / width));
    result_.traced_pixels += static_cast<int64_t>(pixels.size());
    ParallelFor(static_cast<int64_t>(pixels.size()), [&](int64_t k) {
      const size_t i = pixels[static_cast<size_t>(k)];
      const int x = static_cast<int>(i % width), y = static_cast<int>(i / width);
      result_.film.Set(x, y, tracer_.EstimatePixel(x, y, SamplesOf(x, y)));
    });
  }

  void TraceCorners(const std::vector<Cell>& cells) {
    std::vector<size_t> corners;
    for (const Cell& c : cells) {
      for (const int y : {c.y0, c.y1}) {
        for (const int x : {c.x0, c.x1}) {
          if (traced_(x, y) == 0) corners.push_back(traced_.Index(x, y));
        }
      }
    }
    Trace(std::move(corners));
  }

  std::vector<Cell> AllCells() const {
    std::vector<Cell> cells;
    const int right = needs_.width - 1, bottom = needs_.height - 1;
    for (int y = 0; y < bottom; y += kSparseCell_px) {
      for (int x = 0; x < right; x += kSparseCell_px) {
        cells.push_back(
            {x, y, std::min(x + kSparseCell_px, right), std::min(y + kSparseCell_px, bottom)});
      }
    }
    return cells;
  }

  static bool IsNode(int x, int y) { return x % kSparseCell_px == 0 && y % kSparseCell_px == 0; }

  // One of each pair of opposite displacements by up to `reach` steps of `step` px.
  static std::vector<Eigen::Vector2i> PairsWithin(int reach, int step) {
    std::vector<Eigen::Vector2i> pairs;
    for (int dy = 0; dy <= reach; ++dy) {
      for (int dx = dy == 0 ? 1 : -reach; dx <= reach; ++dx)
        pairs.emplace_back(step * dx, step * dy);
    }
    return pairs;
  }

  // Gives each pixel of the grid that `chosen` names the mean of itself and of those around it that
  // differ by no more than the paths' scatter, in opposite pairs, so that a slope stays as it is.
  template <typename Chosen>
  void Calm(Chosen chosen, const std::vector<Eigen::Vector2i>& pairs) {
    const Film noisy = result_.film;
    Film& film = result_.film;
    for (int y = 0; y < needs_.height; ++y) {
      for (int x = 0; x < needs_.width; ++x) {
        if (needs_(x, y) != Need::kGrid || !chosen(x, y)) continue;
        const std::vector<size_t> alike = Alike(noisy, x, y, pairs);
        const auto mean = [&](const FloatPlane& plane) {
          float sum = 0.0f;
          for (const size_t i : alike) sum += plane.data[i];
          return sum / static_cast<float>(alike.size());
        };
        film.electrons(x, y) = mean(noisy.electrons);
        film.radiance(x, y) = mean(noisy.radiance);
        film.variance(x, y) = mean(noisy.variance) / static_cast<float>(alike.size());
        for (size_t g = 0; g < film.group_electrons.size(); ++g)
          film.group_electrons[g](x, y) = mean(noisy.group_electrons[g]);
      }
    }
  }

  // The pixel itself and pairs around it.
  std::vector<size_t> Alike(const Film& noisy, int x, int y,
                            const std::vector<Eigen::Vector2i>& pairs) const {
    const size_t here = traced_.Index(x, y);
    const auto is_alike = [&](int u, int v) {
      if (!needs_.Contains(u, v) || needs_(u, v) != Need::kGrid) return false;
      const size_t i = traced_.Index(u, v);
      const float difference = noisy.electrons.data[i] - noisy.electrons.data[here];
      const float variance = noisy.variance.data[i] + noisy.variance.data[here];
      return ids_.object.data[i] == ids_.object.data[here] &&
             static_cast<double>(std::abs(difference)) <=
                 kTolerance_sigma * std::sqrt(static_cast<double>(variance));
    };
    std::vector<size_t> alike = {here};
    for (const Eigen::Vector2i& d : pairs) {
      if (!is_alike(x + d.x(), y + d.y()) || !is_alike(x - d.x(), y - d.y())) continue;
      alike.push_back(traced_.Index(x + d.x(), y + d.y()));
      alike.push_back(traced_.Index(x - d.x(), y - d.y()));
    }
    return alike;
  }

  bool IsSmooth(const Cell& c) const {
    const uint32_t object = ids_.object(c.x0, c.y0);
    for (int y = c.y0; y <= c.y1; ++y) {
      for (int x = c.x0; x <= c.x1; ++x) {
        if (needs_(x, y) != Need::kGrid || ids_.object(x, y) != object) return false;
      }
    }
    const FloatPlane& e = result_.film.electrons;
    const auto [lo, hi] = std::minmax({e(c.x0, c.y0), e(c.x1, c.y0), e(c.x0, c.y1), e(c.x1, c.y1)});
    const FloatPlane& v = result_.film.variance;
    const float scatter = std::max({v(c.x0, c.y0), v(c.x1, c.y0), v(c.x0, c.y1), v(c.x1, c.y1)});
    const double noise =
        NoiseSigma_e(camera_.sensor, exposure_s_, 0.5 * static_cast<double>(lo + hi));
    return static_cast<double>(hi - lo) <=
           kTolerance_sigma * std::hypot(noise, std::sqrt(static_cast<double>(scatter)));
  }

  static void Quarter(const Cell& c, std::vector<Cell>& cells) {
    const int x = (c.x0 + c.x1) / 2, y = (c.y0 + c.y1) / 2;
    // A side of one pixel is not divided.
    const bool wide = c.x1 - c.x0 > 1, high = c.y1 - c.y0 > 1;
    const int left = wide ? x : c.x1, top = high ? y : c.y1;
    cells.push_back({c.x0, c.y0, left, top});
    if (wide) cells.push_back({x, c.y0, c.x1, top});
    if (high) cells.push_back({c.x0, y, left, c.y1});
    if (wide && high) cells.push_back({x, y, c.x1, c.y1});
  }

  // What lies between the corners of the least cells: the mean of the grid's pixels beside it that
  // show the same object. It is no edge, so they are alike; without any, it is traced.
  void FillGaps() {
    std::vector<size_t> alone;
    for (int y = 0; y < needs_.height; ++y) {
      for (int x = 0; x < needs_.width; ++x) {
        if (traced_(x, y) == 0 && interpolated_(x, y) == 0 && !TakeMeanAround(x, y))
          alone.push_back(traced_.Index(x, y));
      }
    }
    Trace(std::move(alone));
  }

  bool TakeMeanAround(int x, int y) {
    std::vector<size_t> alike;
    for (int v = y - 1; v <= y + 1; ++v) {
      for (int u = x - 1; u <= x + 1; ++u) {
        if (traced_.Contains(u, v) && traced_(u, v) != 0 && needs_(u, v) == Need::kGrid &&
            ids_.object(u, v) == ids_.object(x, y))
          alike.push_back(traced_.Index(u, v));
      }
    }
    if (alike.empty()) return false;
    for (FloatPlane* plane : Planes()) {
      float sum = 0.0f;
      for (const size_t i : alike) sum += plane->data[i];
      (*plane)(x, y) = sum / static_cast<float>(alike.size());
    }
    return true;
  }

  std::vector<FloatPlane*> Planes() {
    Film& film = result_.film;
    std::vector<FloatPlane*> planes = {&film.electrons, &film.variance, &film.radiance};
    for (FloatPlane& plane : film.group_electrons) planes.push_back(&plane);
    return planes;
  }

  void Interpolate(const Cell& c) {
    for (FloatPlane* plane : Planes()) Interpolate(c, *plane);
    for (int y = c.y0; y <= c.y1; ++y) {
      for (int x = c.x0; x <= c.x1; ++x) interpolated_(x, y) = 1;
    }
  }

  void Interpolate(const Cell& c, FloatPlane& plane) const {
    const float a = plane(c.x0, c.y0), b = plane(c.x1, c.y0);
    const float d = plane(c.x0, c.y1), e = plane(c.x1, c.y1);
    for (int y = c.y0; y <= c.y1; ++y) {
      const float v = static_cast<float>(y - c.y0) / static_cast<float>(std::max(c.y1 - c.y0, 1));
      for (int x = c.x0; x <= c.x1; ++x) {
        if (traced_(x, y) != 0) continue;
        const float u = static_cast<float>(x - c.x0) / static_cast<float>(std::max(c.x1 - c.x0, 1));
        plane(x, y) = (1.0f - v) * ((1.0f - u) * a + u * b) + v * ((1.0f - u) * d + u * e);
      }
    }
  }

  const PathTracer& tracer_;
  const CameraSpec& camera_;
  const IdBuffers& ids_;
  double exposure_s_;
  SparseSamples samples_;
  Plane<Need> needs_;
  Plane<uint8_t> traced_, interpolated_;
  SparseFilm result_;
};

}  // namespace

SparseFilm RenderSparseFilm(const PathTracer& tracer, const Scene& scene, const CameraSpec& camera,
                            const IdBuffers& ids, double exposure_s, const SparseSamples& samples,
                            std::vector<std::string> group_names) {
  return Painter(tracer, camera, ids, exposure_s, samples, NeedsOf(scene, camera, ids),
                 std::move(group_names))
      .Paint();
}

}  // namespace retrolux
