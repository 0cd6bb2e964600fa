#include "analysis/dataset_config.h"

#include <cmath>
#include <numeric>

#include "materials/material_library.h"
#include "scenes/scene_json_sensor.h"

namespace retrolux {

namespace {

constexpr double kMaxLength_mm = 1e4;

std::array<Range, 3> ReadAxes(JsonReader& json, const std::string& key, double limit) {
  std::array<Range, 3> axes;
  if (!json.Has(key)) return axes;
  JsonReader node = json.Child(key);
  const char* names[] = {"x", "y", "z"};
  for (size_t i = 0; i < 3; ++i) axes[i] = ReadRange(node, names[i], -limit, limit, {});
  node.Finish();
  return axes;
}

double Probability(JsonReader& json, const std::string& key) {
  return json.Number(key, 0.0, 1.0, 0.0);
}

MaskChoice ReadMask(JsonReader json) {
  MaskChoice mask;
  mask.weight = json.Number("weight", 0.0, 1e6, mask.weight);
  mask.mesh = json.PathBelow("mesh");
  if (json.Has("unit")) mask.unit = json.Choice("unit", {"mm", "cm", "m"});
  json.Finish();
  return mask;
}

ViewKind ReadKind(JsonReader& json) {
  const std::string name = json.Choice("kind", {"ct-room", "vault", "free"});
  if (name == "ct-room") return ViewKind::kCtRoom;
  return name == "vault" ? ViewKind::kVault : ViewKind::kFree;
}

ViewChoice ReadView(JsonReader json) {
  ViewChoice view;
  view.kind = ReadKind(json);
  view.weight = json.Number("weight", 0.0, 1e6, view.weight);
  view.pose.translation_mm = ReadAxes(json, "translation_mm", 1000.0);
  view.pose.rotation_deg = ReadAxes(json, "rotation_deg", 360.0);
  const bool is_free = view.kind == ViewKind::kFree;
  view.cameras = json.Integer("cameras", 1, 16, is_free ? 1 : 0);
  if (is_free) {
    view.distance_mm = ReadRange(json, "distance_mm", 200.0, kMaxLength_mm, view.distance_mm);
    view.incidence_deg = ReadRange(json, "incidence_deg", 0.0, 90.0, view.incidence_deg);
    view.roll_deg = ReadRange(json, "roll_deg", -360.0, 360.0, view.roll_deg);
    view.field_of_view_deg =
        ReadRange(json, "field_of_view_deg", 2.0, 90.0, view.field_of_view_deg);
    view.aim_mm = ReadRange(json, "aim_mm", 0.0, 500.0, view.aim_mm);
  }
  json.Finish();
  return view;
}

MarkerRange ReadMarkers(JsonReader json) {
  MarkerRange markers;
  markers.identifiable = ReadWholeRange(json, "identifiable", 0, 24, markers.identifiable);
  markers.standard = ReadWholeRange(json, "standard", 0, 24, markers.standard);
  markers.polarity = ReadNameChoice(json, "polarity", {"bright", "dark", "mixed"}, "bright");
  markers.material = ReadNameChoice(json, "material", LibraryMaterialNames(), "retro_bead");
  markers.wear = ReadRange(json, "wear", 0.0, 1.0, markers.wear);
  markers.roll_deg = ReadRange(json, "roll_deg", -360.0, 360.0, markers.roll_deg);
  markers.clearance_mm = json.Number("clearance_mm", 0.0, 100.0, markers.clearance_mm);
  markers.max_incidence_deg =
      json.Number("max_incidence_deg", 5.0, 90.0, markers.max_incidence_deg);
  markers.touching = Probability(json, "touching");
  markers.at_rim = Probability(json, "at_rim");
  json.Finish();
  return markers;
}

RecordingRange ReadRecording(JsonReader json) {
  RecordingRange recording;
  if (json.Has("size_px")) {
    const std::vector<double> size = json.Child("size_px").Numbers(2);
    for (size_t i = 0; i < 2; ++i) {
      if (size[i] < 8 || size[i] > 1 << 14 || size[i] != std::floor(size[i])) {
        json.Child("size_px").Fail(fmt::format("{}", size[i]), "whole numbers from 8 to 16384");
      }
      recording.size_px[i] = static_cast<int>(size[i]);
    }
  }
  std::vector<std::string> sensors = SensorPresetNames();
  sensors.insert(sensors.begin(), "default");
  recording.sensor = ReadNameChoice(json, "sensor", sensors, "default");
  recording.exposure = ReadRange(json, "exposure", 0.05, 20.0, recording.exposure);
  recording.diode_power = ReadRange(json, "diode_power", 0.01, 100.0, recording.diode_power);
  recording.ambient = ReadRange(json, "ambient", 0.0, 1e4, recording.ambient);
  recording.rings = ReadNameChoice(json, "rings", {"own", "all"}, "own");
  recording.defocused = Probability(json, "defocused");
  recording.blur_px = ReadRange(json, "blur_px", 0.0, 20.0, recording.blur_px);
  recording.distortion_k1 = ReadRange(json, "distortion_k1", -1.0, 1.0, recording.distortion_k1);
  json.Finish();
  return recording;
}

// {"probability": p, ...}: the rest is read by `rest`.
template <typename Rest>
double ReadDistractor(JsonReader& json, const std::string& key, Rest rest) {
  if (!json.Has(key)) return 0.0;
  JsonReader node = json.Child(key);
  const double probability = node.Number("probability", 0.0, 1.0);
  rest(node);
  node.Finish();
  return probability;
}

DistractorRange ReadDistractors(JsonReader json) {
  DistractorRange d;
  d.glints = ReadDistractor(json, "glints", [&](JsonReader& node) {
    d.glint_count = ReadWholeRange(node, "count", 1, 50, d.glint_count);
    d.glint_size_mm = ReadRange(node, "size_mm", 0.5, 200.0, d.glint_size_mm);
  });
  d.strip = ReadDistractor(json, "strip", [&](JsonReader& node) {
    d.strip_width_mm = ReadRange(node, "width_mm", 1.0, 200.0, d.strip_width_mm);
    d.strip_length_mm = ReadRange(node, "length_mm", 1.0, 1000.0, d.strip_length_mm);
  });
  d.cables = ReadDistractor(json, "cables", [&](JsonReader& node) {
    d.cable_count = ReadWholeRange(node, "count", 1, 10, d.cable_count);
    d.cable_radius_mm = ReadRange(node, "radius_mm", 0.5, 30.0, d.cable_radius_mm);
  });
  d.second_ring = ReadDistractor(json, "second_ring", [&](JsonReader& node) {
    d.second_ring_deg = ReadRange(node, "separation_deg", 1.0, 90.0, d.second_ring_deg);
  });
  d.plate = ReadDistractor(json, "plate", [&](JsonReader& node) {
    d.plate_offset_mm = ReadRange(node, "offset_mm", -20.0, 20.0, d.plate_offset_mm);
  });
  json.Finish();
  return d;
}

void ReadSplits(JsonReader& json, DatasetConfig& config) {
  config.splits = {"train", "val", "test"};
  config.split_shares = {1.0, 0.0, 0.0};
  if (!json.Has("splits")) return;
  JsonReader node = json.Child("splits");
  for (size_t i = 0; i < config.splits.size(); ++i)
    config.split_shares[i] = node.Number(config.splits[i], 0.0, 1.0, 0.0);
  node.Finish();
  const double sum = std::accumulate(config.split_shares.begin(), config.split_shares.end(), 0.0);
  if (std::abs(sum - 1.0) > 1e-9)
    node.Fail(fmt::format("a sum of {}", sum), "shares that add up to 1");
}

template <typename Item, typename Read>
std::vector<Item> ReadWeighted(JsonReader& json, const std::string& key, Read read) {
  const JsonReader array = json.Child(key);
  std::vector<Item> items;
  double sum = 0.0;
  for (size_t i = 0; i < array.Size(); ++i) {
    items.push_back(read(array.Child(i)));
    sum += items.back().weight;
  }
  if (!(sum > 0.0)) array.Fail("no entry with a weight above 0", "at least one");
  return items;
}

}  // namespace

const char* ViewKindName(ViewKind kind) {
  switch (kind) {
    case ViewKind::kCtRoom:
      return "ct-room";
    case ViewKind::kVault:
      return "vault";
    case ViewKind::kFree:
      return "free";
  }
  return "";
}

DatasetConfig ReadDatasetConfig(const std::filesystem::path& file) {
  JsonReader json = JsonReader::FromFile(file);
  json.Schema("retrolux/dataset-1");
  DatasetConfig config;
  config.file = file;
  config.document = json.Raw();
  config.name = json.String("name");
  config.description = json.String("description", "");
  config.licence = json.String("licence");
  config.seed = static_cast<uint64_t>(json.Integer("seed", 0, 1 << 30, 1));
  config.scenes = json.Integer("scenes", 1, 1000000);
  config.samples_per_pixel = json.Integer("spp", 1, 1 << 16, config.samples_per_pixel);
  ReadSplits(json, config);
  config.masks = ReadWeighted<MaskChoice>(json, "masks", ReadMask);
  config.views = ReadWeighted<ViewChoice>(json, "views", ReadView);
  if (json.Has("markers")) config.markers = ReadMarkers(json.Child("markers"));
  if (json.Has("recording")) config.recording = ReadRecording(json.Child("recording"));
  if (json.Has("distractors")) config.distractors = ReadDistractors(json.Child("distractors"));
  json.Finish();
  return config;
}

}  // namespace retrolux
