#include "analysis/dataset_statistics.h"

#include <algorithm>

namespace retrolux {

using Json = nlohmann::json;

namespace {

template <typename Visit>
void ForEachMarker(const DatasetIndex& index, Visit visit) {
  for (const DatasetScene& scene : index.scenes) {
    for (const DatasetPicture& picture : scene.pictures) {
      for (const MarkerLabel& label : picture.markers) {
        if (label.visible.Area() > 0) visit(label);
      }
    }
  }
}

void Add(const std::string& name, const Json& value, int pictures,
         std::map<std::string, NuisanceStatistics>& all) {
  if (value.is_array()) {
    const char* axes[] = {" x", " y", " z"};
    for (size_t i = 0; i < value.size(); ++i) Add(name + axes[i], value[i], pictures, all);
    return;
  }
  NuisanceStatistics& statistics = all[name];
  statistics.name = name;
  if (value.is_null()) return;
  if (value.is_number()) {
    const auto number = value.get<double>();
    if (number == 0.0) return;
    statistics.values.insert(statistics.values.end(), static_cast<size_t>(pictures), number);
  } else {
    const bool is_no = value.is_boolean() && !value.get<bool>();
    const std::string text = value.is_boolean() ? (is_no ? "no" : "yes") : value.get<std::string>();
    statistics.counts[text] += pictures;
    if (is_no) return;
  }
  statistics.pictures += pictures;
}

}  // namespace

std::vector<NuisanceStatistics> CountNuisances(const DatasetIndex& index) {
  std::map<std::string, NuisanceStatistics> all;
  for (const DatasetScene& scene : index.scenes) {
    for (const auto& [name, value] : scene.nuisances.items())
      Add(name, value, static_cast<int>(scene.pictures.size()), all);
  }
  std::vector<NuisanceStatistics> list;
  for (auto& [name, statistics] : all) {
    std::sort(statistics.values.begin(), statistics.values.end());
    list.push_back(std::move(statistics));
  }
  return list;
}

std::vector<LabelStatistics> CollectLabels(const DatasetIndex& index) {
  std::vector<LabelStatistics> figures = {{"incidence_deg", {}},
                                          {"distance_mm", {}},
                                          {"size_px", {}},
                                          {"visible_fraction", {}},
                                          {"snr", {}}};
  ForEachMarker(index, [&](const MarkerLabel& label) {
    figures[0].values.push_back(label.incidence_deg);
    figures[1].values.push_back(label.distance_mm);
    figures[2].values.push_back(label.size_px);
    figures[3].values.push_back(label.visible_fraction);
    if (label.snr) figures[4].values.push_back(*label.snr);
  });
  for (LabelStatistics& figure : figures) std::sort(figure.values.begin(), figure.values.end());
  return figures;
}

std::map<std::string, int> CountMarkers(const DatasetIndex& index) {
  std::map<std::string, int> counts;
  ForEachMarker(index, [&](const MarkerLabel& label) {
    const std::string name = label.number == 0 ? "standard" : std::to_string(label.number);
    ++counts[name + (label.dark ? ", dark" : ", bright")];
  });
  return counts;
}

}  // namespace retrolux
