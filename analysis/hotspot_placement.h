// Which pairs of cameras of a vault placement have hot spots, at which rotations of the mask?
//
// Of every rotation a forecast is made (highlight_forecast.h), of the worst ones each camera's
// picture is rendered with its rings kept apart, and every other ring is looked at by itself beside
// the camera's own.
#pragma once

#include "analysis/highlight_forecast.h"
#include "analysis/hotspot_vault.h"
#include "analysis/hotspot_verdict.h"
#include "analysis/hotspot_view.h"
#include "core/task_manifest.h"

namespace retrolux {

struct HotspotPlacementOptions {
  HotspotVault vault;
  int rotations = 8;  // how many are rendered
  // Light that is reflected more than once, too. It is little, and most of a render's scatter.
  bool indirect = false;
};

// What one neighbour's ring does to one picture, e-, each beside the noise of one pixel of what it
// lies on, in the light of the own ring.
struct NeighbourChange {
  RingLight light;
  HotspotChange highlight;                          // peak, on the bare mask
  HotspotChange tail;                               // retro-reflective lobe, on markers
  HotspotChange beam;                               // body of the mask, around markers
  std::map<std::string, HotspotMethodRow> methods;  // own ring and this one, against the own alone
  int64_t pictures = 0;                             // exposures that these are counted over

  bool IsHotSpot() const { return highlight.Changed(); }
  // The largest of the three, in units of its noise, and its name.
  double Sigmas() const;
  const char* Largest() const;
};

// A neighbour's ring in a camera's picture at one rotation of the mask.
struct PlacementTriple {
  size_t camera = 0, ring = 0, rotation = 0;
  double separation_deg = 0.0;  // at the isocentre
  HighlightForecast forecast;
  std::optional<NeighbourChange> change;  // where the picture was rendered
  // "own", "both" (own and this ring) and "neighbours" (this ring): of the brightest hot spot of a
  // picture.
  std::vector<HotspotPicture> pictures;
};

struct HotspotPlacement {
  HotspotPlacementOptions options;
  std::vector<std::string> cameras;
  std::vector<size_t> rendered;  // rotations, ascending
  // Those that were rendered, worst first, then the others by their forecast.
  std::vector<PlacementTriple> triples;
  std::vector<HotspotRoomView> views;  // by camera, over the rendered rotations; without pictures
  HotspotMix all;                      // the views' mix of all rings
  double mask_noise_e = 0.0;           // of a pixel in own light, median over the pictures
  double own_highlight_e = 0.0;        // peak of the own ring's, likewise
  double render_noise = 0.0;           // as HotspotShot has it, the largest
};

// The rotations to render, ascending: of each pair in turn, that with the brightest forecast first,
// its worst one, as long as there are fewer than `most`; then the worst of what is left.
std::vector<size_t> WorstRotations(const std::vector<PlacementTriple>& triples, size_t most);

// Rendered before not rendered; by NeighbourChange::Sigmas, or by the forecast; ties by index.
void SortWorstFirst(std::vector<PlacementTriple>& triples);

// Tasks go into the manifest, pictures into `folder`/pictures.
HotspotPlacement RunHotspotPlacement(const HotspotPlacementOptions& options,
                                     const HotspotSetup& setup, const HotspotShotOptions& shot,
                                     TaskManifest& manifest, const std::filesystem::path& folder,
                                     Progress& progress);

}  // namespace retrolux
