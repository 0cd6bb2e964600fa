// Where the data files of the project are (marker sets, spectra, schemas, the report's page).
#pragma once

#include <filesystem>

namespace retrolux {

// The path of `relative` (e.g. "materials/data/qe_interline_ccd.csv"), looked for in this order:
//   1. the folder that RETROLUX_DATA of the environment names; it need not hold every file;
//   2. ../share/retrolux of the running program (where `cmake --install` and the package put it);
//   3. the source tree of the build, only if there is no folder 2, so that an installed program
//      never mixes its data with those of another version.
// InputError, which names the folders that were looked into, if it is in none of them.
std::filesystem::path DataPath(const std::filesystem::path& relative);

}  // namespace retrolux
