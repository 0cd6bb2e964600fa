#include "core/data_path.h"

#include <cstdlib>
#include <vector>

#include "core/error.h"

namespace retrolux {

namespace fs = std::filesystem;

namespace {

void CheckStaysWithin(const fs::path& relative) {
  for (const fs::path& part : relative) {
    if (relative.is_absolute() || part == "..") {
      throw InputError(fmt::format("{}: a path that leaves the data folder; expected one within it",
                                   relative.string()));
    }
  }
}

// The folders to look into, first things first (data_path.h).
std::vector<fs::path> DataFolders() {
  std::vector<fs::path> folders;
  if (const char* named = std::getenv("RETROLUX_DATA")) folders.emplace_back(named);
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = program.parent_path().parent_path() / "share/retrolux";
  if (!error) folders.push_back(installed);
  if (error || !fs::is_directory(installed, error)) folders.emplace_back(RETROLUX_SOURCE_DATA);
  return folders;
}

}  // namespace

fs::path DataPath(const fs::path& relative) {
  CheckStaysWithin(relative);
  const std::vector<fs::path> folders = DataFolders();
  std::error_code error;
  for (const fs::path& folder : folders) {
    if (fs::exists(folder / relative, error)) return folder / relative;
  }
  std::vector<std::string> names;
  for (const fs::path& folder : folders) names.push_back(folder.string());
  throw InputError(
      fmt::format("{}: data file not found; expected it under {} (RETROLUX_DATA may name a folder)",
                  relative.string(), fmt::join(names, " or ")));
}

}  // namespace retrolux
