// The noiseless picture of one camera, all channels.
#pragma once

#include "core/parallel.h"
#include "core/plane.h"
#include "renderer/path_tracer.h"

namespace retrolux {

struct Film {
  std::vector<std::string> group_names;
  FloatPlane electrons;                     // mean signal, e-
  std::vector<FloatPlane> group_electrons;  // by light group; their sum is `electrons`
  FloatPlane variance;                      // of `electrons`, e-^2
  FloatPlane radiance;                      // in band, W/(m2 sr)
  std::array<IdPlane, 3> marker_id;         // ranked by coverage
  std::array<FloatPlane, 3> marker_weight;
  std::array<FloatPlane, 3> marker_electrons;

  Film(int width, int height, std::vector<std::string> groups);
  void Set(int x, int y, const PixelEstimate& estimate);
};

// Every pixel, on all threads, in tiles; `progress` counts pixels.
Film RenderFilm(const PathTracer& tracer, const CameraModel& camera,
                std::vector<std::string> group_names, Progress& progress);

// The same with samples[i] paths for pixel i.
Film RenderFilm(const PathTracer& tracer, const CameraModel& camera, const Plane<int>& samples,
                std::vector<std::string> group_names, Progress& progress);

}  // namespace retrolux
