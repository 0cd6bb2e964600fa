#include <algorithm>
#include <cmath>

#include "analysis/marker_study_sections.h"
#include "analysis/room_figure.h"
#include "core/error.h"

namespace retrolux {

namespace {

constexpr const char* kMask = "mask";

// The cell of the grid above which a point of the oval lies, in the oval's frame; nothing on its
// underside, which the study leaves out. The mirrored half counts the same cells.
std::optional<GridPosition> CellOf(const Vec3d& p) {
  if (p.x() <= 0.0) return std::nullopt;
  const double step_mm = 2.0 * marker_grid::kHalfLength_mm / marker_grid::kRows;
  const double angle_deg = DegFromRad(std::atan2(std::abs(p.y()), p.x()));
  const auto cell = [](double place, int count) {
    return std::clamp(static_cast<int>(std::floor(place)), 0, count - 1);
  };
  return GridPosition{cell((p.z() + marker_grid::kHalfLength_mm) / step_mm, marker_grid::kRows),
                      cell(angle_deg * marker_grid::kColumns / 90.0, marker_grid::kColumns),
                      p.y() < 0.0};
}

TriangleNumbers Identified(const StudyCoverage& coverage, const TriangleMesh& oval, int marker,
                           int pose, int cameras) {
  TriangleNumbers numbers{"cameras that identify it", cameras, {}};
  for (const auto& t : oval.triangles) {
    const Vec3f middle =
        (oval.positions[t[0]] + oval.positions[t[1]] + oval.positions[t[2]]) / 3.0f;
    const auto cell = CellOf(middle.cast<double>());
    numbers.numbers.push_back(cell ? coverage.CamerasHit(marker, pose, cell->row, cell->col) : 0);
  }
  return numbers;
}

// All poses of a few; of a scan the first, the middle and the last.
std::vector<size_t> ShownPoses(size_t poses) {
  if (poses <= 3) {
    std::vector<size_t> all(poses);
    for (size_t p = 0; p < poses; ++p) all[p] = p;
    return all;
  }
  return {0, poses / 2, poses - 1};
}

}  // namespace

void AddRoom(const MarkerStudy& study, const StudyCoverage& coverage, const Scene& room,
             Report& report) {
  std::vector<RoomScene> states;
  for (const int marker : study.options.markers) {
    for (const size_t pose : ShownPoses(study.poses.size())) {
      RoomScene& state = states.emplace_back();
      state.label = fmt::format("marker {}, {}", marker, study.poses[pose].name);
      state.scene = room.AtPose(study.poses[pose]);
      state.scene.markers.clear();  // the study's own take their place
      state.numbers = Identified(coverage, room.Object(kMask).mesh, marker, static_cast<int>(pose),
                                 static_cast<int>(study.cameras.size()));
    }
  }
  report.Heading("The room");
  report.Room(
      "The cameras with their rings and fields of view, and the mask coloured by how many of them "
      "identify the marker there; two make a position usable. The underside was not studied.",
      DrawRoom("Marker and pose", states, kMask));
}

}  // namespace retrolux
