#include "renderer/edge_pixels.h"

#include <algorithm>
#include <cmath>

namespace retrolux {

namespace {

Vec3f At(const std::array<FloatPlane, 3>& planes, size_t i) {
  return {planes[0].data[i], planes[1].data[i], planes[2].data[i]};
}

bool Differ(const IdBuffers& ids, size_t here, size_t there, float width_per_depth) {
  if (ids.object.data[here] != ids.object.data[there]) return true;
  if (ids.object.data[here] == 0) return false;
  if (ids.marker.data[here] != ids.marker.data[there]) return true;
  const Vec3f way = At(ids.position, there) - At(ids.position, here);
  return std::abs(At(ids.normal, here).dot(way)) > width_per_depth * ids.depth.data[here];
}

}  // namespace

Plane<uint8_t> EdgePixels(const IdBuffers& ids, const CameraModel& camera) {
  const int width = ids.object.width, height = ids.object.height;
  const auto width_per_depth = static_cast<float>(1.0 / camera.fx);
  Plane<uint8_t> edges(width, height, 0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const size_t here = edges.Index(x, y);
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v) {
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
          if (Differ(ids, here, edges.Index(u, v), width_per_depth)) edges.data[here] = 1;
        }
      }
    }
  }
  return edges;
}

}  // namespace retrolux
