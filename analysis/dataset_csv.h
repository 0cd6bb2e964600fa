// A dataset's labels as one flat table.
#pragma once

#include "analysis/dataset.h"

namespace retrolux {

// FOLDER/markers.csv: a row for each marker in each picture, with its scene's nuisances; masks and
// corners are not in it. Returns the file.
std::filesystem::path ExportCsv(const DatasetIndex& index, const std::filesystem::path& folder);

}  // namespace retrolux
