// Where the data files of the project are (marker sets, spectra, schemas, the report's page).
#pragma once

#include <filesystem>

namespace retrolux {

// The path of `relative` (e.g. "materials/data/qe_interline_ccd.csv"), looked for under
// RETROLUX_DATA of the environment, then under ../share/retrolux of the program, then in the source
// tree. InputError if it is in none of them.
std::filesystem::path DataPath(const std::filesystem::path& relative);

}  // namespace retrolux
