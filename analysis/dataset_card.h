// What people read first of a dataset: card.md, contact_sheet.png, report.html.
#pragma once

#include "analysis/dataset.h"

namespace retrolux {

// `command`: how it was made, as typed.
void WriteDatasetCard(const DatasetIndex& index, const std::filesystem::path& folder,
                      const std::string& command);

}  // namespace retrolux
