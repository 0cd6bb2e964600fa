// Pictures of a dataset side by side, with their labels drawn, to be looked at by people.
#pragma once

#include "analysis/dataset.h"

namespace retrolux {

// At most `count` pictures, spread evenly over the dataset, `columns` a row. Dark levels are raised
// (gamma 2.2 of the digital numbers). Green: outline of the visible mask; grey: of the amodal mask
// where more is hidden than seen; corners green (visible) or red (hidden); cross: radiometric
// centroid; the marker's number, or o for a standard one. Returns a PNG file.
std::string ContactSheetPng(const DatasetIndex& index, const std::filesystem::path& folder,
                            int count, int columns);

}  // namespace retrolux
