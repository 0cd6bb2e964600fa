// A dataset's labels as one flat table.
#pragma once

#include "analysis/dataset.h"

namespace retrolux {

// What is known of a marker in a picture, and of its scene's nuisances that are one value each, as
// cells of a table. Masks and corners are not among them.
class LabelTable {
 public:
  explicit LabelTable(const DatasetIndex& index);
  std::vector<std::string> Columns() const;
  std::vector<std::string> Row(const DatasetScene& scene, const DatasetPicture& picture,
                               const MarkerLabel& label) const;

 private:
  std::vector<std::string> nuisances_;
};

// FOLDER/markers.csv: a row for each marker in each picture. Returns the file.
std::filesystem::path ExportCsv(const DatasetIndex& index, const std::filesystem::path& folder);

}  // namespace retrolux
