#include "analysis/dataset_csv.h"

#include <set>

#include "core/csv.h"

namespace retrolux {

using Json = nlohmann::json;

namespace {

std::string Cell(const Json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "1" : "0";
  return value.dump();
}

std::string Cell(const std::optional<double>& value) {
  return value ? fmt::format("{}", *value) : "";
}

void AddPoint(const std::optional<Vec2d>& px, std::vector<std::string>& cells) {
  cells.push_back(px ? fmt::format("{}", px->x()) : "");
  cells.push_back(px ? fmt::format("{}", px->y()) : "");
}

// Names of the nuisances that are one value each.
std::vector<std::string> NuisanceNames(const DatasetIndex& index) {
  std::set<std::string> names;
  for (const DatasetScene& scene : index.scenes) {
    for (const auto& [name, value] : scene.nuisances.items()) {
      if (!value.is_array()) names.insert(name);
    }
  }
  return {names.begin(), names.end()};
}

std::vector<std::string> LabelCells(const DatasetScene& scene, const DatasetPicture& picture,
                                    const MarkerLabel& label) {
  std::vector<std::string> cells = {scene.name,
                                    scene.split,
                                    picture.camera,
                                    picture.file,
                                    std::to_string(label.instance),
                                    label.number == 0 ? "standard" : std::to_string(label.number),
                                    label.dark ? "dark" : "bright"};
  AddPoint(label.centroid_projected_px, cells);
  AddPoint(label.centroid_outline_px, cells);
  AddPoint(label.centroid_radiometric_px, cells);
  for (const double value :
       {label.visible_fraction, label.incidence_deg, label.distance_mm, label.size_px})
    cells.push_back(fmt::format("{}", value));
  cells.push_back(Cell(label.signal_e));
  cells.push_back(Cell(label.background_e));
  cells.push_back(Cell(label.snr));
  cells.push_back(std::to_string(label.visible.Area()));
  cells.push_back(std::to_string(label.amodal.Area()));
  cells.emplace_back(label.in_frame ? "1" : "0");
  return cells;
}

}  // namespace

LabelTable::LabelTable(const DatasetIndex& index) : nuisances_(NuisanceNames(index)) {}

std::vector<std::string> LabelTable::Columns() const {
  // Pixel origin as in every table of ours: the centre of the top-left pixel.
  std::vector<std::string> columns = {"scene",
                                      "split",
                                      "camera",
                                      "file",
                                      "instance",
                                      "marker",
                                      "polarity",
                                      "projected_u_px",
                                      "projected_v_px",
                                      "outline_u_px",
                                      "outline_v_px",
                                      "radiometric_u_px",
                                      "radiometric_v_px",
                                      "visible_fraction",
                                      "incidence_deg",
                                      "distance_mm",
                                      "size_px",
                                      "signal_e",
                                      "background_e",
                                      "snr",
                                      "visible_px",
                                      "amodal_px",
                                      "in_frame"};
  for (const std::string& name : nuisances_) columns.push_back("scene." + name);
  return columns;
}

std::vector<std::string> LabelTable::Row(const DatasetScene& scene, const DatasetPicture& picture,
                                         const MarkerLabel& label) const {
  std::vector<std::string> cells = LabelCells(scene, picture, label);
  for (const std::string& name : nuisances_)
    cells.push_back(Cell(scene.nuisances.value(name, Json())));
  return cells;
}

std::filesystem::path ExportCsv(const DatasetIndex& index, const std::filesystem::path& folder) {
  const LabelTable table(index);
  CsvWriter csv(table.Columns());
  for (const DatasetScene& scene : index.scenes) {
    for (const DatasetPicture& picture : scene.pictures) {
      for (const MarkerLabel& label : picture.markers) csv.Row(table.Row(scene, picture, label));
    }
  }
  std::filesystem::path file = folder / "markers.csv";
  csv.Write(file);
  return file;
}

}  // namespace retrolux
