#include "analysis/sparse_needs.h"

#include <algorithm>
#include <cmath>

#include "renderer/edge_pixels.h"
#include "renderer/lens.h"

namespace retrolux {

namespace {

// Objects with structure finer than a cell.
std::vector<bool> FineObjects(const Scene& scene) {
  std::vector<bool> fine;
  for (const SceneObject& object : scene.objects) {
    const Material& material = scene.materials.at(object.material);
    fine.push_back(object.perforation || material.texture ||
                   material.spec.value("type", "") == "conductor");
  }
  return fine;
}

int BlurRadius(const CameraSpec& camera, const IdBuffers& ids) {
  const LensRays lens(camera);
  double radius = 0.0;
  if (lens.HasAperture()) {
    for (const float depth : ids.depth.data) {
      if (depth > 0.0f) radius = std::max(radius, lens.BlurRadius_px(static_cast<double>(depth)));
    }
  }
  return static_cast<int>(std::ceil(radius));
}

// The largest need within `radius` columns and rows.
Plane<Need> Dilated(const Plane<Need>& needs, int radius) {
  if (radius == 0) return needs;
  const auto along = [radius](const Plane<Need>& from, bool rows) {
    Plane<Need> to = from;
    for (int y = 0; y < from.height; ++y) {
      for (int x = 0; x < from.width; ++x) {
        for (int d = -radius; d <= radius; ++d) {
          const int u = rows ? x : x + d, v = rows ? y + d : y;
          if (from.Contains(u, v)) to(x, y) = std::max(to(x, y), from(u, v));
        }
      }
    }
    return to;
  };
  return along(along(needs, false), true);
}

bool ShowsMarkerNear(const IdPlane& marker, int x, int y) {
  for (int v = y - 1; v <= y + 1; ++v) {
    for (int u = x - 1; u <= x + 1; ++u) {
      if (marker.Contains(u, v) && marker(u, v) != 0) return true;
    }
  }
  return false;
}

}  // namespace

Plane<Need> NeedsOf(const Scene& scene, const CameraSpec& camera, const IdBuffers& ids) {
  const std::vector<bool> fine = FineObjects(scene);
  const Plane<uint8_t> edges = EdgePixels(ids, camera.model);
  Plane<Need> needs(ids.object.width, ids.object.height, Need::kGrid);
  for (int y = 0; y < needs.height; ++y) {
    for (int x = 0; x < needs.width; ++x) {
      const uint32_t object = ids.object(x, y);
      // Behind the objects come rings and panels: small and bright.
      const bool is_fine = object > 0 && (object > fine.size() || fine[object - 1]);
      const bool is_edge = edges(x, y) != 0;
      if (ids.marker(x, y) != 0 || (is_edge && ShowsMarkerNear(ids.marker, x, y))) {
        needs(x, y) = Need::kMarker;
      } else if (is_fine || is_edge) {
        needs(x, y) = Need::kTraced;
      }
    }
  }
  return Dilated(needs, BlurRadius(camera, ids));
}

}  // namespace retrolux
