#include "renderer/film.h"

#include <algorithm>

namespace retrolux {

Film::Film(int width, int height, std::vector<std::string> groups)
    : group_names(std::move(groups)),
      electrons(width, height),
      group_electrons(group_names.size(), FloatPlane(width, height)),
      variance(width, height),
      radiance(width, height) {
  marker_id.fill(IdPlane(width, height));
  marker_weight.fill(FloatPlane(width, height));
  marker_electrons.fill(FloatPlane(width, height));
}

void Film::Set(int x, int y, const PixelEstimate& estimate) {
  const size_t i = electrons.Index(x, y);
  float sum = 0.0f;
  for (size_t g = 0; g < group_electrons.size(); ++g) {
    group_electrons[g].data[i] = estimate.electrons[static_cast<Eigen::Index>(g)];
    sum += group_electrons[g].data[i];
  }
  electrons.data[i] = sum;
  variance.data[i] = estimate.variance;
  radiance.data[i] = estimate.radiance;
  for (size_t rank = 0; rank < 3; ++rank) {
    marker_id[rank].data[i] = estimate.coverage.instance[rank];
    marker_weight[rank].data[i] = estimate.coverage.weight[rank];
    marker_electrons[rank].data[i] = estimate.coverage.electrons[rank];
  }
}

namespace {

template <typename Estimate>
Film RenderTiles(const CameraModel& camera, std::vector<std::string> group_names,
                 Progress& progress, Estimate estimate) {
  constexpr int kTile = 16;
  Film film(camera.width, camera.height, std::move(group_names));
  const int columns = (camera.width + kTile - 1) / kTile;
  const int rows = (camera.height + kTile - 1) / kTile;
  ParallelFor(static_cast<int64_t>(columns) * rows, [&](int64_t tile) {
    const int x0 = static_cast<int>(tile % columns) * kTile;
    const int y0 = static_cast<int>(tile / columns) * kTile;
    const int x1 = std::min(x0 + kTile, camera.width);
    const int y1 = std::min(y0 + kTile, camera.height);
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) film.Set(x, y, estimate(x, y));
    }
    progress.Advance(static_cast<int64_t>(x1 - x0) * (y1 - y0));
  });
  return film;
}

}  // namespace

Film RenderFilm(const PathTracer& tracer, const CameraModel& camera,
                std::vector<std::string> group_names, Progress& progress) {
  return RenderTiles(camera, std::move(group_names), progress,
                     [&](int x, int y) { return tracer.EstimatePixel(x, y); });
}

Film RenderFilm(const PathTracer& tracer, const CameraModel& camera, const Plane<int>& samples,
                std::vector<std::string> group_names, Progress& progress) {
  return RenderTiles(camera, std::move(group_names), progress,
                     [&](int x, int y) { return tracer.EstimatePixel(x, y, samples(x, y)); });
}

}  // namespace retrolux
