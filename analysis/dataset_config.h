// What a set of labelled pictures is drawn from: a file "retrolux/dataset-1" (schema
// scenes/schema/dataset-1.schema.json, examples scenes/data/datasets/). docs/datasets.md says what
// each key means.
//
// To add a nuisance: its range here, its key in dataset_config.cpp and in the schema, and a draw by
// a name of its own where the scene is made (dataset_*.cpp) that goes into `nuisances` too.
#pragma once

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "analysis/dataset_draw.h"

namespace retrolux {

struct MaskChoice {
  double weight = 1.0;
  std::string mesh = "oval";  // oval, face, sphere, or a file beside the config, looking along +x
  std::string unit = "mm";    // of a file other than glTF
};

// Shifts along the world's axes, mm, and turns Rz(z) Ry(-y) Rx(x) of the mask, degrees.
struct PoseRange {
  std::array<Range, 3> translation_mm, rotation_deg;
};

enum class ViewKind { kCtRoom, kVault, kFree };
const char* ViewKindName(ViewKind kind);

// A room with its cameras, or cameras that hang free before the mask.
struct ViewChoice {
  double weight = 1.0;
  ViewKind kind = ViewKind::kFree;
  PoseRange pose;
  int cameras =
      0;  // that record, drawn from the room's; 0: all. Of a free view: how many there are
  // Of free cameras.
  Range distance_mm{1600.0, 1600.0};
  Range incidence_deg{0.0, 60.0};         // between the line of sight and the mask's +x axis
  Range roll_deg{0.0, 360.0};             // of the camera about its axis
  Range field_of_view_deg{12.18, 12.18};  // horizontal, full
  Range aim_mm{0.0, 40.0};                // how far from the mask's middle the camera looks
};

struct MarkerRange {
  WholeRange identifiable{6, 6};  // numbers drawn without repeat as far as the set goes
  WholeRange standard{0, 4};      // round ones among them
  NameChoice polarity{{"bright"}, {1.0}};
  NameChoice material{{"retro_bead"}, {1.0}};
  Range wear;  // share of the sheeting that is worn to a matt grey
  Range roll_deg{0.0, 360.0};
  double clearance_mm = 3.0;        // between the circles around two markers
  double max_incidence_deg = 75.0;  // to the best of the cameras, where a marker is put
  double touching = 0.0;            // probability that two markers touch
  double at_rim = 0.0;              // probability that one is cut by the rim of an open mask
};

struct RecordingRange {
  std::array<int, 2> size_px{0, 0};  // 0: as the cameras are; else the same field of view
  NameChoice sensor{{"default"}, {1.0}};
  Range exposure{0.7, 0.7};          // full scales that a frontal marker of new sheeting reaches
  Range diode_power{1.0, 1.0};       // factor on the diodes, after the exposure was set
  Range ambient{1.0, 1.0};           // factor on the light of the room
  NameChoice rings{{"own"}, {1.0}};  // whose diodes are on: own, all
  double defocused = 0.0;            // probability of a thin lens that is focused too near
  Range blur_px{0.5, 2.0};           // diameter of the disc that a point of the mask then becomes
  Range distortion_k1{0.0, 0.0};
};

struct DistractorRange {
  double glints = 0.0;  // probability of bare metal on the couch
  WholeRange glint_count{1, 4};
  Range glint_size_mm{5.0, 25.0};
  double strip = 0.0;  // of a strip of sheeting on the couch
  Range strip_width_mm{5.0, 20.0}, strip_length_mm{40.0, 120.0};
  double cables = 0.0;  // of cables over the mask
  WholeRange cable_count{1, 2};
  Range cable_radius_mm{1.5, 4.0};
  double second_ring = 0.0;          // of a neighbouring ring-lit camera that is on too
  Range second_ring_deg{3.0, 20.0};  // between the two, seen from the mask
  double plate = 0.0;                // of a plate that hides a part of a marker from a camera
  Range plate_offset_mm{-6.0, 6.0};  // of its edge from the marker's middle; above 0: hides less
};

struct DatasetConfig {
  std::string name, description;
  std::string licence;  // of the pictures
  uint64_t seed = 1;
  int scenes = 0;
  int samples_per_pixel = 8;
  // Shares of the scenes, by name; their sum is 1.
  std::vector<std::string> splits;
  std::vector<double> split_shares;
  std::vector<MaskChoice> masks;
  std::vector<ViewChoice> views;
  MarkerRange markers;
  RecordingRange recording;
  DistractorRange distractors;

  std::filesystem::path file;
  nlohmann::json document;  // as read, without comments
};

// InputError for whatever does not describe a dataset.
DatasetConfig ReadDatasetConfig(const std::filesystem::path& file);

}  // namespace retrolux
