// What do the rings of neighbouring cameras do to a camera's picture, over the angle between them,
// in a room as it stands, and in a placement of the vault? docs/hotspots.md gives the answers.
#pragma once

#include <filesystem>

#include "analysis/hotspot_placement.h"

namespace retrolux {

struct HotspotStudyOptions {
  HotspotSetup setup;              // the default that variations change
  std::vector<double> angles_deg;  // separations, ascending
  std::vector<double> variation_angles_deg = {5, 10, 15, 20, 30};  // of the variations
  std::vector<std::string> variations;                             // by name (HotspotVariations)
  int placements = 2;                                              // of the mask at each angle
  HotspotShotOptions shot;
  // A room with an object "mask" and cameras with rings; if it has no markers, six are put on the
  // oval of the CT room. Nothing: no room.
  std::optional<Scene> room;
  std::optional<HotspotPlacementOptions> placement;  // of the vault; nothing: none
};

// The setup, or a variation of it, over the angle.
struct HotspotSeries {
  std::string name, description;
  HotspotSetup setup;
  std::vector<HotspotRow> rows;
  std::vector<std::vector<HotspotPicture>> pictures;  // by row, of the first placement
};

struct HotspotStudy {
  HotspotStudyOptions options;
  std::vector<HotspotMix> mixes;
  std::vector<HotspotSeries> series;  // the first: without variation
  std::vector<HotspotRoomView> room;
  std::optional<HotspotPlacement> placement;
  TaskReport tasks;

  const HotspotMix& Mix(const std::string& name) const;
};

// Renders into `folder`/tasks and `folder`/pictures; an interrupted study goes on. InputError for
// options out of range and rooms that it cannot use, before the first ray.
HotspotStudy RunHotspotStudy(const HotspotStudyOptions& options,
                             const std::filesystem::path& folder, Progress& progress);

// hotspot.csv, variations.csv, rings.csv, room.csv, verdict.csv, placement.csv,
// placement_pairs.csv, summary.json (docs/file-formats.md); of tables those that there are rows
// for.
nlohmann::json HotspotSummary(const HotspotStudy& study);
void WriteHotspotStudyFiles(const HotspotStudy& study, const std::filesystem::path& folder);
void WriteHotspotStudyReport(const HotspotStudy& study, const std::filesystem::path& folder,
                             const std::string& command_line);

}  // namespace retrolux
